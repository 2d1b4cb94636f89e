"""Transactions inside transactions: what fails inside is taken back, what is outside stays."""

from __future__ import annotations

import pytest
from block_building import B, build
from msgspec.structs import replace

from nep_studio.blocks.edits.content import AddNote, ChangeNote, SetField
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.program import Note


def test_what_fails_inside_a_step_is_taken_back_and_the_step_goes_on(language):
    editor = build(language, [B("event.started")])
    empty = to_bytes(editor.project)
    recorded = []
    editor.history.record(recorded.append)

    with editor.transaction("outer"):
        wait = editor.create("control.wait", editor.new_stack("behaviour", 300, 0))
        with pytest.raises(EditRefused), editor.transaction("inner"):
            editor.create("control.wait", editor.new_stack("behaviour", 600, 0))
            editor.apply(SetField(wait, "seconds", -1))

    assert [b.type for b in editor.project.blocks.values()] == ["event.started", "control.wait"]
    again = from_bytes(empty, "x", language)
    for edit in recorded[0]:
        edit.apply(again)
    assert to_bytes(again) == to_bytes(editor.project)
    editor.history.undo()
    assert to_bytes(editor.project) == empty


def test_steps_cannot_be_dropped_inside_a_step(language):
    editor = build(language, [B("event.started")])

    with editor.transaction("more"), pytest.raises(RuntimeError):
        editor.history.drop(0)

    assert editor.project.blocks


def test_typing_in_a_note_and_moving_it_are_two_steps(language):
    editor = build(language)
    note = Note("n1", "behaviour", 0.0, 0.0, 100.0, 50.0)
    editor.apply(AddNote(note))
    editor.history.seal()
    for text in ("h", "hi"):
        editor.apply(ChangeNote(replace(note, text=text)))
    editor.apply(ChangeNote(replace(note, text="hi", x=50.0)))

    editor.history.undo()

    assert editor.project.notes["n1"] == replace(note, text="hi")
    editor.history.undo()
    assert editor.project.notes["n1"] == note
