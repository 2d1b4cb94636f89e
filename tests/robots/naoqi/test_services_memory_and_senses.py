"""ALMemory and the services that fill it, by what programs hear when something is sensed."""

from __future__ import annotations

from typing import Any

import pytest
from naoqi_theatre import NaoqiTheatre

from robots.naoqi.wire.errors import CallFailed, NoSuchService


def heard_events(theatre: NaoqiTheatre, event: str) -> list[Any]:
    """The list that the values of an event go into, as they come."""
    heard: list[Any] = []
    theatre.call("ALMemory", "subscriber", event).connect("signal", heard.append)
    return heard


@pytest.mark.parametrize(
    "value", [7, 2.5, "seven", True, [1, "two", [3.0]], {"a": 1}, [], "ジェスチャー"]
)
def test_what_is_inserted_is_there_again(theatre: NaoqiTheatre, value: object) -> None:
    theatre.call("ALMemory", "insertData", "mine/value", value)

    assert theatre.call("ALMemory", "getData", "mine/value") == value
    assert "mine/value" in theatre.call("ALMemory", "getDataList", "mine")


def test_removed_data_is_gone(theatre: NaoqiTheatre) -> None:
    theatre.feel("battery", 1.0)
    theatre.call("ALMemory", "insertData", "mine", 1)

    theatre.call("ALMemory", "removeData", "mine")

    with pytest.raises(CallFailed):
        theatre.call("ALMemory", "getData", "mine")
    assert theatre.call("ALMemory", "getListData", ["mine", "BatteryChargeChanged"]) == [None, 100]


def test_an_event_reaches_who_listens_and_leaves_a_history(theatre: NaoqiTheatre) -> None:
    heard = heard_events(theatre, "my/event")

    theatre.call("ALMemory", "raiseEvent", "my/event", 5)
    theatre.call("ALMemory", "raiseEvent", "my/event", [1, 2])

    theatre.until(lambda: heard == [5, [1, 2]])
    assert "my/event" in theatre.call("ALMemory", "getEventList")
    history = theatre.call("ALMemory", "getEventHistory", "my/event")
    assert [value for value, *_ in history] == [5, [1, 2]]


@pytest.mark.parametrize(
    ("sensor", "event"),
    [
        ("head_front", "FrontTactilTouched"),
        ("hand_left", "HandLeftBackTouched"),
        ("bumper_right", "RightBumperPressed"),
        ("chest_button", "ChestButtonPressed"),
    ],
)
def test_a_touch_is_an_event_when_it_begins_and_when_it_ends(
    theatre: NaoqiTheatre, sensor: str, event: str
) -> None:
    heard = heard_events(theatre, event)

    theatre.feel(sensor, 1.0)
    theatre.until(lambda: heard == [1.0])
    theatre.feel(sensor, 0.0)

    theatre.until(lambda: heard == [1.0, 0.0])


def test_touch_changed_and_the_status_name_the_sensor(theatre: NaoqiTheatre) -> None:
    heard = heard_events(theatre, "TouchChanged")

    theatre.feel("head_middle", 1.0)

    theatre.until(lambda: heard == [[["Head/Touch/Middle", True, []]]])
    status = {name: touched for name, touched, _ in theatre.call("ALTouch", "getStatus")}
    assert status["Head/Touch/Middle"] is True
    assert status["Head/Touch/Front"] is False


def test_sensors_are_measured_anew_at_each_reading(theatre: NaoqiTheatre) -> None:
    key = "Device/SubDeviceList/US/Left/Sensor/Value"
    theatre.feel("sonar_left", 0.3)
    near = theatre.call("ALMemory", "getData", key)

    theatre.feel("sonar_left", 1.5)

    assert near == pytest.approx(0.3)
    assert theatre.call("ALMemory", "getData", key) == pytest.approx(1.5)


