"""Goals: one at a time, the more important first; interrupted, stopped, begun again, dropped."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import tasks
from nep_core.program.robot import Robot
from nep_core.program.tasks import RuleStopped, wait, wait_until
from tests.nep_core.goal_playing import Join, Scene
from tests.nep_core.robot_playing import PlayedRobot


@pytest.fixture
def scene(network: PeerNetwork, join: Join) -> Iterator[Scene]:
    scene = Scene(network, join("person"))
    yield scene
    scene.end()


def test_a_goal_is_pursued_when_its_state_comes_and_is_done(scene: Scene) -> None:
    scene.goal("greet", 0.05)
    scene.begin()

    scene.does("greet")

    assert [scene.diary.next(), scene.diary.next()] == ["greet begins", "greet done"]


def test_goals_of_one_priority_come_one_after_the_other(scene: Scene) -> None:
    for name in ("a", "b", "c"):
        scene.goal(name, 0.1)
    scene.begin()

    scene.does("a", "b", "c")

    entries = [scene.diary.next() for _ in range(6)]
    assert entries == ["a begins", "a done", "b begins", "b done", "c begins", "c done"]


def test_the_more_important_of_the_waiting_goals_comes_first(scene: Scene) -> None:
    scene.goal("now", 0.3, priority="high")
    scene.goal("later", 0.05, priority="low")
    scene.goal("soon", 0.05)
    scene.begin()

    scene.does("now", "later", "soon")

    entries = [scene.diary.next() for _ in range(6)]
    assert entries[2:] == ["soon begins", "soon done", "later begins", "later done"]


def test_a_more_important_goal_interrupts_and_the_other_begins_again(scene: Scene) -> None:
    scene.goal("chat", priority="low")
    scene.goal("danger", 0.05, priority="high")
    scene.hook("chat", "interrupted")
    scene.hook("chat", "returns")
    scene.begin()

    scene.does("chat")
    first = scene.diary.next()
    scene.does("danger")

    assert first == "chat begins"
    assert [scene.diary.next() for _ in range(5)] == [
        "chat interrupted",
        "danger begins",
        "danger done",
        "chat returns",
        "chat begins",
    ]


def test_an_interrupted_goal_may_be_dropped(scene: Scene) -> None:
    scene.goal("chat", priority="low", interrupted="drop")
    scene.goal("danger", 0.05, priority="high")
    scene.begin()

    scene.does("chat")
    scene.diary.next()
    scene.does("danger")

    assert [scene.diary.next(), scene.diary.next()] == ["danger begins", "danger done"]
    assert scene.diary.is_quiet()


def test_a_less_important_goal_waits(scene: Scene) -> None:
    scene.goal("danger", 0.3, priority="high")
    scene.goal("chat", 0.05, priority="low")
    scene.begin()

    scene.does("danger")
    scene.diary.next()
    scene.does("chat")

    assert [scene.diary.next() for _ in range(3)] == ["danger done", "chat begins", "chat done"]


def test_a_goal_is_given_up_when_its_stop_state_comes(scene: Scene) -> None:
    scene.goal("chat", stop="bye")
    scene.hook("chat", "stopped")
    scene.hook("chat", "finished")
    scene.begin()

    scene.does("chat")
    scene.diary.next()
    scene.does("bye")

    assert scene.diary.next() == "chat stopped"
    assert scene.diary.is_quiet()


def test_a_waiting_goal_is_given_up_too(scene: Scene) -> None:
    scene.goal("danger", 0.3, priority="high")
    scene.goal("chat", 0.05, stop="bye")
    scene.begin()

    scene.does("danger", "chat", "bye")

    assert [scene.diary.next(), scene.diary.next()] == ["danger begins", "danger done"]
    assert scene.diary.is_quiet()


def test_an_interrupted_goal_that_is_given_up_meanwhile_is_told_so(scene: Scene) -> None:
    scene.goal("chat", priority="low", stop="bye")
    scene.goal("danger", 0.3, priority="high")
    scene.hook("chat", "stopped")
    scene.begin()

    scene.does("chat")
    scene.diary.next()
    scene.does("danger")
    scene.diary.next()
    scene.does("bye")

    assert [scene.diary.next(), scene.diary.next()] == ["danger done", "chat stopped"]
    assert scene.diary.is_quiet()


@pytest.mark.parametrize("problem", [RuleStopped(), ValueError("wrong")])
def test_what_ends_the_rule_of_a_return_does_not_end_the_goal(
    scene: Scene, problem: BaseException
) -> None:
    def returning() -> None:
        raise problem

    scene.goal("chat", priority="low")
    scene.goal("danger", 0.05, priority="high")
    scene.behavior.when_goal("chat", "returns")(returning)
    scene.begin()

    scene.does("chat")
    first = scene.diary.next()
    scene.does("danger")

    assert first == "chat begins"
    entries = [scene.diary.next() for _ in range(3)]
    assert entries == ["danger begins", "danger done", "chat begins"]


def test_a_goal_that_runs_does_not_begin_twice_but_can_be_pursued_anew(scene: Scene) -> None:
    scene.goal("chat", 0.2)
    scene.hook("chat", "finished")
    scene.begin()

    scene.does("chat", "chat", "chat")
    first = [scene.diary.next() for _ in range(3)]
    quiet = scene.diary.is_quiet()
    scene.does("chat")

    assert first == ["chat begins", "chat done", "chat finished"]
    assert quiet and scene.diary.next() == "chat begins"


def test_three_priorities_interrupt_each_other_and_come_back_in_order(scene: Scene) -> None:
    scene.goal("low", 0.3, priority="low")
    scene.goal("normal", 0.3)
    scene.goal("high", 0.05, priority="high")
    scene.begin()

    scene.does("low")
    scene.diary.next()
    scene.does("normal")
    scene.diary.next()
    scene.does("high")

    assert [scene.diary.next() for _ in range(6)] == [
        "high begins",
        "high done",
        "normal begins",
        "normal done",
        "low begins",
        "low done",
    ]


def test_interrupting_a_goal_ends_what_the_robot_does_for_it(scene: Scene, join: Join) -> None:
    nao = PlayedRobot(join("NAO"), end=None)
    robot = Robot("NAO")

    @scene.behavior.goal("tell", when="tell", priority="low", interrupted="drop")
    def tell() -> None:
        robot.start_walking(50)
        robot.say("A very long story")

    scene.goal("danger", 0.05, priority="high")
    scene.begin()
    scene.does("tell")
    tasks.wait_until(lambda: {"say", "walk_freely"} <= {action for action, _ in nao.asked})

    scene.does("danger")

    assert scene.diary.next() == "danger begins"
    tasks.wait_until(lambda: sum(action == "stop" for action, _ in nao.asked) >= 2)
    stopped = [args["request"] for action, args in nao.asked if action == "stop"]
    assert len(set(stopped)) == 2 and "" not in stopped


def test_all_that_is_to_be_done_when_a_goal_ends_is_done(scene: Scene) -> None:
    scene.goal("chat", 0.05)
    for word in ("first", "second"):
        scene.behavior.when_goal("chat", "finished")(lambda word=word: scene.diary.write(word))
    scene.begin()

    scene.does("chat")

    entries = [scene.diary.next() for _ in range(4)]
    assert entries == ["chat begins", "chat done", "first", "second"]


def test_a_goal_that_is_stopped_while_what_follows_its_interruption_runs_does_not_return(
    scene: Scene,
) -> None:
    stopped = threading.Event()

    def on_interrupted() -> None:
        scene.diary.write("interrupted")
        wait_until(stopped.is_set, 5)
        wait(0.2)

    scene.goal("chat", priority="low", stop="enough")
    scene.goal("danger", 0.05, priority="high")
    scene.behavior.when_goal("chat", "interrupted")(on_interrupted)
    scene.begin()
    scene.does("chat")
    assert scene.diary.next() == "chat begins"

    scene.does("danger")
    assert scene.diary.next() == "interrupted"
    scene.does("enough")
    stopped.set()

    assert [scene.diary.next(), scene.diary.next()] == ["danger begins", "danger done"]
    assert scene.diary.is_quiet()
