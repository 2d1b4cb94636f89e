"""What is told as a template and values is told in the language of the person."""

from __future__ import annotations

import string
import tomllib
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st
from message_sources import templates

from faults import Text, filled, told
from nep_studio import paths
from nep_studio.ui import words
from nep_studio.ui.words import available_languages, tr, use_language

NO_GESTURE = "Nothing recognises the gesture “{gesture}” yet."


@pytest.fixture(autouse=True)
def english_again() -> Iterator[None]:
    yield
    use_language("en")


@pytest.mark.parametrize(
    ("english", "spanish"),
    [
        (
            Text(NO_GESTURE, {"gesture": "wave"}),
            "Nada reconoce todavía el gesto “wave”.",
        ),
        (
            Text(
                "This place needs {noun}, and “{block_name}” gives {result}.",
                {"noun": Text("a number"), "block_name": "my text", "result": Text("a text")},
            ),
            "Este hueco necesita un número, y “my text” da un texto.",
        ),
        (Text("This block belongs on the page {page}.", {"page": Text("Nodes")}), None),
        (
            Text(
                "{name}{place} cannot be read: {reason}",
                {
                    "name": "a.nep",
                    "place": Text(" at line {line}", {"line": 3}),
                    "reason": Text("this is not how a project is written."),
                },
            ),
            None,
        ),
    ],
)
def test_a_text_is_told_in_spanish(english: Text, spanish: str | None) -> None:
    use_language("es")

    said = tr(english)

    assert said == spanish if spanish else said != str(english)


@pytest.mark.parametrize("name", ["Stop", "Save", "a number", "Nodes", "{x}", "a “b” c", "\n"])
def test_what_people_wrote_is_never_translated(name: str) -> None:
    use_language("es")

    said = tr(Text("There is a variable “{name}” already.", {"name": name}))

    assert said == f"Ya hay una variable “{name}”."


def test_a_sentence_that_has_its_values_already_is_left_as_it_is() -> None:
    """Nobody reads a sentence to find out what it says."""
    use_language("es")
    filled = str(Text(NO_GESTURE, {"gesture": "wave"}))

    assert tr(filled) == filled


def test_every_sentence_is_told_in_every_language() -> None:
    for code in available_languages().keys() - {"en"}:
        use_language(code)

        assert [one for one in templates() - _same(code) if tr(one) == one] == []


def _same(code: str) -> set[str]:
    """Words such as NAO, which are the same in a language as in English."""
    path = paths.resources() / "translations" / f"{code}.toml"
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    told = {**table["messages"], **table["window"]}
    return {words for words in told if words == told[words]}


def test_what_no_check_says_stays_as_it_is() -> None:
    use_language("fr")

    assert tr("A text that nobody wrote: 3 of 4.") == "A text that nobody wrote: 3 of 4."


def test_the_made_up_language_keeps_what_is_filled_in() -> None:
    use_language(words.PSEUDO)

    said = tr(Text(NO_GESTURE, {"gesture": "wave"}))

    assert "“wave”" in said
    assert "gesture" not in said


@given(st.text(string.printable + "“”{}"))
def test_any_text_can_be_looked_up(text: str) -> None:
    use_language("de")

    assert isinstance(tr(text), str)
    assert isinstance(tr(Text(text, {"x": text})), str)


GERMAN = {
    "{node} was killed": "{node} wurde abgebrochen",
    "{node} ended with an error: {reason}": "{node} endete mit einem Fehler: {reason}",
    "{outcome}.": "{outcome}.",
    "{outcome}; it is started again": "{outcome}; er wird wieder gestartet",
    "{path} cannot be read: {reason}.": "{path} lässt sich nicht lesen: {reason}.",
    "permission denied": "keine Erlaubnis",
}
JAPANESE = {
    "{node} ended with an error: {reason}": "{node} がエラーで終わりました: {reason}",
    "{outcome}.": "{outcome}。",
    "{path} cannot be read: {reason}.": "{path} を読めません: {reason}。",
    "permission denied": "許可がありません",
}


def in_words_of(table: dict[str, str], text: Text) -> str:
    def look_up(words: Text | str, /, **values: object) -> str:
        assert isinstance(words, str)
        return filled(table.get(words, words), values, look_up)

    return told(text, look_up)


KILLED = Text("{node} was killed", {"node": "karate"})
FAILED = Text(
    "{node} ended with an error: {reason}",
    {
        "node": "karate",
        "reason": Text(
            "{path} cannot be read: {reason}.",
            {"path": "m.json", "reason": Text("permission denied")},
        ),
    },
)


@pytest.mark.parametrize(
    ("english", "german"),
    [
        (KILLED, "karate wurde abgebrochen"),
        (Text("{outcome}.", {"outcome": KILLED}), "karate wurde abgebrochen."),
        (
            Text("{outcome}; it is started again", {"outcome": KILLED}),
            "karate wurde abgebrochen; er wird wieder gestartet",
        ),
        (
            Text("{outcome}.", {"outcome": FAILED}),
            "karate endete mit einem Fehler: m.json lässt sich nicht lesen: keine Erlaubnis.",
        ),
        (
            Text("{outcome}; it is started again", {"outcome": FAILED}),
            "karate endete mit einem Fehler: m.json lässt sich nicht lesen: keine Erlaubnis; "
            "er wird wieder gestartet",
        ),
    ],
)
def test_a_sentence_within_another_has_one_full_stop(english: Text, german: str) -> None:
    assert in_words_of(GERMAN, english) == german


def test_japanese_ends_with_its_own_full_stop() -> None:
    said = in_words_of(JAPANESE, Text("{outcome}.", {"outcome": FAILED}))

    assert said == "karate がエラーで終わりました: m.json を読めません: 許可がありません。"