def test_joints_are_in_the_memory(theatre: NaoqiTheatre) -> None:
    theatre.call("ALMotion", "angleInterpolation", "HeadYaw", 0.5, 0.5, True)

    key = "Device/SubDeviceList/HeadYaw/Position/Sensor/Value"
    assert theatre.call("ALMemory", "getData", key) == pytest.approx(0.5, abs=1e-3)


def test_a_battery_that_empties_is_told(theatre: NaoqiTheatre) -> None:
    heard = heard_events(theatre, "BatteryChargeChanged")

    theatre.feel("battery", 0.42)

    theatre.until(lambda: heard[-1:] == [42])
    assert theatre.call("ALBattery", "getBatteryCharge") == 42


def test_a_face_is_told_while_it_is_in_sight_and_once_that_it_is_gone(
    theatre: NaoqiTheatre,
) -> None:
    heard = heard_events(theatre, "FaceDetected")
    theatre.call("ALFaceDetection", "subscribe", "test", 20, 1.0)

    theatre.feel("face", name="Anna", place=(1.0, 0.5, 0.5))
    theatre.until(lambda: len(heard) >= 2)
    theatre.feel("face", 0.0, name="Anna")

    theatre.until(lambda: heard[-1] == [])
    _, ((shape, (number, _, label)), filtered), *_ = heard[0]
    assert shape[1] > 0.3  # to the left
    assert (number, label, filtered) == (1, "anna", [2, ["anna"]])


def test_nobody_is_told_of_faces_that_nobody_wants_to_know_of(theatre: NaoqiTheatre) -> None:
    theatre.feel("face", place=(1.0, 0.0, 0.5))

    theatre.feel("head_front", 1.0)  # what is noticed after it

    theatre.until(lambda: theatre.call("ALMemory", "getData", "FrontTactilTouched") == 1.0)
    with pytest.raises(CallFailed):
        theatre.call("ALMemory", "getData", "FaceDetected")


@pytest.mark.parametrize(
    ("sense", "service", "event"),
    [
        ("ball", "ALRedBallDetection", "redBallDetected"),
        ("mark", "ALLandMarkDetection", "LandmarkDetected"),
        ("sound", "ALSoundLocalization", "ALSoundLocalization/SoundLocated"),
    ],
)
def test_balls_marks_and_sounds_are_told_too(
    theatre: NaoqiTheatre, sense: str, service: str, event: str
) -> None:
    heard = heard_events(theatre, event)
    theatre.call(service, "subscribe", "test")

    theatre.feel(sense, name="64" if sense == "mark" else "", place=(0.8, 0.0, 0.3))

    theatre.until(lambda: len(heard) >= 1)
    assert len(heard[0]) >= 4


def test_a_word_of_the_vocabulary_is_recognized_and_others_are_not(theatre: NaoqiTheatre) -> None:
    heard = heard_events(theatre, "WordRecognized")
    theatre.call("ALSpeechRecognition", "setVocabulary", ["yes", "no"], False)
    theatre.call("ALSpeechRecognition", "subscribe", "test")
    theatre.until(lambda: theatre.state().listening == ["yes", "no"])

    theatre.feel("word", name="maybe")
    theatre.feel("word", name="Yes")

    theatre.until(lambda: len(heard) == 1)
    assert heard[0][0] == "yes"
    theatre.call("ALSpeechRecognition", "unsubscribe", "test")
    theatre.until(lambda: theatre.state().listening == [])


def test_a_word_is_spotted_in_a_sentence(theatre: NaoqiTheatre) -> None:
    heard = heard_events(theatre, "WordRecognized")
    theatre.call("ALSpeechRecognition", "setVocabulary", ["dance"], True)
    theatre.call("ALSpeechRecognition", "subscribe", "test")

    theatre.feel("word", name="Please dance for me")

    theatre.until(lambda: heard == [["<...> dance <...>", pytest.approx(0.9)]])


