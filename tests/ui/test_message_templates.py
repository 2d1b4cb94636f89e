"""Sentences whose values are filled in already are told in the language of the person."""

from __future__ import annotations

import string
import tomllib
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st
from message_sources import templates

from nep_studio import paths
from nep_studio.ui import words
from nep_studio.ui.words import available_languages, tr, use_language


@pytest.fixture(autouse=True)
def english_again() -> Iterator[None]:
    yield
    use_language("en")


@pytest.mark.parametrize(
    ("english", "spanish"),
    [
        (
            "No node of the Nodes page recognises the gesture “wave”.",
            "Ningún nodo de la página Nodos reconoce el gesto “wave”.",
        ),
        (
            "This place needs a number, and “my text” gives a text.",
            "Este hueco necesita un número, y “my text” da un texto.",
        ),
        ("“esperar x”: a question is missing.", "“esperar x”: falta una pregunta."),
        ("This block belongs on the page Nodes.", "Este bloque va en la página Nodos."),
        (
            "a.nep cannot be read at line 3: this is not how a project is written.",
            "a.nep no se puede leer en la línea 3: un proyecto no se escribe así.",
        ),
        (
            "a.nep cannot be used at line 3, block b2: at fields: a text belongs here, not a list.",
            "a.nep no se puede usar en la línea 3, bloque b2: en fields: aquí va un texto,"
            " no una lista.",
        ),
        (
            "The node “G” cannot start. There is no file m.json (model).",
            "El nodo “G” no puede empezar. No hay ningún archivo m.json (model).",
        ),
        ("This own block is used in 3 places. Take those blocks out first.", None),
    ],
)
def test_a_filled_sentence_is_told_in_spanish(english: str, spanish: str | None) -> None:
    use_language("es")

    told = tr(english)

    assert told == spanish if spanish else "3 lugares" in told


@pytest.mark.parametrize("name", ["Stop", "Save", "a number", "Nodes", "{x}", "a “b” c", "\n"])
def test_what_people_wrote_in_quotes_is_never_translated(name: str) -> None:
    use_language("es")

    assert tr(f"There is a variable “{name}” already.") == f"Ya hay una variable “{name}”."


def test_every_sentence_is_recognised_in_every_language() -> None:
    for code in available_languages().keys() - {"en"}:
        use_language(code)
        filled = {w: w.format_map(_Values()) for w in templates() - _same(code)}

        assert [w for w, text in filled.items() if tr(text) == text and "“{" not in w] == []


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

    told = tr("No node of the Nodes page recognises the gesture “wave”.")

    assert "“wave”" in told
    assert "gesture" not in told


@given(st.text(string.printable + "“”{}"))
def test_any_text_can_be_looked_up(text: str) -> None:
    use_language("de")

    assert isinstance(tr(text), str)


def test_many_sentences_are_found_each_with_its_own_words() -> None:
    use_language("it")
    texts = [f"“block {n}” is under no “when” block and will not run." for n in range(2000)]

    told = [tr(text) for text in texts]

    assert told[7] == "“block 7” non è sotto nessun blocco “quando” e non verrà eseguito."


class _Values(dict):
    def __missing__(self, name: str) -> str:
        return "7"
