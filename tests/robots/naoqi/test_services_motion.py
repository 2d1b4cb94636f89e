"""ALMotion and ALRobotPosture as programs reach them, by how the robot is afterwards."""

from __future__ import annotations

import time

import pytest
from naoqi_theatre import NaoqiTheatre

from robots.naoqi.wire.errors import CallCancelled, CallFailed


def test_an_interpolation_takes_its_time_and_ends_at_its_last_angles(
    real_time: NaoqiTheatre,
) -> None:
    angles, times = [[0.4, 0.2], [0.1]], [[0.3, 0.6], [0.4]]
    start_s = time.monotonic()

    real_time.call("ALMotion", "angleInterpolation", ["HeadYaw", "HeadPitch"], angles, times, True)

    assert 0.55 < time.monotonic() - start_s < 3.0
    assert real_time.call("ALMotion", "getAngles", "Head", True) == pytest.approx([0.2, 0.1])


@pytest.mark.parametrize(
    ("names", "angles", "times", "ends"),
    [
        ("HeadYaw", 0.3, 1.0, [0.3]),
        ("HeadYaw", [0.3, -0.2], [0.5, 1.0], [-0.2]),
        ("Head", [0.3, -0.2], 1.0, [0.3, -0.2]),
        (["HeadYaw", "HeadPitch"], [[0.3], [-0.2]], [[1.0], [1.0]], [0.3, -0.2]),
        (["HeadYaw"], [[0.3, 0.1]], [[0.5, 1.0]], [0.1]),
    ],
)
def test_names_angles_and_times_may_be_single_or_lists(
    theatre: NaoqiTheatre, names: object, angles: object, times: object, ends: list[float]
) -> None:
    theatre.call("ALMotion", "angleInterpolation", names, angles, times, True)

    assert theatre.call("ALMotion", "getAngles", names, True) == pytest.approx(ends, abs=1e-3)


def test_relative_angles_are_added_to_where_the_joint_is(theatre: NaoqiTheatre) -> None:
    theatre.call("ALMotion", "angleInterpolation", "HeadYaw", 0.5, 0.5, True)

    theatre.call("ALMotion", "angleInterpolation", "HeadYaw", -0.2, 0.5, False)

    assert theatre.joint("HeadYaw") == pytest.approx(0.3, abs=1e-3)


def test_bezier_keys_are_reached(theatre: NaoqiTheatre) -> None:
    keys = [[[0.5, [3, -0.3, 0.0], [3, 0.3, 0.0]], [0.1, [3, -0.3, 0.0], [3, 0.0, 0.0]]]]

    theatre.call("ALMotion", "angleInterpolationBezier", ["HeadYaw"], [[1.0, 2.0]], keys)

    assert theatre.joint("HeadYaw") == pytest.approx(0.1, abs=1e-3)


def test_angles_beyond_a_joints_limits_are_kept_to_them(theatre: NaoqiTheatre) -> None:
    theatre.call("ALMotion", "angleInterpolationWithSpeed", "HeadYaw", 9.0, 1.0)

    limit = theatre.call("ALMotion", "getLimits", "HeadYaw")[0][1]
    assert theatre.joint("HeadYaw") == pytest.approx(limit, abs=1e-3)


def test_set_angles_does_not_wait_and_keeps_to_its_part_of_the_top_speed(
    real_time: NaoqiTheatre,
) -> None:
    _, _, top_speed, _ = real_time.call("ALMotion", "getLimits", "HeadYaw")[0]
    start_s = time.monotonic()

    real_time.call("ALMotion", "setAngles", "HeadYaw", 1.0, 0.2)

    assert time.monotonic() - start_s < 1.0  # 0.2 s on a quiet computer
    assert real_time.call("ALMotion", "getAngles", "HeadYaw", False) == [1.0]
    real_time.until(lambda: real_time.joint("HeadYaw") > 0.999)
    assert time.monotonic() - start_s > 1.0 / (0.2 * top_speed)


def test_set_angles_again_changes_the_goal_on_the_way(theatre: NaoqiTheatre) -> None:
    theatre.call("ALMotion", "setAngles", ["HeadYaw", "LShoulderPitch"], [2.0, 0.5], 0.1)

    theatre.call("ALMotion", "setAngles", "HeadYaw", -0.5, 1.0)

    theatre.until(lambda: theatre.joint("HeadYaw") == pytest.approx(-0.5, abs=1e-3))
    theatre.until(lambda: theatre.joint("LShoulderPitch") == pytest.approx(0.5, abs=1e-3))


def test_change_angles_counts_from_where_the_joint_was_told_to_go(theatre: NaoqiTheatre) -> None:
    theatre.call("ALMotion", "setAngles", "HeadYaw", 0.5, 0.1)

    theatre.call("ALMotion", "changeAngles", "HeadYaw", 0.25, 0.1)

    theatre.until(lambda: theatre.joint("HeadYaw") == pytest.approx(0.75, abs=1e-3))


def test_a_loose_joint_does_not_move_and_nobody_is_told(theatre: NaoqiTheatre) -> None:
    theatre.call("ALMotion", "setStiffnesses", "HeadYaw", 0.0)

    theatre.call("ALMotion", "angleInterpolation", "Head", [0.5, 0.2], 0.5, True)

    assert theatre.call("ALMotion", "getStiffnesses", "Head") == [0.0, 1.0]
    assert theatre.call("ALMotion", "getAngles", "Head", True) == pytest.approx([0.0, 0.2])


