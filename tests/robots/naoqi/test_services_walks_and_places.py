"""ALMotion's walks, places and tasks, by where the robot and its hands are afterwards."""

from __future__ import annotations

import math
import time

import pytest
from naoqi_theatre import NaoqiTheatre

from robots.naoqi.wire.errors import CallFailed

pytestmark = pytest.mark.long


def test_walking_ends_where_it_was_told_to(theatre: NaoqiTheatre) -> None:
    arrived = theatre.call("ALMotion", "moveTo", 0.1, 0.05, 0.3)

    assert arrived is True
    place = theatre.call("ALMotion", "getRobotPosition", True)
    assert place == pytest.approx([0.1, 0.05, 0.3], abs=0.02)


def test_several_places_are_seen_from_where_the_walk_starts(theatre: NaoqiTheatre) -> None:
    places = [[0.1, 0.0, math.pi / 2.0], [0.1, 0.1, math.pi / 2.0]]

    theatre.call("ALMotion", "moveTo", places)

    place = theatre.call("ALMotion", "getRobotPosition", True)
    assert place == pytest.approx([0.1, 0.1, math.pi / 2.0], abs=0.03)


def test_a_place_asked_for_in_a_walk_takes_the_place_of_the_first(theatre: NaoqiTheatre) -> None:
    walking = theatre.service("ALMotion").begin("moveTo", 1.0, 0.0, 0.0)
    theatre.until(lambda: theatre.state().base[0] > 0.1)

    theatre.call("ALMotion", "moveTo", 0.2, 0.0, -0.5)

    x, y, theta = theatre.call("ALMotion", "getRobotPosition", True)
    assert walking.result(5.0) is True
    assert theta == pytest.approx(-0.5, abs=0.02)
    assert x < 0.8 and y == pytest.approx(0.0, abs=0.02)
    assert not theatre.call("ALMotion", "moveIsActive") and not theatre.state().fallen


def test_a_walk_whose_place_is_changed_again_and_again_does_not_stand_in_between(
    real_time: NaoqiTheatre,
) -> None:
    motion, begun_s = real_time.service("ALMotion"), time.monotonic()
    while time.monotonic() - begun_s < 6.0:
        motion.begin("moveTo", 0.04, 0.0, 0.0)
        time.sleep(0.1)
    gone_m = motion.call("getRobotPosition", True)[0]
    motion.call("waitUntilMoveIsFinished")

    legs_alone_m = 0.04 * 6.0 / 1.74
    assert gone_m > 2.0 * legs_alone_m  # it would be 3.5 times on a quiet computer
    assert motion.call("getRobotPosition", True)[0] - gone_m < 0.13


def test_it_tells_where_it_will_be_after_the_step_that_it_cannot_change(
    theatre: NaoqiTheatre,
) -> None:
    motion, steps = theatre.service("ALMotion"), set()
    walking = motion.begin("moveTo", 0.2, 0.0, 0.0)
    while not walking.done:
        steps.add(round(motion.call("getNextRobotPosition")[0] / 0.04, 3))

    assert steps <= {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}
    assert motion.call("getNextRobotPosition") == motion.call("getRobotPosition", False)


def test_walking_on_lasts_until_it_is_stopped(theatre: NaoqiTheatre) -> None:
    theatre.call("ALMotion", "moveToward", 1.0, 0.0, 0.0)
    theatre.until(lambda: theatre.state().base[0] > 0.05)
    was_walking = theatre.call("ALMotion", "moveIsActive")

    theatre.call("ALMotion", "stopMove")

    theatre.call("ALMotion", "waitUntilMoveIsFinished")
    assert was_walking is True
    assert theatre.call("ALMotion", "moveIsActive") is False


