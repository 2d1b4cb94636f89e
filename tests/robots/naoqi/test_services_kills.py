"""Kills in a walk let the robot fall, as NAOqi's documentation warns; stopMove lets it stand."""

from __future__ import annotations

import pytest
from naoqi_theatre import NaoqiTheatre

from robots.naoqi.client.session import Session

pytestmark = pytest.mark.long

KILLS = {
    "killAll": (),
    "killMove": (),
    "killWalk": (),
    "killTasksUsingResources": (["LLeg"],),
}


@pytest.fixture
def walking(theatre: NaoqiTheatre) -> NaoqiTheatre:
    """A robot whose feet are on their way."""
    theatre.call("ALMotion", "moveToward", 1.0, 0.0, 0.0)
    theatre.until(lambda: theatre.state().base[0] > 0.05)
    return theatre


def lies(theatre: NaoqiTheatre) -> bool:
    state = theatre.state()
    return state.fallen and state.posture.startswith("Lying") and not state.moving


@pytest.mark.parametrize("kill", KILLS)
def test_a_walk_that_is_killed_ends_on_the_floor(walking: NaoqiTheatre, kill: str) -> None:
    walking.call("ALMotion", kill, *KILLS[kill])

    walking.until(lambda: lies(walking))
    assert walking.call("ALMemory", "getData", "robotHasFallen") is True
    assert walking.call("ALRobotPosture", "getPostureFamily").startswith("Lying")
    assert walking.call("ALMotion", "moveIsActive") is False


def test_a_task_that_is_killed_lets_a_walk_end_on_the_floor(walking: NaoqiTheatre) -> None:
    ((name, number, *_),) = walking.call("ALMotion", "getTaskList")

    assert walking.call("ALMotion", "killTask", number) is True

    assert name == "WalkFreely"
    walking.until(lambda: lies(walking))


@pytest.mark.parametrize("way", [(0.6, 0.0, 0.0), (-0.4, 0.0, 0.0), (0.0, 0.4, 0.0), (0, 0, 2.0)])
def test_a_walk_to_a_place_falls_whichever_way_it_goes(
    theatre: NaoqiTheatre, way: tuple[float, float, float]
) -> None:
    walk = theatre.service("ALMotion").begin("moveTo", *way)
    theatre.until(lambda: sum(map(abs, theatre.state().base)) > 0.08)

    theatre.call("ALMotion", "killMove")

    theatre.until(lambda: lies(theatre))
    assert walk.result(5.0) is False


def test_all_that_moves_joints_ends_when_it_falls(walking: NaoqiTheatre) -> None:
    waving = walking.service("ALMotion").begin(
        "angleInterpolation", ["LShoulderPitch"], [[0.5, 1.0]], [[40.0, 80.0]], True
    )

    walking.call("ALMotion", "killMove")

    assert waving.wait(10.0)
    walking.until(lambda: lies(walking))
    assert walking.call("ALMotion", "getTaskList") == []


def test_its_motors_let_go_when_it_has_fallen_and_it_gets_up_when_it_wakes_up(
    walking: NaoqiTheatre,
) -> None:
    walking.call("ALMotion", "killAll")
    walking.until(lambda: lies(walking))

    assert set(walking.call("ALMotion", "getStiffnesses", "Body")) == {0.0}
    assert walking.call("ALMotion", "robotIsWakeUp") is False

    walking.call("ALMotion", "wakeUp")

    assert walking.call("ALRobotPosture", "getPosture") == "Stand"
    assert set(walking.call("ALMotion", "getStiffnesses", "Body")) == {1.0}
    assert not walking.state().fallen


def test_a_posture_can_be_asked_of_a_fallen_robot_too(walking: NaoqiTheatre) -> None:
    walking.call("ALMotion", "killAll")
    walking.until(lambda: lies(walking))

    assert walking.call("ALRobotPosture", "goToPosture", "Stand", 1.0) is True

    assert not walking.state().fallen
    assert set(walking.call("ALMotion", "getStiffnesses", "Body")) == {1.0}


def test_a_walk_that_is_stopped_ends_its_step_and_stands(walking: NaoqiTheatre) -> None:
    walking.call("ALMotion", "stopMove")
    walking.call("ALMotion", "waitUntilMoveIsFinished")

    walking.call("ALMotion", "killAll")

    walking.until(lambda: not walking.state().moving)
    assert not walking.state().fallen
    assert walking.call("ALRobotPosture", "getPostureFamily") == "Standing"


