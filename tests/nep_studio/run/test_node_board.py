"""The node board: what nodes tell becomes a state that a person reads."""

from __future__ import annotations

import msgspec
import pytest

from nep_core.wire.messages import NodeEvent, NodeState
from nep_studio.run.node_board import NodeBoard


def state(event: NodeEvent, at_s: float = 0.0, *, pid: int = 7, description: str = "") -> NodeState:
    return NodeState(
        node="karate", type="perceptual", event=event, pid=pid, time=at_s, description=description
    )


def measured(**measures: float) -> NodeState:
    return msgspec.structs.replace(state("alive"), measures=measures)


@pytest.fixture
def board() -> NodeBoard:
    board = NodeBoard()
    board.plan("karate", "perceptual", "perceptual/gesture")
    return board


def test_a_planned_node_is_there_before_it_runs(board: NodeBoard) -> None:
    assert board.nodes["karate"].health == "planned"
    assert not board.nodes["karate"].is_there


def test_planning_it_again_is_no_news(board: NodeBoard) -> None:
    assert not board.plan("karate", "perceptual", "perceptual/gesture")


@pytest.mark.parametrize(
    ("event", "health"),
    [
        ("starting", "starting"),
        ("ready", "ready"),
        ("connecting", "starting"),
        ("busy", "busy"),
        ("warning", "warning"),
        ("connection_failed", "warning"),
        ("crashed", "crashed"),
        ("stopped", "stopped"),
    ],
)
def test_each_event_is_a_health(board: NodeBoard, event: NodeEvent, health: str) -> None:
    assert board.update(state(event))

    assert board.nodes["karate"].health == health
    assert board.nodes["karate"].node == "perceptual/gesture"


def test_a_heartbeat_changes_nothing_but_the_time(board: NodeBoard) -> None:
    board.update(state("ready", 1.0))

    assert not board.update(state("alive", 2.0))
    assert board.nodes["karate"].heard_s == 2.0


def test_a_node_that_is_not_heard_for_three_beats_is_frozen_once(board: NodeBoard) -> None:
    board.update(state("ready", 1.0))

    assert board.frozen(3.9) == []
    assert board.frozen(4.1) == ["karate"]
    assert board.frozen(5.0) == []
    assert board.nodes["karate"].health == "frozen"


def test_a_frozen_node_that_is_heard_again_is_ready(board: NodeBoard) -> None:
    board.update(state("ready", 1.0))
    board.frozen(9.0)

    assert board.update(state("alive", 9.5))
    assert board.nodes["karate"].health == "ready"


def test_a_stopped_node_does_not_freeze(board: NodeBoard) -> None:
    board.update(state("stopped", 1.0))

    assert board.frozen(100.0) == []


def test_restarts_after_a_crash_are_counted(board: NodeBoard) -> None:
    for pid in (7, 8, 9):
        board.update(state("starting", pid=pid))
        board.update(state("crashed", pid=pid))

    assert board.nodes["karate"].restarts == 2


def test_a_late_heartbeat_of_a_node_that_has_crashed_does_not_revive_it(board: NodeBoard) -> None:
    board.update(state("ready", 1.0))
    board.update(state("crashed", 2.0))

    board.update(state("alive", 2.1))

    assert board.nodes["karate"].health == "crashed"


def test_a_node_of_somebody_else_appears_when_it_is_heard() -> None:
    board = NodeBoard()

    assert board.update(state("ready"))
    assert board.nodes["karate"].node == ""


def test_only_a_node_that_does_not_run_can_be_forgotten(board: NodeBoard) -> None:
    board.update(state("ready"))
    assert not board.forget("karate")

    board.update(state("stopped"))
    assert board.forget("karate")
    assert board.nodes == {}


def test_the_clock_of_another_computer_freezes_no_node(board: NodeBoard) -> None:
    board.update(state("ready", 10.0), 5000.0)

    assert board.frozen(5001.0) == []
    assert board.nodes["karate"].heard_s == 5000.0


def test_nodes_are_not_frozen_because_the_computer_was_asleep(board: NodeBoard) -> None:
    board.update(state("ready", 1.0))

    board.wake(9000.0)

    assert board.frozen(9002.0) == []
    assert board.frozen(9004.0) == ["karate"]


def test_new_measures_are_kept_and_are_no_change_of_the_nodes_status(board: NodeBoard) -> None:
    board.update(state("running", description="listens"))

    is_changed = board.update(measured(rate_hz=50.0))
    board.update(state("alive"))

    status = board.nodes["karate"]
    assert not is_changed
    assert status.measures == {"rate_hz": 50.0}
    assert (status.event, str(status.fault)) == ("running", "listens")


def test_a_node_that_starts_anew_has_measured_nothing(board: NodeBoard) -> None:
    board.update(measured(rate_hz=50.0))

    board.update(state("starting"))

    assert not board.nodes["karate"].measures


def test_names_without_end_or_of_any_length_do_not_fill_the_board() -> None:
    board = NodeBoard()
    board.plan("NAO", "action", "action/nao")
    for number in range(1000):
        board.update(NodeState(node=f"stranger {number}", type="sensory", event="ready"), 1.0)
    board.update(NodeState(node="x" * 100_000, type="sensory", event="ready"), 1.0)
    assert len(board.nodes) < 500

    board.frozen(100.0)
    board.update(NodeState(node="late", type="sensory", event="ready"), 100.0)
    board.update(NodeState(node="NAO", type="action", event="ready"), 100.0)

    assert board.nodes["late"].is_there
    assert board.nodes["NAO"].health == "ready"
    assert max(map(len, board.nodes)) <= 100
