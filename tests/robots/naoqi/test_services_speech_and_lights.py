"""Speech, animated speech, animations and lights, by what the robot says, shows and does."""

from __future__ import annotations

import time

import pytest
from naoqi_theatre import NaoqiTheatre

from robots.naoqi.wire.errors import CallFailed

HEY = "animations/Stand/Gestures/Hey_1"


def test_say_waits_until_the_words_are_said(real_time: NaoqiTheatre) -> None:
    saying = real_time.service("ALTextToSpeech").begin("say", "Hello there")

    real_time.until(lambda: real_time.state().saying == "Hello there")

    saying.result(5.0)
    assert real_time.state().saying == ""


def test_tags_of_the_voice_are_not_said(real_time: NaoqiTheatre) -> None:
    start_s = time.monotonic()
    saying = real_time.service("ALTextToSpeech").begin("say", r"\rspd=200\Hello \pau=300\ you")

    real_time.until(lambda: real_time.state().saying == "Hello")
    real_time.until(lambda: real_time.state().saying == "you")

    saying.result(5.0)
    assert time.monotonic() - start_s > 0.3


def test_stop_all_ends_what_is_said_at_once(real_time: NaoqiTheatre) -> None:
    saying = real_time.service("ALTextToSpeech").begin("say", "word " * 50)
    real_time.until(lambda: bool(real_time.state().saying))
    start_s = time.monotonic()

    real_time.call("ALTextToSpeech", "stopAll")

    saying.result(5.0)
    assert time.monotonic() - start_s < 1.0  # 0.2 s on a quiet computer
    real_time.until(lambda: not real_time.state().saying)


def test_language_volume_and_parameters_are_kept(theatre: NaoqiTheatre) -> None:
    theatre.call("ALTextToSpeech", "setLanguage", "French")
    theatre.call("ALTextToSpeech", "setVolume", 0.5)
    theatre.call("ALTextToSpeech", "setParameter", "speed", 80.0)

    settings = theatre.state().settings
    assert (settings["language"], settings["volume"]) == ("fr", 50.0)
    assert theatre.call("ALTextToSpeech", "getLanguage") == "French"
    assert theatre.call("ALTextToSpeech", "getVolume") == pytest.approx(0.5)
    assert theatre.call("ALTextToSpeech", "getParameter", "speed") == 80.0


def test_an_animation_begins_between_the_words_and_ends_with_them(
    real_time: NaoqiTheatre,
) -> None:
    text = f"Hello ^start({HEY}) you"
    saying = real_time.service("ALAnimatedSpeech").begin(
        "say", text, {"bodyLanguageMode": "disabled"}
    )

    real_time.until(lambda: real_time.state().saying == "Hello")
    moved_before = real_time.driver.moves_joints
    real_time.until(lambda: real_time.state().saying == "you")
    moves_now = real_time.driver.moves_joints

    saying.result(5.0)
    assert (moved_before, moves_now) == (False, True)
    assert not [c for c in real_time.offered.robot.commands() if c.id.startswith("naoqi")]


def test_wait_lets_an_animation_play_to_its_end(theatre: NaoqiTheatre) -> None:
    name = "wave"
    seconds = theatre.robot.animations.get(name).keyframes.duration_s
    start_s = time.monotonic()

    theatre.call("ALAnimatedSpeech", "say", f"^start({HEY}) Hi ^wait({HEY})")

    assert time.monotonic() - start_s > seconds / 10.0


@pytest.mark.parametrize(
    ("text", "arms_move"), [("What is your name?", True), ("^mode(disabled) Hello", False)]
)
def test_the_body_speaks_too_unless_that_is_switched_off(
    real_time: NaoqiTheatre, text: str, arms_move: bool
) -> None:
    saying = real_time.service("ALAnimatedSpeech").begin("say", text)

    real_time.until(lambda: bool(real_time.state().saying))

    assert real_time.driver.moves_joints is arms_move
    saying.cancel()


def test_an_unknown_animation_is_told_before_a_word_is_said(theatre: NaoqiTheatre) -> None:
    with pytest.raises(CallFailed) as refused:
        theatre.call("ALAnimatedSpeech", "say", "Hello ^start(animations/Stand/Gestures/Fly_1)")

    assert "There is no animation" in str(refused.value.sentence)
    assert theatre.state().saying == ""


@pytest.mark.parametrize("path", [HEY, "animations/[posture]/Gestures/Hey_4", "Gestures/Yes_1"])
def test_animations_are_found_by_the_paths_of_a_real_nao(theatre: NaoqiTheatre, path: str) -> None:
    before = theatre.state().joints
    playing = theatre.service("ALAnimationPlayer").begin("run", path)

    theatre.until(lambda: theatre.state().joints != before)

    assert playing.result(20.0) is None


def test_a_tag_plays_one_of_its_animations(theatre: NaoqiTheatre) -> None:
    assert theatre.call("ALAnimationPlayer", "runTag", "hello") is None

    with pytest.raises(CallFailed) as refused:
        theatre.call("ALAnimationPlayer", "runTag", "quantum")
    assert "No animation has the tag “quantum”" in str(refused.value.sentence)


