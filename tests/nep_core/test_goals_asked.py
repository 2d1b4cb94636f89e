"""Goals that are asked for, begin by a condition, fail, and are those of several robots."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest

from nep_core.errors import NepError
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program.goals import fail_goal, goal_value
from nep_core.program.robot import Robot
from nep_core.program.tasks import together, wait, wait_until
from tests.nep_core.goal_playing import WAIT_S, Join, Scene


@pytest.fixture
def scene(network: PeerNetwork, join: Join) -> Iterator[Scene]:
    scene = Scene(network, join("person"))
    yield scene
    scene.end()


def asked(scene: Scene, name: str, seconds: float = 0.05, **options: object) -> None:
    """A goal that nobody's state begins; it writes what it was given."""

    @scene.behavior.goal(name, **options)
    def goal() -> None:
        scene.diary.write(f"{name} {goal_value()}".strip())
        wait(seconds)


def test_a_goal_is_pursued_when_it_is_asked_for_with_what_it_is_given(scene: Scene) -> None:
    asked(scene, "tour")
    scene.begin()

    scene.behavior.pursue("tour", "Anna")
    first = scene.diary.next()
    wait_until(lambda: not scene.behavior.pursues("tour"), WAIT_S)
    scene.behavior.pursue("tour")

    assert first == "tour Anna"
    assert scene.diary.next() == "tour"


def test_what_a_goal_was_given_is_known_in_its_parts_and_in_what_follows(scene: Scene) -> None:
    @scene.behavior.goal("tour")
    def tour() -> None:
        together(lambda: scene.diary.write(f"part {goal_value()}"))

    @scene.behavior.when_goal("tour", "finished")
    def after() -> None:
        scene.diary.write(f"after {goal_value()}")

    scene.begin()
    scene.behavior.pursue("tour", 7)

    assert [scene.diary.next(), scene.diary.next()] == ["part 7", "after 7"]


def test_a_goal_that_is_pursued_already_is_not_asked_twice(scene: Scene) -> None:
    asked(scene, "tour", 0.3)
    scene.begin()

    for name in ("Anna", "Ben"):
        scene.behavior.pursue("tour", name)

    assert scene.diary.next() == "tour Anna"
    assert scene.diary.is_quiet(0.5)


def test_whether_a_goal_is_pursued_counts_waiting_too(scene: Scene) -> None:
    asked(scene, "now", 60.0, priority="high")
    asked(scene, "later")
    scene.begin()
    scene.behavior.pursue("now")
    scene.diary.next()
    before = scene.behavior.pursues("later")

    scene.behavior.pursue("later")

    assert not before and scene.behavior.pursues("later")
    scene.behavior.give_up("now")
    assert scene.diary.next() == "later"
    assert wait_until(lambda: not scene.behavior.pursues("later"), WAIT_S)


def test_a_goal_that_runs_or_waits_can_be_given_up(scene: Scene) -> None:
    asked(scene, "now", 60.0, priority="high")
    asked(scene, "later")
    scene.hook("now", "stopped")
    scene.begin()
    scene.behavior.pursue("now")
    scene.behavior.pursue("later")
    scene.diary.next()

    scene.behavior.give_up("later")
    scene.behavior.give_up("now")

    assert scene.diary.next() == "now stopped"
    assert scene.diary.is_quiet()


def test_a_goal_that_gives_itself_up_ends_there(scene: Scene) -> None:
    @scene.behavior.goal("tour")
    def tour() -> None:
        scene.behavior.give_up("tour")
        scene.diary.write("went on")

    scene.hook("tour", "stopped")
    scene.begin()
    scene.behavior.pursue("tour")

    assert scene.diary.next() == "tour stopped"
    assert scene.diary.is_quiet()


@pytest.mark.parametrize("ask", ["pursue", "pursues", "give_up"])
def test_a_goal_that_is_not_there_is_told_with_those_that_are(scene: Scene, ask: str) -> None:
    asked(scene, "tour")

    with pytest.raises(NepError) as refused:
        getattr(scene.behavior, ask)("tuor")

    assert "tuor" in str(refused.value.fault.sentence)
    assert "The goals are: tour." in [str(step) for step in refused.value.fault.checklist]