def test_who_spots_words_is_told_of_others_without_a_word(theatre: NaoqiTheatre) -> None:
    heard = heard_events(theatre, "WordRecognized")
    last = heard_events(theatre, "LastWordRecognized")
    theatre.call("ALSpeechRecognition", "setVocabulary", ["dance"], True)
    theatre.call("ALSpeechRecognition", "subscribe", "test")

    theatre.feel("word", name="Please sing for me")

    theatre.until(lambda: heard == [["<...>", pytest.approx(0.2)]])
    assert last == []


def test_speech_and_posture_are_events(theatre: NaoqiTheatre) -> None:
    said = heard_events(theatre, "ALTextToSpeech/CurrentSentence")
    postures = heard_events(theatre, "PostureChanged")

    theatre.call("ALTextToSpeech", "say", "Hello to all of you")
    theatre.call("ALRobotPosture", "goToPosture", "Crouch", 1.0)

    theatre.until(lambda: said == ["Hello to all of you", ""])
    theatre.until(lambda: postures[-1:] == ["Crouch"])


def test_what_is_tracked_is_followed_as_soon_as_it_is_seen(theatre: NaoqiTheatre) -> None:
    theatre.call("ALTracker", "registerTarget", "Face", 0.1)
    theatre.call("ALTracker", "track", "Face")
    was_lost = theatre.call("ALTracker", "isTargetLost")

    theatre.feel("face", place=(1.0, 1.0, 0.5))

    theatre.until(lambda: theatre.joint("HeadYaw") > 0.6)
    assert was_lost is True
    assert theatre.call("ALTracker", "getTargetPosition", 2) == pytest.approx([1.0, 1.0, 0.5])
    theatre.call("ALTracker", "stopTracker")
    assert theatre.call("ALTracker", "getActiveTarget") == ""


def test_the_head_looks_and_the_arm_points_at_a_place(theatre: NaoqiTheatre) -> None:
    theatre.call("ALTracker", "lookAt", [1.0, 1.0, 0.4], 2, 0.5, False)

    theatre.call("ALTracker", "pointAt", "LArm", [1.0, 0.1, 0.5], 2, 0.5)

    assert theatre.joint("HeadYaw") == pytest.approx(0.785, abs=0.1)
    assert theatre.joint("LShoulderPitch") < 0.2


def test_awareness_and_life_set_the_robot(theatre: NaoqiTheatre) -> None:
    theatre.call("ALAutonomousLife", "setState", "solitary")
    aware = theatre.call("ALBasicAwareness", "isEnabled")

    theatre.call("ALAutonomousLife", "setState", "disabled")

    assert aware is True
    assert theatre.call("ALBasicAwareness", "isEnabled") is False
    assert theatre.call("ALAutonomousLife", "getState") == "disabled"


@pytest.mark.parametrize(
    ("service", "method", "arguments", "words"),
    [
        ("ALMemory", "getData", ["NoSuchKey"], "no data “NoSuchKey”"),
        ("ALMemory", "unsubscribeToEvent", ["a", "b"], "“b” has not subscribed to “a”"),
        ("ALTracker", "registerTarget", ["Cat", 0.1], "“Cat” cannot be followed"),
        ("ALTracker", "track", ["Face"], "call registerTarget first"),
        ("ALTracker", "setMode", ["Fly"], "there is no “Fly”"),
        ("ALSonar", "unsubscribe", ["me"], "“me” has not subscribed"),
        ("ALBasicAwareness", "setEngagementMode", ["Shy"], "there is no “Shy”"),
        ("ALAutonomousLife", "setState", ["wild"], "no state “wild”"),
        ("ALFaceDetection", "learnFace", ["Anna"], "sees nobody"),
    ],
)
def test_what_is_wrong_is_told_in_words(
    theatre: NaoqiTheatre, service: str, method: str, arguments: list[object], words: str
) -> None:
    with pytest.raises(CallFailed) as refused:
        theatre.call(service, method, *arguments)

    assert words in str(refused.value.sentence)


def test_a_service_that_a_nao_does_not_have_is_not_found(theatre: NaoqiTheatre) -> None:
    with pytest.raises(NoSuchService):
        theatre.service("ALTeleport")
