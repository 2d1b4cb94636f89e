"""Edits of the notes on pages, and of the room that the comment of a block takes."""

from __future__ import annotations

from typing import ClassVar

import msgspec

from ..errors import EditRefused
from ..program import Note, Project
from .placing import require_block


class AddNote(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Put a note on a page."""

    label: ClassVar[str] = "add a note"
    note: Note

    def apply(self, project: Project) -> RemoveNote:
        """Add the note."""
        if self.note.id in project.notes:
            raise EditRefused("A note with this id is already there.")
        _require_page(project, self.note.page)
        project.notes[self.note.id] = _in_floats(self.note)
        project.id_seen(self.note.id)
        project.touch_note(self.note.id)
        return RemoveNote(self.note.id)


class RemoveNote(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Delete a note."""

    label: ClassVar[str] = "delete a note"
    note: str

    def apply(self, project: Project) -> AddNote:
        """Delete the note."""
        old = _require_note(project, self.note)
        del project.notes[self.note]
        project.touch_note(self.note)
        return AddNote(old)


class ChangeNote(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Move a note, make it larger or smaller, write in it: all that it is is said again."""

    label: ClassVar[str] = "change a note"
    note: Note

    def apply(self, project: Project) -> ChangeNote:
        """Change the note."""
        old = _require_note(project, self.note.id)
        _require_page(project, self.note.page)
        project.notes[self.note.id] = _in_floats(self.note)
        project.touch_note(self.note.id)
        return ChangeNote(old)


class SetCommentSize(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Make the comment of a block larger or smaller; 0 is as large as it needs to be."""

    label: ClassVar[str] = "change the size of a comment"
    block: str
    width: float
    height: float

    def apply(self, project: Project) -> SetCommentSize:
        """Set the size."""
        block = require_block(project, self.block)
        old = SetCommentSize(self.block, block.comment_width, block.comment_height)
        block.comment_width, block.comment_height = float(self.width), float(self.height)
        project.touch(project.stack_of(self.block).id, self.block)
        return old


def _in_floats(note: Note) -> Note:
    """A note as it is read from a file: places and sizes are no whole numbers there."""
    x, y = float(note.x), float(note.y)
    return Note(note.id, note.page, x, y, float(note.width), float(note.height), note.text)


def _require_note(project: Project, note_id: str) -> Note:
    note = project.notes.get(note_id)
    if note is None:
        raise EditRefused("This note is not there any more.")
    return note


def _require_page(project: Project, page: str) -> None:
    if page not in project.pages:
        raise EditRefused("This page is not there any more.")
