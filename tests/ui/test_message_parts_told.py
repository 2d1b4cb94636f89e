"""Sentences within sentences, and several of them in one text, are translated too."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from nep_studio.ui.message_templates import MessageTemplates

GERMAN = {
    "{node} was killed": "{node} wurde abgebrochen",
    "{node} ended with an error: {reason}": "{node} endete mit einem Fehler: {reason}",
    "{outcome}; it is started again": "{outcome}; er wird wieder gestartet",
    "{path} cannot be read: {reason}.": "{path} lässt sich nicht lesen: {reason}.",
    "permission denied": "keine Erlaubnis",
    "Look into its log.": "Sieh in sein Protokoll.",
    'The simulated person knows no gesture "{name}".': "Die Geste „{name}“ kennt sie nicht.",
    "Choose one of: {gestures}.": "Wähle eine von: {gestures}.",
    "Is {robot} switched on? Its chest button should glow.": "Ist {robot} an? Der Knopf leuchtet.",
    "{robot} does not answer.": "{robot} antwortet nicht.",
    "virtual NAO, {family}": "virtueller NAO, {family}",
    "standing": "steht",
    "sits": "sitzt",
    "{name} {family}: it must stand before it can walk.": "{name} {family}: er muss stehen.",
    "{robot} could not {action}: {description}": "{robot} konnte nicht {action}: {description}",
    "Line {number} of {name}": "Zeile {number} von {name}",
    "{where} has {told} in column {at}.": "{where} hat {told} in Spalte {at}.",
    "nothing": "nichts",
}


def told(text: str, words: dict[str, str] = GERMAN) -> str:
    templates = MessageTemplates(words)

    def look_up(text: str) -> str:
        return words.get(text) or templates.translated(text, look_up) or text

    return look_up(text)


@pytest.mark.parametrize(
    ("english", "german"),
    [
        ("karate was killed", "karate wurde abgebrochen"),
        ("karate was killed.", "karate wurde abgebrochen."),
        (
            "karate was killed; it is started again",
            "karate wurde abgebrochen; er wird wieder gestartet",
        ),
        (
            "karate ended with an error: m.json cannot be read: Permission denied.",
            "karate endete mit einem Fehler: m.json lässt sich nicht lesen: keine Erlaubnis.",
        ),
        (
            "karate ended with an error: m.json cannot be read: permission denied; "
            "it is started again",
            "karate endete mit einem Fehler: m.json lässt sich nicht lesen: keine Erlaubnis; "
            "er wird wieder gestartet",
        ),
        (
            'The simulated person knows no gesture "wave". Choose one of: karate, hand_up.',
            "Die Geste „wave“ kennt sie nicht. Wähle eine von: karate, hand_up.",
        ),
        (
            "NAO does not answer.\n[ ] Is NAO switched on? Its chest button should glow.\n"
            "[ ] Look into its log.",
            "NAO antwortet nicht.\n[ ] Ist NAO an? Der Knopf leuchtet.\n"
            "[ ] Sieh in sein Protokoll.",
        ),
        ("virtual NAO, standing", "virtueller NAO, steht"),
        (
            "NAO could not walk: NAO sits: it must stand before it can walk.",
            "NAO konnte nicht walk: NAO sitzt: er muss stehen.",
        ),
        ("Line 4 of a.csv has nothing in column 2.", "Zeile 4 von a.csv hat nichts in Spalte 2."),
        ("karate was killed. Nobody wrote this.", "karate was killed. Nobody wrote this."),
    ],
)
def test_what_is_put_together_is_told_in_german(english: str, german: str) -> None:
    assert told(english) == german


def test_japanese_ends_with_its_own_full_stop() -> None:
    words = {"{node} was killed": "{node} が強制終了されました"}

    assert told("karate was killed.", words) == "karate が強制終了されました。"


@given(st.text("ab .?\n[]:;", max_size=200))
def test_any_text_is_taken(text: str) -> None:
    assert isinstance(told(text), str)


def test_a_text_of_very_many_sentences_is_left_as_it_is() -> None:
    text = "karate was killed. " * 90

    assert told(text) == text