def test_every_installed_behavior_can_be_played_by_its_name(theatre: NaoqiTheatre) -> None:
    paths = theatre.call("ALBehaviorManager", "getInstalledBehaviors")

    installed = [theatre.call("ALBehaviorManager", "isBehaviorInstalled", p) for p in paths]

    assert HEY in paths
    assert len(paths) > 60
    assert all(installed)
    assert theatre.call("ALBehaviorManager", "isBehaviorInstalled", "my/own") is False


def test_a_behavior_runs_until_it_is_stopped(real_time: NaoqiTheatre) -> None:
    manager = real_time.service("ALBehaviorManager")
    started: list[str] = []
    stopped: list[str] = []
    manager.connect("behaviorStarted", started.append)
    manager.connect("behaviorStopped", stopped.append)
    manager.call("startBehavior", HEY)
    running = manager.call("getRunningBehaviors")

    manager.call("stopBehavior", HEY)

    assert running == [HEY]
    assert manager.call("isBehaviorRunning", HEY) is False
    real_time.until(lambda: (started, stopped) == ([HEY], [HEY]))


def test_to_stop_a_behavior_that_is_not_played_stops_nothing_else(real_time: NaoqiTheatre) -> None:
    saying = real_time.service("ALTextToSpeech").begin("say", "word " * 50)
    real_time.until(lambda: bool(real_time.state().saying))

    real_time.call("ALBehaviorManager", "stopBehavior", HEY)

    assert not saying.done
    assert real_time.state().saying


@pytest.mark.parametrize(
    ("arguments", "colour"),
    [
        (["FaceLeds", "red", 0.1], 0xFF0000),
        (["FaceLeds", 0x00FF00, 0.1], 0x00FF00),
        (["FaceLeds", 0.0, 0.0, 1.0, 0.1], 0x0000FF),
    ],
)
def test_the_three_ways_to_fade_end_in_their_colour(
    theatre: NaoqiTheatre, arguments: list[object], colour: int
) -> None:
    theatre.call("ALLeds", "fadeRGB", *arguments)

    eyes = theatre.state().leds
    assert (eyes["LeftFaceLeds"], eyes["RightFaceLeds"]) == (colour, colour)


def test_a_list_of_colours_is_shown_in_its_time(theatre: NaoqiTheatre) -> None:
    start_s = time.monotonic()

    theatre.call("ALLeds", "fadeListRGB", "ChestLeds", [0xFF0000, 0x00FF00], [1.0, 2.0])

    assert time.monotonic() - start_s > 0.19
    assert theatre.state().leds["ChestLeds"] == 0x00FF00


def test_lights_go_off_on_and_back(theatre: NaoqiTheatre) -> None:
    theatre.call("ALLeds", "off", "FaceLeds")
    off = theatre.state().leds["LeftFaceLeds"]
    theatre.call("ALLeds", "setIntensity", "FaceLeds", 0.5)
    half = theatre.call("ALLeds", "getIntensity", "LeftFaceLeds")

    theatre.call("ALLeds", "reset", "FaceLeds")

    assert off == 0
    assert half == pytest.approx([0.5, 0.5, 0.5], abs=0.01)
    assert theatre.state().leds["LeftFaceLeds"] == 0xFFFFFF


def test_a_group_of_ones_own_is_lit_as_one(theatre: NaoqiTheatre) -> None:
    theatre.call("ALLeds", "createGroup", "Mine", ["ChestLeds", "LeftFootLeds"])

    theatre.call("ALLeds", "fadeRGB", "Mine", "cyan", 0.1)

    assert "Mine" in theatre.call("ALLeds", "listGroups")
    lights = theatre.state().leds
    assert (lights["ChestLeds"], lights["LeftFootLeds"]) == (0x00FFFF, 0x00FFFF)


@pytest.mark.parametrize(
    ("service", "method", "arguments", "words"),
    [
        ("ALLeds", "fadeRGB", ["NoseLeds", "red", 0.1], "no lights called “NoseLeds”"),
        ("ALLeds", "fadeRGB", ["FaceLeds", "pinkish", 0.1], "no colour “pinkish”"),
        ("ALTextToSpeech", "setLanguage", ["Klingon"], "no language “Klingon”"),
        ("ALTextToSpeech", "setVolume", [3.0], "from 0 to 1, not 3"),
        ("ALTextToSpeech", "setParameter", ["echo", 1.0], "no parameter “echo”"),
        ("ALTextToSpeech", "sayToFile", ["Hi", "a.wav"], "has no files"),
        ("ALAnimatedSpeech", "setBodyLanguageModeFromStr", ["wild"], "no mode “wild”"),
        ("ALAudioPlayer", "playFile", ["/not/there.wav"], "finds no sound file"),
        ("ALPhotoCapture", "takePictures", [0, "pictures", "a"], "from 1 to 20, not 0"),
        ("ALVideoRecorder", "stopRecording", [], "no video to stop"),
        ("ALSystem", "shutdown", [], "switched off by stopping its node"),
    ],
)
def test_what_it_cannot_do_is_told_in_words(
    theatre: NaoqiTheatre, service: str, method: str, arguments: list[object], words: str
) -> None:
    with pytest.raises(CallFailed) as refused:
        theatre.call(service, method, *arguments)

    assert words in str(refused.value.sentence)
