"""A kind of field is one object: where it is named, all that asks for kinds knows it."""

from __future__ import annotations

import ast
from dataclasses import replace

import pytest
from kinds_language import SENTENCES, kinds_language
from PySide6.QtTest import QTest

from faults import text_of
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.slots import KINDS, Kind, kind_of
from nep_studio.ui.canvas.fields.editors import EDITORS
from nep_studio.ui.canvas.fields.line_editor import LineEditor


def why_not_note(value: object):
    is_note = isinstance(value, str) and value in "cdefgab"
    return None if is_note else text_of("{value} is no note.", value=str(value))


@pytest.fixture
def note(monkeypatch) -> Kind:
    kind = Kind("note", "a note to sing", why_not=why_not_note, read=str.lower, hint="note")
    monkeypatch.setitem(KINDS, "note", kind)
    monkeypatch.setitem(SENTENCES, "kinds.note", ("sing {pitch:note} aloud", {"pitch": "c"}))
    return kind


def test_a_new_kind_is_drawn_read_checked_and_kept(note, controller_of) -> None:
    desk = controller_of("kinds.note")

    desk.click("pitch")
    is_line = isinstance(desk.widget, LineEditor)
    QTest.keyClicks(desk.widget, "A")
    kept = desk.value("pitch")
    QTest.keyClicks(desk.widget, "z")

    assert is_line
    assert kept == desk.value("pitch") == "a"
    assert desk.widget.reason.text == "az is no note."


def test_the_values_of_a_kind_are_called_as_its_table_says(monkeypatch) -> None:
    monkeypatch.setitem(KINDS, "day", Kind("day", "a day of the week", table="weekdays"))
    monkeypatch.setitem(SENTENCES, "kinds.day", ("wait until {day:day}", {"day": "monday"}))
    language = kinds_language()
    language = replace(language, choices={**language.choices, "weekdays": {"monday": "Montag"}})
    slot = language.definitions["kinds.day"].slots["day"]

    assert language.label_of(slot, "monday") == "Montag"
    assert language.choices_of(slot) == {"monday": "Montag"}


def test_every_editor_is_for_a_kind() -> None:
    assert EDITORS.keys() <= KINDS.keys()


def test_a_new_kind_goes_to_python_and_back(note) -> None:
    written = note.to_python("a")

    assert ast.unparse(written) == "'a'"
    assert note.from_python(ast.literal_eval(written)) == "a"
    assert note.from_python(3) is None


def test_a_kind_that_is_not_there_is_told_in_a_sentence() -> None:
    with pytest.raises(BlocksError, match="There is no kind of field called “smell”"):
        kind_of("smell")


def test_numbers_are_known_by_their_kind() -> None:
    numbers = {kind.name for kind in KINDS.values() if kind.is_number}

    assert numbers >= {"number", "angle", "slider", "duration"}
    assert all(kind.read("2,5") == 2.5 for kind in KINDS.values() if kind.is_number)