def test_rest_lets_all_motors_loose_and_wake_up_holds_them(theatre: NaoqiTheatre) -> None:
    theatre.call("ALMotion", "rest")
    rested = theatre.call("ALMotion", "robotIsWakeUp")

    theatre.call("ALMotion", "wakeUp")

    assert rested is False
    assert theatre.call("ALMotion", "robotIsWakeUp") is True
    assert set(theatre.call("ALMotion", "getStiffnesses", "Body")) == {1.0}


def test_hands_open_and_close(theatre: NaoqiTheatre) -> None:
    theatre.call("ALMotion", "openHand", "LHand")
    opened = theatre.joint("LHand")

    theatre.call("ALMotion", "closeHand", "LHand")

    assert (opened, theatre.joint("LHand")) == (1.0, 0.0)


def test_kill_all_reaches_a_motion_at_once(real_time: NaoqiTheatre) -> None:
    moving = real_time.service("ALMotion").begin("angleInterpolation", "HeadYaw", 2.0, 5.0, True)
    real_time.until(lambda: real_time.joint("HeadYaw") > 0.05)
    start_s = time.monotonic()

    real_time.call("ALMotion", "killAll")

    assert moving.result(5.0) is None
    assert time.monotonic() - start_s < 1.0  # 0.2 s on a quiet computer
    real_time.until(lambda: not real_time.driver.moves_joints)
    assert real_time.joint("HeadYaw") < 1.0


def test_a_caller_who_gives_up_stops_the_robot(real_time: NaoqiTheatre) -> None:
    going = real_time.service("ALRobotPosture").begin("goToPosture", "Sit", 0.5)
    real_time.until(lambda: real_time.driver.moves_joints)
    start_s = time.monotonic()

    going.cancel()

    with pytest.raises(CallCancelled):
        going.result(5.0)
    assert time.monotonic() - start_s < 1.0  # 0.2 s on a quiet computer
    real_time.until(lambda: not real_time.driver.moves_joints, timeout_s=5.0)


def test_a_posture_that_is_stopped_is_not_reached(real_time: NaoqiTheatre) -> None:
    going = real_time.service("ALRobotPosture").begin("goToPosture", "Sit", 0.5)
    real_time.until(lambda: real_time.driver.moves_joints)

    real_time.call("ALRobotPosture", "stopMove")

    assert going.result(0.2) is False


@pytest.mark.parametrize("posture", ["Crouch", "Sit", "LyingBelly", "StandZero"])
def test_a_posture_is_reached_and_recognized(theatre: NaoqiTheatre, posture: str) -> None:
    reached = theatre.call("ALRobotPosture", "goToPosture", posture, 1.0)

    assert reached is True
    assert theatre.call("ALRobotPosture", "getPosture") == posture
    assert theatre.call("ALRobotPosture", "getPostureFamily") in theatre.call(
        "ALRobotPosture", "getPostureFamilyList"
    )


def test_a_body_bent_by_its_joints_is_in_no_posture(theatre: NaoqiTheatre) -> None:
    theatre.call("ALMotion", "angleInterpolation", "LShoulderPitch", -1.0, 0.5, True)

    assert theatre.call("ALRobotPosture", "getPosture") == "Unknown"


def test_two_motions_of_one_joint_come_one_after_the_other(theatre: NaoqiTheatre) -> None:
    motion = theatre.service("ALMotion")
    first = motion.begin("angleInterpolation", "HeadYaw", 1.0, 2.0, True)

    second = motion.begin("angleInterpolation", "HeadYaw", -0.5, 1.0, True)

    second.result(10.0)
    assert first.done
    assert theatre.joint("HeadYaw") == pytest.approx(-0.5, abs=1e-3)


@pytest.mark.parametrize(
    ("method", "arguments", "words"),
    [
        ("getAngles", ["Nose", True], "no joint, chain or group “Nose”"),
        ("setAngles", ["HeadYaw", 0.5, 3.0], "from 0 to 1, not 3"),
        ("setAngles", [["HeadYaw", "HeadPitch"], [0.1, 0.2, 0.3], 0.5], "3 angles for 2 joints"),
        ("setAngles", ["HeadYaw", "left", 0.5], "A number was expected, not 'left'"),
        ("angleInterpolation", ["HeadYaw", [0.1, 0.2], [1.0], True], "2 angles for 1 times"),
        ("angleInterpolation", ["HeadYaw", [0.1, 0.2], [1.0, 0.5], True], "later than the one"),
        ("angleInterpolation", ["HeadYaw", 0.1, 0.0, True], "times must be above 0"),
        ("angleInterpolation", ["HeadYaw", 0.1, 1e9, True], "At most 600 s are possible"),
        ("moveTo", [3.0], "A place is three numbers"),
        ("openHand", ["LFoot"], "no hand “LFoot”"),
        ("setStiffnesses", ["Body", 2.0], "from 0 to 1, not 2"),
        ("moveToward", [2.0, 0.0, 0.0], "from -1 to 1, not 2"),
        ("getPosition", ["LArm", 7, True], "no space 7"),
        ("setPosition", ["LLeg", 0, [0.0] * 6, 0.5, 7], "“LLeg” cannot be sent to a place"),
        ("setPosition", ["LArm", 0, [0.1, 0.2], 0.5, 7], "A place is six numbers"),
        ("moveTo", [0.1, 0.0, 0.0, [["Speed", 1.0]]], "no setting “Speed”"),
    ],
)
def test_what_cannot_be_is_refused_in_words(
    theatre: NaoqiTheatre, method: str, arguments: list[object], words: str
) -> None:
    with pytest.raises(CallFailed) as refused:
        theatre.call("ALMotion", method, *arguments)

    assert words in str(refused.value.sentence)
