"""Edits of what a block says: its fields, flags, comment, and the groups of its sentence."""

from __future__ import annotations

from typing import ClassVar, Literal

import msgspec

from ..errors import EditRefused
from ..program import Block, Parent, Project
from ..values import FieldValue
from .placing import require_block


class SetField(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
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


class SetFlag(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
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


class SetComment(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
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


class AddGroup(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
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


class RemoveGroup(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
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
