"""What happened, as data: texts with places, faults, and the errors that carry them."""

from __future__ import annotations

import msgspec
import pytest

from faults import Fault, FaultError, Text, told

GERMAN = {
    "{robot} sees {thing}.": "{robot} sieht {thing}.",
    "a ball": "einen Ball",
    "Look at {robot}.": "Sieh {robot} an.",
}


class NothingSeen(FaultError):
    """An error of this test."""

    title = "Nothing is seen"


def german(text: str, /, **values: object) -> str:
    words = GERMAN.get(text, text)
    return words.format_map(values) if values else words


def test_a_text_of_ours_in_a_place_is_translated_and_somebody_elses_words_are_not() -> None:
    text = Text("{robot} sees {thing}.", {"robot": "a ball", "thing": Text("a ball")})

    assert told(text, german) == "a ball sieht einen Ball."
    assert str(text) == "a ball sees a ball."


def test_several_in_one_place_stand_with_commas() -> None:
    text = Text("{robot} sees {thing}.", {"robot": "NAO", "thing": [Text("a ball"), "Anna"]})

    assert told(text, german) == "NAO sieht einen Ball, Anna."


@pytest.mark.parametrize("words", ["{", "{0}", "{x!r}", "a {b} c", "{{}}"])
def test_a_text_without_values_is_taken_as_it_is(words: str) -> None:
    assert str(Text(words)) == words


def test_an_error_has_the_code_of_its_class_or_a_more_exact_one() -> None:
    assert NothingSeen("There is nothing.").fault.code == "nothing_seen"
    assert NothingSeen("There is nothing.", code="dark").fault.code == "dark"


def test_the_steps_of_an_error_get_the_values_that_they_name() -> None:
    error = NothingSeen(
        "{robot} sees {thing}.",
        checklist=("Look at {robot}.", "Wait."),
        robot="NAO",
        thing=Text("a ball"),
    )

    assert str(error.sentence) == "NAO sees a ball."
    assert tuple(map(str, error.checklist)) == ("Look at NAO.", "Wait.")
    assert [told(step, german) for step in error.fault.checklist] == [
        "Sieh NAO an.",
        "Wait.",
    ]
    assert error.__notes__ == ["  [ ] Look at NAO.", "  [ ] Wait."]


def test_who_catches_an_error_may_add_advice() -> None:
    error = NothingSeen("There is nothing.", checklist=("Wait.",))

    error.advise("Look into {file}.", file="nao.log")

    assert tuple(map(str, error.checklist)) == ("Wait.", "Look into nao.log.")
    assert error.__notes__[-1] == "  [ ] Look into nao.log."


def test_a_fault_goes_over_the_wire_and_comes_back_as_an_error() -> None:
    error = NothingSeen("{n} of {all}", checklist=("Wait {n} s.",), n=2, all=Text("a ball"))

    wire = msgspec.json.encode(error.fault)
    again = NothingSeen.of(msgspec.json.decode(wire, type=Fault))

    assert again.fault == error.fault
    assert wire.startswith(b'{"code":"nothing_seen","sentence":{"text":"{n} of {all}","values"')
