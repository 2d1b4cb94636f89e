"""How movements become NAOqi's curves, and NAOqi's events human states."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from driver_stage import ANIMATIONS, BODY

from robots.body.actions import ACTIONS, Listen, SetAngles, Stop, StopMoving
from robots.body.driver import NOT_UNDERSTOOD
from robots.body.keyframes import Keyframes, Track, track_angles
from robots.body.pose import VirtualRobot
from robots.naoqi.driver import watching
from robots.naoqi.driver.calls import Calls
from robots.naoqi.driver.driver import TASKS
from robots.naoqi.driver.moving import bezier_call
from robots.naoqi.driver.real import RealRobot
from robots.naoqi.driver.watching import Noticing


def test_there_is_a_task_for_every_action_of_the_language() -> None:
    by_the_actor = {Stop, StopMoving, SetAngles, Listen}  # ears have a place of their own

    assert set(ACTIONS.values()) - set(TASKS) == by_the_actor


@pytest.mark.parametrize("name", ANIMATIONS.names())
def test_every_animation_becomes_a_curve_that_naoqi_plays_as_we_do(name: str) -> None:
    keyframes = ANIMATIONS.get(name).keyframes
    pose = BODY.posture_angles("Stand")

    call = bezier_call(BODY, pose, keyframes)

    for joint, times, keys in zip(call.names, call.times, call.keys, strict=True):
        column = BODY.index[joint]
        handles = tuple((*key[1][1:], *key[2][1:]) for key in keys)
        told = Track(tuple(times), tuple(key[0] for key in keys), handles)
        at = np.linspace(0.02, times[-1], 60)
        fastest = float(BODY.max_speed[column])
        angles = track_angles(told, float(pose[column]), at, fastest)
        assert np.all(angles >= BODY.min[column] - 1e-6)
        assert np.all(angles <= BODY.max[column] + 1e-6)
        assert np.max(np.abs(np.diff(angles)) / np.diff(at)) <= fastest * 1.06


def test_angles_that_joints_cannot_have_are_clamped_and_told() -> None:
    pose = BODY.posture_angles("Stand")
    keyframes = Keyframes({"LElbowRoll": Track((2.0,), (3.0,))})

    call = bezier_call(BODY, pose, keyframes)

    assert call.keys[0][0][0] == pytest.approx(BODY.max[BODY.index["LElbowRoll"]])
    assert "kept within the limits of LElbowRoll" in call.notes


def bare_robot() -> RealRobot:
    return RealRobot(VirtualRobot("NAO", BODY, ANIMATIONS), Calls("NAO", {}))


@pytest.mark.parametrize("value", [None, [], [1], "x", [[0, 0], "x"], [[0], [[[1]]]], {}, 3.5])
@pytest.mark.parametrize(
    "event",
    ["FaceDetected", "LandmarkDetected", "redBallDetected", "WordRecognized", "FrontTactilTouched",
     "ALSoundLocalization/SoundLocated", "something else"],
)  # fmt: skip
def test_events_that_are_not_understood_are_not_noticed(event: str, value: Any) -> None:
    noticing = Noticing(bare_robot())

    states = noticing.hear(event, value)

    assert states == [] or event == "FrontTactilTouched"


def test_a_word_that_is_not_sure_is_not_heard() -> None:
    noticing = Noticing(bare_robot())

    unsure = noticing.hear("WordRecognized", ["yes", 0.2])
    sure = noticing.hear("WordRecognized", ["<...> yes <...>", 0.6])

    assert (unsure, sure) == ([], ["heard_yes"])


@pytest.mark.parametrize(
    ("told", "states"),
    [
        (["<...>", 0.2], [NOT_UNDERSTOOD]),
        (["<...> yes <...>", 0.3], [NOT_UNDERSTOOD]),
        (["<...>", 0.9], [NOT_UNDERSTOOD]),
        (["<...> yes <...>", 0.5], ["heard_yes"]),
        (["yes", 0.05], []),
        (["", -3.0], []),
        (["yes", float("nan")], []),
    ],
)
def test_a_robot_that_listens_notices_that_it_did_not_understand(
    told: list[object], states: list[str]
) -> None:
    robot = bare_robot()
    robot.known.listening = ("yes", "no")

    assert Noticing(robot).hear("WordRecognized", told) == states


def test_a_robot_that_has_just_spoken_does_not_wonder_what_was_said(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    robot = bare_robot()
    noticing = Noticing(robot)
    robot.known.listening, robot.known.saying = ("yes",), "Do you like robots?"
    noticing.forget()
    robot.known.saying = ""

    echo = noticing.hear("WordRecognized", ["<...>", 0.3])
    monkeypatch.setattr(watching, "ECHO_S", 0.0)
    later = noticing.hear("WordRecognized", ["<...>", 0.3])

    assert (echo, later) == ([], [NOT_UNDERSTOOD])


def test_one_sensor_with_several_places_is_touched_until_all_are_let_go() -> None:
    noticing = Noticing(bare_robot())

    states = [
        noticing.hear("HandLeftBackTouched", 1.0),
        noticing.hear("HandLeftLeftTouched", 1.0),
        noticing.hear("HandLeftBackTouched", 0.0),
    ]

    assert states == [["touched_hand_left", "touched_hand"], [], []]
    assert noticing.touched["hand_left"] == 1.0
