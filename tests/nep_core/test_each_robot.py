"""What is done for each of several robots at once: by whom, how it ends, what stops it."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator

import pytest

from nep_core.errors import ActionFailed, RobotError
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program.robot import Robot, as_robot, for_each_robot, this_robot
from nep_core.program.tasks import Part, RuleStopped, Task, stop_rule, together, wait
from nep_core.program.values import ValueRefused
from tests.nep_core.robot_playing import PlayedRobot

Join = Callable[[str], PeerNetwork]
NAMES = ("NAO", "NAO2", "NAO3")

pytestmark = pytest.mark.usefixtures("network")


@pytest.fixture
def robots(join: Join, network: PeerNetwork) -> Iterator[dict[str, PlayedRobot]]:
    yield {name: PlayedRobot(join(name), name) for name in NAMES}


def test_each_robot_does_it_once_and_all_at_the_same_time(robots: dict[str, PlayedRobot]) -> None:
    meet = threading.Barrier(3, timeout=10)

    def greet() -> None:
        meet.wait()  # nobody comes past it alone
        this_robot().say(f"I am {this_robot()}")

    for_each_robot(Robot([*NAMES, "NAO"]), greet)

    assert {name: robots[name].words() for name in NAMES} == {
        name: [f"I am {name}"] for name in NAMES
    }


def test_it_is_done_when_the_slowest_is(robots: dict[str, PlayedRobot]) -> None:
    robots["NAO2"].end = None
    calling = threading.Thread(
        target=for_each_robot, args=(Robot(list(NAMES)), lambda: this_robot().say("Hello"))
    )
    calling.start()
    for robot in robots.values():
        assert robot.arrived.acquire(timeout=5)
    was_waited_for = calling.is_alive()

    robots["NAO2"].end = "done"  # the next time it is asked how it is going
    calling.join(5)

    assert was_waited_for and not calling.is_alive()


def test_what_goes_wrong_with_one_ends_what_the_others_do(robots: dict[str, PlayedRobot]) -> None:
    robots["NAO2"].end = "failed"

    def work() -> None:
        this_robot().say("Hello")
        wait(600)

    begun_s = time.monotonic()
    with pytest.raises(ActionFailed, match="NAO2 could not do that"):
        for_each_robot(Robot(list(NAMES)), work)

    assert time.monotonic() - begun_s < 20


def test_the_end_of_the_rule_ends_it_for_all() -> None:
    def work() -> None:
        if str(this_robot()) == "NAO2":
            stop_rule()
        wait(600)

    with pytest.raises(RuleStopped):
        for_each_robot(Robot(["NAO", "NAO2"]), work)


def test_a_cancelled_one_stops_what_all_robots_do(robots: dict[str, PlayedRobot]) -> None:
    for robot in robots.values():
        robot.end = None
    all_of_them = Robot(list(NAMES))
    part = Part(
        lambda: for_each_robot(all_of_them, lambda: this_robot().say("A long story")),
        "story",
        Task(),
    ).start()
    for robot in robots.values():
        assert robot.arrived.acquire(timeout=5)

    part.task.cancel()
    part.join(5)

    assert not part.is_running and part.error is None
    for robot in robots.values():
        assert robot.arrived.acquire(timeout=5)
        assert robot.asked[-1][0] == "stop"


def test_parts_and_inner_ones_know_their_robot() -> None:
    found: list[str] = []

    def inner() -> None:
        together(lambda: found.append(str(this_robot())))

    def outer() -> None:
        for_each_robot(Robot("Lisa"), inner)
        inner()

    for_each_robot(Robot("NAO"), outer)

    assert found == ["Lisa", "NAO"]


def test_it_is_the_same_robot_as_elsewhere_in_the_program() -> None:
    nao, lisa = Robot("NAO"), Robot("Lisa")
    found: list[Robot] = []

    for_each_robot(Robot(["NAO", "Lisa"]), lambda: found.append(this_robot()))

    assert {id(one) for one in found} == {id(nao), id(lisa)}


def test_outside_nobody_is_this_robot() -> None:
    for_each_robot(Robot("NAO"), lambda: None)

    with pytest.raises(RobotError, match="known only inside of “do for each of … at once”"):
        this_robot()


def test_a_list_of_robots_and_names_is_robots_that_act_at_once() -> None:
    nao, lisa = Robot("NAO"), Robot("Lisa")

    assert as_robot([nao, "lisa"]) == Robot(["NAO", "Lisa"])
    assert as_robot([Robot(["NAO", "Lisa"]), lisa]).robots == ["NAO", "Lisa"]
    assert as_robot(["NAO"]) == nao


@pytest.mark.parametrize("value", [[], ["NAO", "nobody"], [["NAO"]], ["NAO", 3], ("NAO",)])
def test_what_is_no_list_of_robots_is_refused(value: object) -> None:
    Robot("NAO")

    with pytest.raises(ValueRefused):
        as_robot(value)