def test_a_walk_goes_on_until_it_stands(real_time: NaoqiTheatre) -> None:
    real_time.call("ALMotion", "moveToward", 1.0, 0.0, 0.0)
    real_time.until(lambda: real_time.state().base[0] > 0.02)

    real_time.call("ALMotion", "stopMove")
    is_still_going = real_time.call("ALMotion", "moveIsActive")
    real_time.call("ALMotion", "waitUntilMoveIsFinished")

    feet_m = [
        foot[2]
        for foot in (
            real_time.call("ALMotion", "getPosition", leg, 2, True) for leg in ("LLeg", "RLeg")
        )
    ]
    assert is_still_going is True
    assert feet_m == pytest.approx([0.0, 0.0], abs=0.002)


def test_a_kill_in_the_step_that_ends_a_walk_lets_it_fall_too(real_time: NaoqiTheatre) -> None:
    real_time.call("ALMotion", "moveToward", 1.0, 0.0, 0.0)
    real_time.until(lambda: real_time.state().base[0] > 0.02)

    real_time.call("ALMotion", "stopMove")
    real_time.call("ALMotion", "killAll")

    real_time.until(lambda: lies(real_time))


@pytest.mark.parametrize("kill", ["killAll", "killMove"])
def test_a_kill_harms_nobody_once_both_feet_stand_for_good(
    real_time: NaoqiTheatre, kill: str
) -> None:
    walk = real_time.service("ALMotion").begin("moveTo", 0.04, 0.0, 0.0)
    real_time.until(lambda: real_time.call("ALMotion", "moveIsActive"))
    real_time.until(lambda: not real_time.call("ALMotion", "moveIsActive"))
    was_over = walk.done

    real_time.call("ALMotion", kill)
    is_active = real_time.call("ALMotion", "moveIsActive")
    real_time.call("ALMotion", "waitUntilMoveIsFinished")
    real_time.until(lambda: not real_time.state().moving)

    assert not was_over and not is_active  # its weight was on the way back between the feet
    assert not real_time.state().fallen
    assert real_time.state().base == pytest.approx((0.04, 0.0, 0.0), abs=0.003)


@pytest.mark.parametrize("end", ["stopMove", "move", "moveToward"])
def test_the_gentle_ends_of_a_walk_let_it_stand(walking: NaoqiTheatre, end: str) -> None:
    walking.call("ALMotion", end, *(() if end == "stopMove" else (0.0, 0.0, 0.0)))

    walking.call("ALMotion", "waitUntilMoveIsFinished")
    walking.until(lambda: not walking.state().moving)
    assert not walking.state().fallen


@pytest.mark.parametrize("kill", ["killAll", "arms", "head task"])
def test_kills_of_what_does_not_walk_harm_nobody(theatre: NaoqiTheatre, kill: str) -> None:
    motion = theatre.service("ALMotion")
    is_walking = kill != "killAll"
    if is_walking:
        motion.call("moveToward", 1.0, 0.0, 0.0)
        theatre.until(lambda: theatre.state().base[0] > 0.05)
    moving = motion.begin("angleInterpolation", ["HeadYaw", "LShoulderPitch"], 0.5, 60.0, True)
    theatre.until(lambda: len(motion.call("getTaskList")) == 1 + is_walking)
    numbers = {name: number for name, number, *_ in motion.call("getTaskList")}

    if kill == "killAll":
        motion.call("killAll")
    elif kill == "arms":
        motion.call("killTasksUsingResources", ["Head", "LArm"])
    else:
        motion.call("killTask", numbers["MoveThrough"])

    assert moving.wait(10.0)
    assert motion.call("moveIsActive") is is_walking
    if is_walking:
        motion.call("stopMove")
        motion.call("waitUntilMoveIsFinished")
    assert not theatre.state().fallen


def test_a_robot_goes_on_walking_when_its_program_is_gone(theatre: NaoqiTheatre) -> None:
    program = Session(("127.0.0.1", theatre.offered.port))
    program.connect()
    program.service("ALMotion").call("moveToward", 1.0, 0.0, 0.0)
    theatre.until(lambda: theatre.state().base[0] > 0.02)

    program.close()

    theatre.until(lambda: theatre.offered._server.clients == 1)
    gone_m = theatre.state().base[0]
    theatre.until(lambda: theatre.state().base[0] > gone_m + 0.3)
    assert theatre.call("ALMotion", "moveIsActive") is True
