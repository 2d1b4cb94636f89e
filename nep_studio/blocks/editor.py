"""Edits a project as the block language allows: refuses what does not fit, and says why."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager

from .editing_rules import why_not
from .edits import (
    AddProcedure,
    AddVariable,
    ChangeProcedure,
    CreateBlocks,
    DeleteBlocks,
    Edit,
    MoveBlocks,
    RemoveNote,
    RemovePage,
    RemoveProcedure,
    SetField,
)
from .errors import EditRefused
from .history import History
from .language import Language
from .own_block_changes import Misfit, misfits, why_not_delete_procedure
from .places import NewStack, Place
from .procedures import DEFINE, header_of
from .program import Changes, Parameter, Procedure, Project

_BESIDE = 40.0
"""How far from its old stack a block is put that has lost its place, in canvas units."""


class Editor:
    """A project with its language and its history."""

    def __init__(self, project: Project, language: Language) -> None:
        self.project = project
        self.history = History(project)
        self._language = language.of(project)
        self.history.listen(self._on_changes)

    @property
    def language(self) -> Language:
        """The language with the project's own blocks; always the same object, always up to date."""
        return self._language.of(self.project)

    def use_language(self, language: Language) -> None:
        """Go on with the same blocks in other words."""
        self._language = language.of(self.project)

    def transaction(self, label: str) -> AbstractContextManager[object]:
        """Everything applied inside is one step of undo."""
        return self.history.transaction(label)

    def why_not(self, edit: Edit) -> str | None:
        """Why an edit does not fit the language, or None when it does."""
        return why_not(edit, self.project, self.language)

    def apply(self, edit: Edit, label: str = "") -> None:
        """Apply an edit, or raise EditRefused with the reason.

        Choices that depend on a field follow it in the same step.
        """
        reason = self.why_not(edit)
        if reason is not None:
            raise EditRefused(reason)
        if not isinstance(edit, SetField) or not (followers := self._followers(edit)):
            self.history.apply(edit, label)
            return
        with self.history.transaction(label or edit.label):
            self.history.apply(edit)
            for slot in followers:
                self._follow(edit.block, slot)

    def create(self, block_type: str, place: Place) -> str:
        """Make a block with its default values; gives its id."""
        definition = self.language.definitions[block_type]
        block = definition.new_block(self.project.new_id("b"))
        self.apply(CreateBlocks((block.id,), (block,), place))
        return block.id

    def add_variable(self, name: str) -> str:
        """Make a variable; gives its id."""
        variable_id = self.project.new_id("v")
        self.apply(AddVariable(variable_id, name, len(self.project.variables)))
        return variable_id

    def new_stack(self, page: str, x: float, y: float) -> NewStack:
        """A place for a new stack, the last of its page."""
        position = len(self.project.pages[page])
        return NewStack(page, self.project.new_id("s"), x, y, position)

    def new_parameter(self, name: str, kind: str) -> Parameter:
        """A parameter for an own block; it is not in the project yet."""
        return Parameter(self.project.new_id("a"), name, kind)

    def add_procedure(
        self,
        parts: Sequence[str | Parameter],
        *,
        gives_value: bool = False,
        place: NewStack | None = None,
    ) -> str:
        """Make an own block, and its header at a place if one is given; gives its id."""
        procedure = Procedure(self.project.new_id("p"), tuple(parts), gives_value)
        with self.transaction(AddProcedure.label):
            self.apply(AddProcedure(procedure, len(self.project.procedures)))
            if place is not None:
                self.create(DEFINE + procedure.id, place)
        return procedure.id

    def change_procedure(
        self, procedure_id: str, parts: Sequence[str | Parameter], *, gives_value: bool
    ) -> None:
        """Change the sentence of an own block; all that use it follow, in one step.

        What was in a parameter that goes is put beside, as a stack of its own.
        """
        procedure = Procedure(procedure_id, tuple(parts), gives_value)
        with self.transaction(ChangeProcedure.label):
            for number, misfit in enumerate(list(misfits(procedure, self.project, self.language))):
                self._put_right(misfit, number)
            self.apply(ChangeProcedure(procedure))

    def delete_procedure(self, procedure_id: str) -> None:
        """Delete an own block with the stack that defines it; refused while it is used."""
        reason = why_not_delete_procedure(self.project, procedure_id)
        if reason is not None:
            raise EditRefused(reason)
        with self.transaction(RemoveProcedure.label):
            while header := header_of(self.project, procedure_id):
                self.apply(DeleteBlocks(header, len(self.project.stack_of(header).body)))
            self.apply(RemoveProcedure(procedure_id))

    def delete_page(self, page: str) -> None:
        """Delete an added page with all that is on it, in one step."""
        with self.transaction(RemovePage.label):
            for stack in list(self.project.pages.get(page, ())):
                self.apply(DeleteBlocks(stack.body[0], len(stack.body)))
            for note in [n.id for n in self.project.notes.values() if n.page == page]:
                self.apply(RemoveNote(note))
            self.apply(RemovePage(page))

    def _on_changes(self, changes: Changes) -> None:
        """Bring the language up to date before anybody else is told; see Language.of."""
        if changes.whole:
            self._language.of(self.project)

    def _followers(self, edit: SetField) -> list[str]:
        """The keys of the choices that depend on a field."""
        block = self.project.blocks[edit.block]
        definition = self.language.definitions.get(block.type)
        if definition is None:
            return []
        name, _, number = edit.slot.partition(".")
        return [
            key
            for key, slot in definition.keys(block.groups)
            if slot.master == name and (not number or key.endswith(f".{number}"))
        ]

    def _follow(self, block_id: str, key: str) -> None:
        """Choose again where the choice is not among those that are offered now."""
        block = self.project.blocks[block_id]
        definition = self.language.definitions[block.type]
        slot = definition.slot(key, block.groups)
        assert slot is not None
        offered = self.language.choices_of(slot, block, key)
        if not offered or definition.value(block, key) in offered:
            return
        default = definition.defaults.get(slot.name)
        value = default if default in offered else next(iter(offered))
        self.apply(SetField(block_id, key, value))

    def _put_right(self, misfit: Misfit, number: int) -> None:
        if misfit.field:
            self.apply(SetField(misfit.block, misfit.field, None))
            return
        stack = self.project.stack_of(misfit.block)
        page, shift = self.project.page_of(stack.id), _BESIDE * (number + 1)
        place = self.new_stack(page, stack.x + shift, stack.y + shift)
        self.apply(MoveBlocks(misfit.block, 1, place))
