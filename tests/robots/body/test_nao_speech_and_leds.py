from __future__ import annotations

import numpy as np
import pytest
from nao_stage import ANIMATIONS, BODY, Stage

from robots.body import body
from robots.body.limbs import Limb
from robots.body.speech import speaking_time_s
from robots.errors import ActionFailed
from tests.conftest import a_part_of

pytestmark = pytest.mark.long


def test_speaking_takes_about_a_second_for_14_characters() -> None:
    assert speaking_time_s("Impressive") == pytest.approx(10 / 14)
    assert speaking_time_s("I am a robot who likes to talk a lot about robots") == pytest.approx(
        3.5
    )


def test_marks_between_words_make_pauses_and_the_last_one_does_not() -> None:
    assert speaking_time_s("Stop. Now") == pytest.approx(speaking_time_s("Stop, Now") + 0.25)
    assert speaking_time_s("Stop now!!!") == speaking_time_s("Stop now")
    assert speaking_time_s("3.14 m") == pytest.approx(6 / 14)


def test_nothing_to_say_takes_no_time_and_a_short_word_takes_a_moment() -> None:
    assert speaking_time_s(" ... ") == 0.0
    assert speaking_time_s("I") == 0.3


def test_a_japanese_sign_takes_longer_than_a_letter() -> None:
    assert speaking_time_s("こんにちは、ロボット") > 1.5 * speaking_time_s("abcdefghij")


def test_it_says_so_as_long_as_it_speaks() -> None:
    stage = Stage()
    stage.ask("1", "say", text="Impressive!")

    stage.pass_time(0.5)
    during = stage.robot.saying
    stage.finish()

    assert (during, stage.robot.saying) == ("Impressive!", "")
    assert stage.now_s == pytest.approx(10 / 14, abs=0.03)
    assert stage.told == ["1 accepted", "1 started", "1 done"]


@pytest.mark.parametrize("gesture", a_part_of(ANIMATIONS.names("gesture")))
def test_gestures_move_the_arms_for_as_long_as_the_words_last(gesture: str) -> None:
    stage = Stage()
    text = "This is quite a long sentence, so that the arms have something to do. Is it not?"
    arms = BODY.columns({Limb.LEFT_ARM, Limb.RIGHT_ARM, Limb.HEAD})
    before = stage.robot.angles[arms].copy()

    stage.ask("1", "say", text=text, gesture=gesture)
    took_s = stage.finish()

    moved = [
        i * 0.01 for i, row in enumerate(stage.angles) if np.abs(row[arms] - before).max() > 0.01
    ]
    assert min(moved) < 1.0 and max(moved) > speaking_time_s(text) - 0.5
    assert took_s == pytest.approx(speaking_time_s(text), abs=1.5)
    assert (stage.relative_speeds <= 1.001).all()
    assert stage.robot.angles == pytest.approx(BODY.posture_angles("Stand"), abs=1e-3)


def test_an_unknown_gesture_is_answered_with_those_there_are() -> None:
    result = Stage().do("say", text="Hi", gesture="jump")

    assert result.state == "failed"
    assert 'no gesture "jump"' in result.description and "greet" in result.description


def test_lights_fade_from_one_colour_to_another() -> None:
    stage = Stage()
    stage.do("leds", group="FaceLeds", colour="#000000")

    stage.ask("1", "leds", group="FaceLeds", colour="#ff8000", seconds=1.0)
    stage.pass_time(0.5)
    half = stage.robot.leds["LeftFaceLeds"]
    stage.finish()

    assert f"{half:06x}" == "804000"
    assert stage.robot.leds["RightFaceLeds"] == 0xFF8000
    assert stage.robot.leds["ChestLeds"] == body.OFF


def test_all_lights_are_every_light() -> None:
    stage = Stage()

    stage.do("leds", group="AllLeds", colour="#00ff00")

    assert set(stage.robot.leds.values()) == {0x00FF00}


@pytest.mark.parametrize("colour", ["red", "#12", "#gggggg", "#1234567", ""])
def test_text_that_is_no_colour_is_refused(colour: str) -> None:
    with pytest.raises(ActionFailed, match="Write one like #ff8000"):
        body.colour_number(colour)


def test_an_unknown_group_is_answered_with_those_there_are() -> None:
    assert "ChestLeds" in Stage().do("leds", group="Nose", colour="#ffffff").description