def test_a_motion_of_the_head_does_not_wait_for_the_legs(theatre: NaoqiTheatre) -> None:
    walking = theatre.service("ALMotion").begin("moveTo", 0.6, 0.0, 0.0)
    theatre.until(theatre.service("ALMotion").begin("moveIsActive").result(1.0).__bool__)

    theatre.call("ALMotion", "angleInterpolation", "HeadYaw", 0.5, 0.3, True)

    assert not walking.done
    assert theatre.joint("HeadYaw") == pytest.approx(0.5, abs=0.01)


def test_tasks_are_listed_and_can_be_ended_one_by_one(real_time: NaoqiTheatre) -> None:
    motion = real_time.service("ALMotion")
    moving = motion.begin("angleInterpolation", "HeadYaw", 1.0, 5.0, True)
    real_time.until(lambda: bool(motion.call("getTaskList")))
    ((name, number, _, _, joints),) = motion.call("getTaskList")

    ended = motion.call("killTask", number)

    assert (name, joints) == ("MoveThrough", ["HeadYaw", "HeadPitch"])
    assert ended is True
    assert moving.result(0.5) is None
    assert motion.call("killTask", number) is False


def test_a_hand_is_where_the_arm_points(theatre: NaoqiTheatre) -> None:
    straight = {"LShoulderPitch": 0.0, "LShoulderRoll": 0.0, "LElbowRoll": -0.04}
    theatre.call(
        "ALMotion", "angleInterpolation", list(straight), list(straight.values()), 1.0, True
    )

    x, y, z, *_ = theatre.call("ALMotion", "getPosition", "LArm", 0, True)

    assert x > 0.2
    assert y == pytest.approx(0.1, abs=0.03)
    assert z == pytest.approx(0.1, abs=0.03)


def test_a_hand_comes_to_the_place_where_it_is_sent(theatre: NaoqiTheatre) -> None:
    place = [0.15, 0.15, 0.1, 0.0, 0.0, 0.0]

    theatre.call("ALMotion", "positionInterpolation", "LArm", 0, place, 7, 1.0, True)

    there = theatre.call("ALMotion", "getPosition", "LArm", 0, True)
    assert there[:3] == pytest.approx(place[:3], abs=0.003)


def test_a_hand_goes_a_way_from_where_it_is_and_comes_back(theatre: NaoqiTheatre) -> None:
    before = theatre.call("ALMotion", "getPosition", "RArm", 2, True)
    path = [[0.0, 0.0, 0.04, 0.0, 0.0, 0.0], [0.0] * 6]

    theatre.call(
        "ALMotion", "positionInterpolations", ["RArm"], 2, [path], [7], [[1.0, 2.0]], False
    )

    after = theatre.call("ALMotion", "getPosition", "RArm", 2, True)
    assert after[:3] == pytest.approx(before[:3], abs=0.005)


def test_set_position_does_not_wait(real_time: NaoqiTheatre) -> None:
    start_s = time.monotonic()

    real_time.call("ALMotion", "setPosition", "LArm", 0, [0.18, 0.12, 0.05, 0, 0, 0], 0.5, 7)

    assert time.monotonic() - start_s < 1.0  # 0.2 s on a quiet computer
    real_time.until(
        lambda: (
            real_time.call("ALMotion", "getPosition", "LArm", 0, True)[:3]
            == pytest.approx([0.18, 0.12, 0.05], abs=0.005)
        )
    )


def test_the_torso_stands_above_the_feet(theatre: NaoqiTheatre) -> None:
    height_m = theatre.call("ALMotion", "getPosition", "Torso", 2, True)[2]
    feet_m = theatre.call("ALMotion", "getPosition", "LLeg", 2, True)[2]

    assert 0.25 < height_m < 0.4
    assert feet_m == pytest.approx(0.0, abs=0.01)


def test_a_robot_that_sits_says_why_it_does_not_walk(theatre: NaoqiTheatre) -> None:
    theatre.call("ALRobotPosture", "goToPosture", "Sit", 1.0)

    with pytest.raises(CallFailed) as refused:
        theatre.call("ALMotion", "moveTo", 0.2, 0.0, 0.0)

    assert "it must stand before it can walk" in str(refused.value.sentence)
