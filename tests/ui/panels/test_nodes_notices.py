"""What the person is told when a node changes: data in, a problem and its fixes out."""

from __future__ import annotations

from dataclasses import replace

import pytest

from faults import fault_of
from nep_core.processes.process import Outcome
from nep_studio.run.node_board import NodeStatus
from nep_studio.ui.plugins.nodes.notices import (
    Circumstances,
    is_recovered,
    master_notice,
    notice_of,
)

READY = NodeStatus("karate", "perceptual", event="ready", pid=1, health="ready")
OURS = Circumstances(is_ours=True, was_ready=True)


def changed(**values) -> NodeStatus:
    return replace(READY, **values)


def test_a_frozen_node_of_ours_can_be_restarted() -> None:
    notice = notice_of(READY, changed(health="frozen"), OURS)

    assert notice is not None
    assert "karate" in notice.problem.title
    assert notice.problem.checklist
    assert notice.fixes == ("restart", "show_log")


def test_a_frozen_node_of_somebody_else_has_no_button_that_cannot_work() -> None:
    notice = notice_of(READY, changed(health="frozen"), Circumstances())

    assert notice is not None
    assert notice.fixes == ()
    assert notice.problem.checklist


def test_a_wrong_address_offers_the_robot_on_the_screen_and_the_address() -> None:
    steps = ("Is NAO switched on?", "Same network?")
    told = fault_of("NAO does not answer: not at {at}.", checklist=steps, at="10.0.0.9")
    after = changed(event="connection_failed", health="crashed", fault=told)

    notice = notice_of(READY, after, replace(OURS, has_block=True, address="10.0.0.9"))

    assert notice is not None
    assert notice.fixes == ("use_virtual", "test_connection")
    assert str(notice.problem.sentence) == "NAO does not answer: not at 10.0.0.9."
    assert tuple(map(str, notice.problem.checklist)) == steps


@pytest.mark.parametrize(
    ("code", "title"),
    [("driven", "is driven by somebody else"), ("taken_over", "was taken over")],
)
def test_a_robot_that_another_drives_can_be_taken_over(code: str, title: str) -> None:
    told = fault_of("NAO is driven by Ana on desk.", code=code)
    after = changed(event="connection_failed", health="warning", fault=told)

    notice = notice_of(READY, after, replace(OURS, has_block=True, address="10.0.0.9"))

    assert notice is not None
    assert notice.fixes == ("use_virtual", "take_over")
    assert title in notice.problem.title


@pytest.mark.parametrize("code", ["too_hot", "low_battery"])
def test_a_tired_robot_can_be_sent_to_rest(code: str) -> None:
    told = fault_of("NAO is hot.", code=code, checklist=("Let it rest.",))

    notice = notice_of(READY, changed(event="warning", health="warning", fault=told), OURS)

    assert notice is not None
    assert notice.fixes[0] == "rest"


def test_motors_that_stay_on_at_the_end_are_told_also_while_all_is_stopped() -> None:
    told = fault_of("NAO's motors are still on.", code="left_on", checklist=("Let it rest.",))
    after = changed(event="stopped", health="stopped", fault=told)

    notice = notice_of(READY, after, replace(OURS, is_ending=True))

    assert notice is not None
    assert not notice.passes and notice.problem.checklist


def test_a_killed_node_that_is_started_again_says_so() -> None:
    told = Outcome("karate", -9).fault(again=True)
    after = changed(event="crashed", health="crashed", fault=told)

    notice = notice_of(READY, after, OURS)

    assert notice is not None
    assert (notice.kind, notice.fixes) == ("warning", ("show_log",))
    assert "started again" in notice.problem.title
    assert str(notice.problem.sentence) == "karate was killed"


def test_a_node_that_is_given_up_can_be_started() -> None:
    after = changed(event="crashed", health="crashed", fault=Outcome("karate", -9).fault())

    notice = notice_of(READY, after, OURS)

    assert notice is not None
    assert (notice.kind, notice.fixes) == ("error", ("start", "show_log"))


def test_the_last_words_of_a_node_itself_are_waited_out() -> None:
    after = changed(event="crashed", health="crashed", fault=fault_of("division by zero"))

    assert notice_of(READY, after, OURS) is None


def test_a_node_that_a_person_stopped_is_told_in_passing() -> None:
    after = changed(event="stopped", health="stopped")

    notice = notice_of(READY, after, replace(OURS, was_asked=True))

    assert notice is not None
    assert notice.passes
    assert notice.kind == "info"


def test_a_node_that_ends_by_itself_is_no_passing_matter() -> None:
    notice = notice_of(READY, changed(event="stopped", health="stopped"), OURS)

    assert notice is not None
    assert not notice.passes
    assert "start" in notice.fixes


@pytest.mark.parametrize(("event", "health"), [("stopped", "stopped"), ("crashed", "crashed")])
def test_nothing_is_told_while_everything_is_being_stopped(event: str, health: str) -> None:
    after = changed(event=event, health=health, fault=Outcome("karate", -9).fault())

    assert notice_of(READY, after, replace(OURS, is_ending=True)) is None


def test_lost_messages_are_a_warning() -> None:
    words = "3 messages of /imu were lost."
    after = changed(event="warning", health="warning", fault=fault_of(words))

    notice = notice_of(READY, after, OURS)

    assert notice is not None
    assert (notice.kind, str(notice.problem.sentence)) == ("warning", words)


def test_a_heartbeat_tells_nothing() -> None:
    frozen = changed(health="frozen")

    assert notice_of(frozen, replace(frozen, heard_s=9.0), OURS) is None
    assert notice_of(READY, replace(READY, heard_s=9.0), OURS) is None


def test_a_node_that_answers_again_has_recovered() -> None:
    assert is_recovered(changed(health="frozen"), READY)
    assert is_recovered(changed(health="crashed"), READY)
    assert not is_recovered(READY, replace(READY, heard_s=9.0))
    assert not is_recovered(READY, changed(health="frozen"))


def test_a_killed_program_that_begins_again_says_so_and_can_be_stopped() -> None:
    told = Outcome("program", -9).fault(again=True)
    after = changed(name="program", event="crashed", health="crashed", fault=told)

    notice = notice_of(READY, after, Circumstances(is_program=True))

    assert notice is not None
    assert notice.fixes == ("stop", "show_log")
    assert notice.problem.checklist


@pytest.mark.parametrize("event", ["restarting", "gone"])
def test_a_master_that_ended_is_told_as_the_network(event: str) -> None:
    notice = master_notice(event, "master was killed.")

    assert "network" in notice.problem.title
    assert notice.problem.checklist
    assert ("start" in notice.fixes) == (event == "gone")
