"""Goals in a program: beside rules and robots, their errors, what is told of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from nep_core.errors import NepError
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program.behavior import Behavior
from nep_core.program.tasks import wait
from tests.nep_core.goal_playing import WAIT_S, Join, Scene


@pytest.fixture
def scene(network: PeerNetwork, join: Join) -> Iterator[Scene]:
    scene = Scene(network, join("person"))
    yield scene
    scene.end()


def test_rules_and_goals_live_side_by_side(scene: Scene) -> None:
    scene.goal("chat")
    scene.behavior.when("wave")(lambda: scene.diary.write("waves back"))
    scene.begin()

    scene.does("chat")
    scene.diary.next()
    scene.does("wave")

    assert scene.diary.next() == "waves back"


def test_an_error_in_a_goal_ends_the_program_where_that_is_wanted(scene: Scene) -> None:
    scene.behavior = Behavior("Goals", on_error="end")

    @scene.behavior.goal("break", when="break")
    def goal() -> None:
        raise ValueError("broken")

    scene.begin()
    scene.does("break")
    scene.join()

    assert isinstance(scene.error, ValueError)


def test_the_life_of_a_goal_is_told_on_the_program_state(scene: Scene) -> None:
    scene.goal("chat", stop="bye")
    scene.begin()

    scene.does("chat")
    scene.diary.next()
    scene.does("bye")

    first, second = scene.told.receive(WAIT_S), scene.told.receive(WAIT_S)
    assert first is not None and (first.event, first.rule) == ("goal_started", "chat")
    assert second is not None and second.event == "goal_stopped"


@pytest.mark.parametrize(
    "wrong",
    [
        lambda behavior: behavior.goal("chat", when="x")(print),
        lambda behavior: behavior.goal("other", when="x", priority="huge")(print),
    ],
)
def test_a_goal_that_cannot_be_is_refused_at_once(
    scene: Scene, wrong: Callable[[Behavior], object]
) -> None:
    scene.goal("chat")

    with pytest.raises(NepError) as refused:
        wrong(scene.behavior)

    assert refused.value.checklist


def test_what_hangs_on_a_goal_that_is_not_there_is_told_with_its_name(scene: Scene) -> None:
    scene.goal("chat")
    scene.hook("chatt", "finished")
    scene.begin()

    told = scene.told.receive(WAIT_S)
    assert told is not None and told.event == "rule_failed"
    assert "chatt" in str(told.fault.sentence)
    scene.does("chat")
    assert scene.diary.next() == "chat begins"


def test_a_storm_of_states_runs_one_goal_at_a_time(scene: Scene) -> None:
    at_once, most = [0], [0]
    for name, priority in (("a", "low"), ("b", "normal"), ("c", "high")):

        @scene.behavior.goal(name, when=name, priority=priority, stop="bye")
        def goal() -> None:
            at_once[0] += 1
            most[0] = max(most[0], at_once[0])
            try:
                wait(0.01)
            finally:
                at_once[0] -= 1

    scene.goal("last", 0.0)
    scene.begin()

    for _ in range(40):
        scene.does("a", "b", "c", "bye", "b", "a", "c")
    scene.does("last")

    assert scene.diary.next() == "last begins"
    assert most[0] == 1
