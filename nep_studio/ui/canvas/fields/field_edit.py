"""One field while it is edited: what it held before, what it holds now, what does not fit."""

from __future__ import annotations

from typing import Protocol

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import ChangeProcedure, SetField
from nep_studio.blocks.procedures import procedure_of
from nep_studio.blocks.program import Parameter, Procedure
from nep_studio.blocks.sentence import Slot
from nep_studio.blocks.values import FieldValue, why_not_name


class Editing(Protocol):
    """What an editor of a field needs: to set it, to put it back, to end."""

    block: str
    key: str
    slot: Slot

    @property
    def value(self) -> FieldValue | None:
        """What the field holds now."""

    def set(self, value: FieldValue) -> str:
        """Hold another value; gives why it does not fit, and then nothing is changed."""

    def restore(self) -> None:
        """Make it as it was before the editing."""

    def end(self) -> None:
        """The editing is over; what follows is another step of undo."""


class FieldEdit:
    """Sets a field live; all of one editing is one step of undo."""

    def __init__(self, editor: Editor, block: str, key: str, slot: Slot) -> None:
        self.block, self.key, self.slot = block, key, slot
        self._editor = editor
        editor.history.seal()
        self._steps_before = editor.history.steps

    @property
    def value(self) -> FieldValue | None:
        """What the field holds, or its default; None when the block is gone."""
        block = self._editor.project.blocks.get(self.block)
        if block is None:
            return None
        return self._editor.language.definitions[block.type].value(block, self.key)

    def why_not(self, value: FieldValue) -> str:
        """Why the field cannot hold a value, or nothing."""
        return self._editor.why_not(SetField(self.block, self.key, value)) or ""

    def set(self, value: FieldValue) -> str:
        """Hold another value; gives why it does not fit, and then nothing is changed."""
        if self.block not in self._editor.project.blocks:
            return "This block is not there any more."
        now = self.value
        if now == value and type(now) is type(value):
            return ""
        reason = self.why_not(value)
        if not reason:
            self._editor.apply(SetField(self.block, self.key, value))
        return reason

    def restore(self) -> None:
        """Take back what this editing changed, as if it had never been."""
        self._editor.history.drop(self._steps_before)

    def end(self) -> None:
        """What follows is another step of undo."""
        self._editor.history.seal()


class ParameterEdit:
    """Gives a parameter of an own block another name, when the editing ends."""

    def __init__(self, editor: Editor, block: str, key: str, slot: Slot) -> None:
        self.block, self.key, self.slot = block, key, slot
        self._editor = editor
        procedure_id = procedure_of(editor.project.blocks[block].type)
        self._procedure = editor.project.procedures[procedure_id]
        self._name = slot.label

    @property
    def value(self) -> FieldValue | None:
        """The name as it is typed so far."""
        return self._name

    def set(self, value: FieldValue) -> str:
        """Take another name; gives why it cannot be one."""
        reason = why_not_name(value)
        if reason is None:
            reason = self._editor.why_not(ChangeProcedure(self._renamed(str(value))))
        if reason is None:
            self._name = str(value)
        return reason or ""

    def restore(self) -> None:
        """Keep the name that it has."""
        self._name = self.slot.label

    def end(self) -> None:
        """Rename the parameter in the header, in the calls, and in the blocks that give it."""
        if self._name != self.slot.label:
            changed = self._renamed(self._name)
            self._editor.change_procedure(
                changed.id, changed.parts, gives_value=changed.gives_value
            )

    def _renamed(self, name: str) -> Procedure:
        parts = tuple(
            Parameter(part.id, name, part.kind)
            if isinstance(part, Parameter) and part.id == self.key
            else part
            for part in self._procedure.parts
        )
        return Procedure(self._procedure.id, parts, self._procedure.gives_value)
