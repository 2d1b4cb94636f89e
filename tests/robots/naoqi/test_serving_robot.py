"""A served robot: asked from several threads while its node lets it live."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest
from naoqi_theatre import NaoqiTheatre

from robots.body.actor import FINAL
from robots.body.driver import ActionResult


@pytest.fixture
def theatre() -> Iterator[NaoqiTheatre]:
    theatre = NaoqiTheatre(speed=20)
    yield theatre
    theatre.close()


def test_many_threads_ask_at_once_and_everything_ends(theatre: NaoqiTheatre) -> None:
    robot = theatre.offered.robot
    ended: list[ActionResult] = []
    lock = threading.Lock()

    def note(result: ActionResult) -> None:
        with lock:
            ended.append(result)

    def ask(number: int) -> None:
        for turn in range(10):
            robot.ask("reach_angles", note, angles={"HeadYaw": 0.01 * turn}, speed=1.0)
            robot.ask("leds", note, group="FaceLeds", colour="#ff0000", seconds=0.02)
            robot.state()
            if turn % 4 == number % 4:
                robot.stop(lambda command: command.action.__class__.__name__ == "Leds")

    threads = [threading.Thread(target=ask, args=(number,)) for number in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()

    theatre.until(lambda: len(ended) == 120)
    assert {result.state for result in ended} <= FINAL
    assert len({result.id for result in ended}) == 120


def test_what_the_network_asks_for_is_told_to_the_network_only(theatre: NaoqiTheatre) -> None:
    theatre.ask("mine", "look", yaw_deg=20.0)

    theatre.call("ALTextToSpeech", "say", "Hello")
    theatre.until(lambda: any(result.state == "done" for result in theatre.results))

    assert {result.id for result in theatre.results} == {"mine"}


def test_a_naoqi_program_that_stops_all_tells_the_network_so(theatre: NaoqiTheatre) -> None:
    theatre.ask("mine", "walk", forward_m=3.0)
    theatre.until(lambda: theatre.call("ALMotion", "moveIsActive"))

    theatre.call("ALMotion", "killAll")

    theatre.until(lambda: ("mine", "cancelled") in [(r.id, r.state) for r in theatre.results])


def test_the_network_and_a_program_take_turns_with_a_limb(theatre: NaoqiTheatre) -> None:
    theatre.ask("mine", "look", yaw_deg=40.0)

    theatre.call("ALMotion", "angleInterpolation", "HeadYaw", -0.3, 0.5, True)

    theatre.until(lambda: ("mine", "done") in [(r.id, r.state) for r in theatre.results])
    assert theatre.joint("HeadYaw") == pytest.approx(-0.3, abs=1e-3)


def test_a_program_that_goes_away_leaves_the_robot_alone(theatre: NaoqiTheatre) -> None:
    theatre.service("ALMotion").begin("angleInterpolation", "HeadYaw", 0.5, 1.0, True)
    theatre.until(lambda: theatre.driver.moves_joints)

    theatre.session.close()

    theatre.until(lambda: theatre.joint("HeadYaw") == pytest.approx(0.5, abs=1e-3))