def test_a_goal_begins_each_time_that_its_condition_becomes_true(scene: Scene) -> None:
    is_close = threading.Event()
    scene.goal("none")

    @scene.behavior.goal("make way", when=is_close.is_set)
    def make_way() -> None:
        scene.diary.write("makes way")

    scene.begin()
    is_close.set()
    first = scene.diary.next()
    quiet = scene.diary.is_quiet()
    is_close.clear()
    wait(0.2)
    is_close.set()

    assert first == "makes way" and quiet
    assert scene.diary.next() == "makes way"


def test_an_error_in_a_condition_is_told_with_the_goal(scene: Scene) -> None:
    def broken() -> bool:
        raise ValueError("broken")

    scene.behavior.goal("tour", when=broken)(lambda: None)
    scene.begin()

    told = scene.told.receive(WAIT_S)

    assert told is not None and (told.event, told.rule) == ("rule_failed", "tour")


def test_a_goal_that_cannot_be_reached_has_failed(scene: Scene) -> None:
    @scene.behavior.goal("find")
    def find() -> None:
        together(fail_goal, lambda: wait(60))
        scene.diary.write("went on")

    for event in ("failed", "finished", "stopped"):
        scene.hook("find", event)
    scene.begin()

    scene.behavior.pursue("find")

    assert scene.diary.next() == "find failed"
    assert scene.diary.is_quiet()
    events = [told.event for _ in range(2) if (told := scene.told.receive(WAIT_S))]
    assert events == ["goal_started", "goal_failed"]


def test_a_goal_whose_time_is_over_has_failed(scene: Scene) -> None:
    asked(scene, "find", 60.0, at_most_s=0.2)
    scene.hook("find", "failed")
    scene.begin()

    scene.behavior.pursue("find")

    assert [scene.diary.next(), scene.diary.next()] == ["find", "find failed"]


def test_the_time_of_a_goal_does_not_run_while_another_one_does(scene: Scene) -> None:
    asked(scene, "find", 0.4, at_most_s=0.8, priority="low", interrupted="resume")
    asked(scene, "alarm", 1.0, priority="high")
    for event in ("failed", "finished"):
        scene.hook("find", event)
    scene.begin()
    scene.behavior.pursue("find")
    scene.diary.next()

    scene.behavior.pursue("alarm")

    assert [scene.diary.next(), scene.diary.next()] == ["alarm", "find finished"]


def test_outside_of_goals_nothing_was_given_and_nothing_fails(scene: Scene) -> None:
    for wrong in (goal_value, fail_goal):
        with pytest.raises(NepError) as refused:
            wrong()
        assert refused.value.checklist


def test_goals_of_different_robots_run_side_by_side(scene: Scene) -> None:
    here, there = Robot("NAO"), Robot("Pepper")
    asked(scene, "greet", 60.0, robot=here)
    asked(scene, "guide", 60.0, robot=there)
    asked(scene, "help", 0.05, robot=Robot(["Pepper", "Max"]), priority="high")
    scene.hook("guide", "interrupted")
    scene.hook("greet", "interrupted")
    scene.begin()

    scene.behavior.pursue("greet")
    scene.behavior.pursue("guide")
    both = {scene.diary.next(), scene.diary.next()}
    scene.behavior.pursue("help")

    assert both == {"greet", "guide"}
    assert [scene.diary.next() for _ in range(3)] == ["guide interrupted", "help", "guide"]


def test_a_goal_of_all_robots_waits_for_each_and_is_not_overtaken(scene: Scene) -> None:
    here, there = Robot("NAO"), Robot("Pepper")
    asked(scene, "greet", 0.3, robot=here)
    asked(scene, "all")
    asked(scene, "guide", robot=there)
    scene.begin()

    for name in ("greet", "all", "guide"):
        scene.behavior.pursue(name)

    assert [scene.diary.next() for _ in range(3)] == ["greet", "all", "guide"]
