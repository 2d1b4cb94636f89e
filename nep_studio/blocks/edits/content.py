"""Edits of what a block says: its fields, flags, comment, and the groups of its sentence."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import msgspec

from faults import Text
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.file_text import is_deeper
from nep_studio.blocks.program import Block, Note, Parameter, Parent, Procedure, Project
from nep_studio.blocks.slots import FieldValue

from .edit import Edit
from .placing import require_block


class SetField(Edit, frozen=True):
    """Set the value of a field; None takes it away, so that the default holds."""

    label: ClassVar[str] = "change a field"
    block: str
    slot: str
    value: FieldValue | None

    def apply(self, project: Project) -> SetField:
        """Set the value."""
        fields = require_block(project, self.block).fields
        old = fields.pop(self.slot, None)
        if self.value is not None:
            fields[self.slot] = dict(self.value) if isinstance(self.value, dict) else self.value
        project.touch(project.stack_of(self.block).id, self.block)
        return SetField(self.block, self.slot, old)


class SetFlag(Edit, frozen=True):
    """Disable or collapse a block, or the opposite."""

    label: ClassVar[str] = "disable or collapse a block"
    block: str
    flag: Literal["disabled", "collapsed"]
    on: bool

    def apply(self, project: Project) -> SetFlag:
        """Set the flag."""
        block = require_block(project, self.block)
        old: bool = getattr(block, self.flag)
        setattr(block, self.flag, self.on)
        project.touch(project.stack_of(self.block).id, self.block)
        return SetFlag(self.block, self.flag, old)


class SetComment(Edit, frozen=True):
    """Write the comment of a block; an empty one is none."""

    label: ClassVar[str] = "write a comment"
    block: str
    comment: str

    def apply(self, project: Project) -> SetComment:
        """Write the comment."""
        block = require_block(project, self.block)
        old, block.comment = block.comment, self.comment
        project.touch(project.stack_of(self.block).id, self.block)
        return SetComment(self.block, old)


class AddGroup(Edit, frozen=True):
    """Add a group to a sentence (an else-if), as number ``index`` from 1; later ones move up.

    ``slots`` are the names of the group's slots; ``fields`` the values of its fields by name.
    """

    label: ClassVar[str] = "add a part"
    block: str
    group: str
    index: int
    slots: tuple[str, ...]
    fields: dict[str, FieldValue]

    def apply(self, project: Project) -> RemoveGroup:
        """Add the group."""
        block = require_block(project, self.block)
        count = block.groups.get(self.group, -1)
        if not 1 <= self.index <= count + 1:
            raise EditRefused("There is no such place in this block.")
        for number in range(count, self.index - 1, -1):
            for slot in self.slots:
                _renumber(project, block, f"{slot}.{number}", f"{slot}.{number + 1}")
        for slot, value in self.fields.items():
            block.fields[f"{slot}.{self.index}"] = value
        block.groups[self.group] = count + 1
        project.touch(project.stack_of(self.block).id, self.block)
        return RemoveGroup(self.block, self.group, self.index, self.slots)


class RemoveGroup(Edit, frozen=True):
    """Take a group out of a sentence; no blocks may be in it. Later groups move down."""

    label: ClassVar[str] = "remove a part"
    block: str
    group: str
    index: int
    slots: tuple[str, ...]

    def apply(self, project: Project) -> AddGroup:
        """Take the group out."""
        block = require_block(project, self.block)
        count = block.groups.get(self.group, 0)
        if not 1 <= self.index <= count:
            raise EditRefused("There is no such part in this block.")
        keys = {slot: f"{slot}.{self.index}" for slot in self.slots}
        if any(key in block.inputs or key in block.bodies for key in keys.values()):
            raise EditRefused("There are blocks in this part: take them out first.")
        fields = {s: block.fields.pop(key) for s, key in keys.items() if key in block.fields}
        for number in range(self.index + 1, count + 1):
            for slot in self.slots:
                _renumber(project, block, f"{slot}.{number}", f"{slot}.{number - 1}")
        block.groups[self.group] = count - 1
        project.touch(project.stack_of(self.block).id, self.block)
        return AddGroup(self.block, self.group, self.index, self.slots, fields)


def _renumber(project: Project, block: Block, old: str, new: str) -> None:
    """Move what is in one slot of a block to another, which is empty."""
    if old in block.fields:
        block.fields[new] = block.fields.pop(old)
    if old in block.inputs:
        block.inputs[new] = block.inputs.pop(old)
        project.parents[block.inputs[new]] = Parent(block.id, new)
    if old in block.bodies:
        block.bodies[new] = block.bodies.pop(old)
        for child in block.bodies[new]:
            project.parents[child] = Parent(block.id, new)


# Edits of the notes on pages, and of the room that the comment of a block takes.


class AddNote(Edit, frozen=True):
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
        project.changes.notes.add(self.note.id)
        return RemoveNote(self.note.id)


class RemoveNote(Edit, frozen=True):
    """Delete a note."""

    label: ClassVar[str] = "delete a note"
    note: str

    def apply(self, project: Project) -> AddNote:
        """Delete the note."""
        old = _require_note(project, self.note)
        del project.notes[self.note]
        project.changes.notes.add(self.note)
        return AddNote(old)


class ChangeNote(Edit, frozen=True):
    """Move a note, make it larger or smaller, write in it: all that it is is said again."""

    label: ClassVar[str] = "change a note"
    note: Note

    def apply(self, project: Project) -> ChangeNote:
        """Change the note."""
        old = _require_note(project, self.note.id)
        _require_page(project, self.note.page)
        project.notes[self.note.id] = _in_floats(self.note)
        project.changes.notes.add(self.note.id)
        return ChangeNote(old)


class SetCommentSize(Edit, frozen=True):
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


# An edit of what a project keeps besides its program, such as the cues of its operator.

FILE_KEYS = frozenset(
    ("format", "version", "name", "pages", "blocks", "variables", "procedures", "notes")
) | {"page_order"}
"""The keys of the program itself, which nothing else may be kept under."""

LONGEST_KEY = 64
LARGEST_BYTES = 200_000
ANIMATION = "animation_"
"""What the keys of the project's animations begin with: a dance has many numbers."""
GESTURE = "gesture_"
RECORDING = "recording_"
RECOGNISER = "recogniser"
"""The keys of what the project knows of gestures: gestures, recordings, and what was learned."""
_LARGEST_OF = {
    ANIMATION: 1_000_000,
    GESTURE: 1_000_000,
    RECORDING: 12_000_000,
    RECOGNISER: 8_000_000,
}
DEEPEST = 20


