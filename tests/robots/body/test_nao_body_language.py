"""Gestures that go with the words of a text, and what speaking says about the voice."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from nao_stage import ANIMATIONS, NAO, Stage

from robots.body.animations import NO_GESTURE
from robots.body.speech import load_gesture_words, spoken_parts
from robots.errors import FilesUnusable

WORDS = load_gesture_words(NAO)


def gestures(text: str, mode: str = "contextual") -> list[str]:
    return [part.gesture for part in spoken_parts(text, mode, ANIMATIONS, WORDS)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Hello, my friends and neighbours!", "me"),
        ("Hello everyone in this room", "greet"),
        ("Are we going home now?", "question"),
        ("Goodbye and sleep well tonight", "goodbye"),
        ("The weather is mild today", "explain"),
        ("Bonjour tout le monde entier", "greet"),
    ],
)
def test_the_last_word_that_has_a_gesture_chooses_it(text: str, expected: str) -> None:
    assert gestures(text) == [expected]


def test_each_sentence_has_a_gesture_of_its_own() -> None:
    text = "Hello everybody in this big room. The sun shines on the hills. What shall we do now?"

    assert len(gestures(text)) == 3
    assert gestures(text)[1:] == ["explain", "question"]


def test_every_gesture_with_words_exists() -> None:
    assert {WORDS.otherwise, *WORDS.words} <= set(ANIMATIONS.names("gesture"))


def test_gestures_by_chance_are_the_same_for_the_same_text() -> None:
    text = "One sentence that is long enough. Another sentence that is long enough."

    assert gestures(text, "random") == gestures(text, "random")
    assert set(gestures(text, "random")) <= set(ANIMATIONS.names("gesture"))


@given(st.text(max_size=300))
def test_the_parts_of_a_text_are_the_text(text: str) -> None:
    parts = spoken_parts(text, "contextual", ANIMATIONS, WORDS)

    assert "".join(part.text for part in parts).strip() == text.strip() or not parts


def test_arms_move_while_it_speaks_with_its_body() -> None:
    stage = Stage()
    before = stage.robot.angles.copy()
    stage.ask("1", "say", text="Hello! It is nice that you are here today.", gesture="contextual")

    stage.pass_time(1.0)
    during = stage.robot.angles.copy()
    stage.finish()

    assert abs(during - before).max() > 0.2
    assert stage.told[-1] == "1 done"
    assert stage.robot.angles == pytest.approx(before, abs=1e-2)


def test_without_a_gesture_nothing_moves() -> None:
    assert gestures("") == []
    stage = Stage()
    before = stage.robot.angles.copy()

    stage.do("say", text="I stand still.", gesture=NO_GESTURE)

    assert stage.robot.angles == pytest.approx(before)


def test_the_voice_is_told_with_speed_pitch_and_language() -> None:
    stage = Stage()
    stage.ask("1", "say", text="Bonjour", speed=80, pitch=120, language="fr")
    stage.pass_time(0.1)

    state = stage.driver.state()

    assert state is not None and state.saying == "Bonjour"
    assert state.settings["voice_speed"] == 80 and state.settings["voice_pitch"] == 120
    assert state.settings["voice_language"] == "fr" and state.settings["language"] == "en"


def test_a_text_is_told_in_the_language_of_the_program_unless_it_has_its_own() -> None:
    for args, spoken in (({}, "de"), ({"language": "fr"}, "fr")):
        stage = Stage()
        stage.ask("1", "say", text="Hallo", usual_language="de", **args)
        stage.pass_time(0.1)

        state = stage.driver.state()

        assert state is not None and state.settings["voice_language"] == spoken
        assert state.settings["language"] == "en"


def test_a_robot_without_words_for_gestures_has_none(tmp_path: Path) -> None:
    assert load_gesture_words(tmp_path).words == {}


def test_a_wrong_file_is_told_by_its_name(tmp_path: Path) -> None:
    (tmp_path / "gesture_words.toml").write_text("words = 3")

    with pytest.raises(FilesUnusable, match=r"gesture_words\.toml"):
        load_gesture_words(tmp_path)