class SetExtra(Edit, frozen=True):
    """Keep a JSON value under a key of the project's file; None takes it away.

    Programs that do not know the key save it as it was.
    """

    label: ClassVar[str] = "change what the project keeps"
    key: str
    value: Any = None

    def apply(self, project: Project) -> SetExtra:
        """Keep the value."""
        old = SetExtra(self.key, project.extra.get(self.key))
        if self.value is None:
            project.extra.pop(self.key, None)
        else:
            project.extra[self.key] = self.value
        project.extra_revision += 1
        project.changes.whole = True
        project.changes.kept.add(self.key)
        return old


def why_not_extra(key: str, value: object) -> Text | None:
    """Why a value cannot be kept under a key, or None when it can."""
    if key in FILE_KEYS or not key.isidentifier() or len(key) > LONGEST_KEY:
        return Text("Nothing can be kept under this name.")
    try:
        size = len(msgspec.json.encode(value))
    except (TypeError, ValueError, RecursionError, UnicodeEncodeError):
        return Text("This cannot be written into the project's file.")
    sizes = (most for prefix, most in _LARGEST_OF.items() if key.startswith(prefix))
    if size > next(sizes, LARGEST_BYTES) or is_deeper(value, DEEPEST):
        return Text("This is too much to be kept in the project's file.")
    return None


# Edits of the list of own blocks; editor.py sees to it that the blocks that call them follow.


class AddProcedure(Edit, frozen=True):
    """Make an own block, at a position of the list of own blocks."""

    label: ClassVar[str] = "make an own block"
    procedure: Procedure
    position: int

    def apply(self, project: Project) -> RemoveProcedure:
        """Make the own block."""
        if self.procedure.id in project.procedures:
            raise EditRefused("An own block with this id is already there.")
        procedures = list(project.procedures.values())
        if not 0 <= self.position <= len(procedures):
            raise EditRefused("There is no such position in the list of own blocks.")
        procedures.insert(self.position, self.procedure)
        project.procedures.clear()
        project.procedures.update({procedure.id: procedure for procedure in procedures})
        see_ids(project, self.procedure)
        project.touch_procedures()
        return RemoveProcedure(self.procedure.id)


class RemoveProcedure(Edit, frozen=True):
    """Delete an own block from the list."""

    label: ClassVar[str] = "delete an own block"
    procedure: str

    def apply(self, project: Project) -> AddProcedure:
        """Delete the own block."""
        old = _require_procedure(project, self.procedure)
        position = list(project.procedures).index(self.procedure)
        del project.procedures[self.procedure]
        project.touch_procedures()
        return AddProcedure(old, position)


class ChangeProcedure(Edit, frozen=True):
    """Change the sentence of an own block, and whether it gives a value."""

    label: ClassVar[str] = "change an own block"
    procedure: Procedure

    def apply(self, project: Project) -> ChangeProcedure:
        """Change the own block."""
        old = _require_procedure(project, self.procedure.id)
        project.procedures[old.id] = self.procedure
        see_ids(project, self.procedure)
        project.touch_procedures()
        return ChangeProcedure(old)


def see_ids(project: Project, procedure: Procedure) -> None:
    """Remember the ids in an own block, so that none is given again."""
    project.id_seen(procedure.id)
    for part in procedure.parts:
        if isinstance(part, Parameter):
            project.id_seen(part.id)


def _require_procedure(project: Project, procedure_id: str) -> Procedure:
    procedure = project.procedures.get(procedure_id)
    if procedure is None:
        raise EditRefused("This own block is not there any more.")
    return procedure
