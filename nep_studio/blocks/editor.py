"""Edits a project as the block language allows: refuses what does not fit, and says why."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field

import msgspec

from faults import Text, Words

from .edit_rules import Misfit, misfits, why_not, why_not_delete_procedure
from .edits import Edit
from .edits.content import (
    AddProcedure,
    ChangeNote,
    ChangeProcedure,
    RemoveNote,
    RemoveProcedure,
    SetComment,
    SetField,
)
from .edits.placing import CreateBlocks, DeleteBlocks, MoveBlocks
from .edits.project import AddVariable, MoveStack, RemovePage, RenameVariable, SetScope
from .errors import EditRefused
from .generate.renaming import NO_ROBOTS, names_followed
from .language import Language
from .places import NewStack, Place
from .procedures import DEFINE, changed, header_of
from .program import Changes, Note, Parameter, Procedure, Project

# Undo and redo: transactions of edits, each one step; typing in one field is one step too.

Listener = Callable[[Changes], None]
Recorder = Callable[[tuple[Edit, ...]], None]
Finisher = Callable[[], None]


@dataclass(slots=True)
class Step:
    """One step that a person can take back: its label for the menu, and the edits to do so."""

    label: Words
    edits: list[Edit] = field(default_factory=list)
    number: int = 0
    """The same for a step and for its opposite, and for no other step."""


class History:
    """Applies edits to a project and remembers how to take them back."""

    def __init__(self, project: Project) -> None:
        self._project = project
        project.changes = Changes()  # of what was done before nobody has to be told
        self._undo: list[Step] = []
        self._redo: list[Step] = []
        self._open: Step | None = None
        self._may_merge = False
        self._last_number = 0
        self._listeners: dict[Listener, bool] = {}
        """Each with whether it only wants to hear of the whole."""
        self._applied: list[Edit] = []
        self._recorders: list[Recorder] = []
        self._finishers: list[Finisher] = []
        self.is_own = False
        """Whether what is made now is the person's own, or ours: see ``as_own``."""
        self.position = 0
        """The number of the step that undo would take back: tells whether a program is saved."""
        self.undo_label: Words = ""
        """What undo would take back, or an empty text when there is nothing."""
        self.redo_label: Words = ""
        """What redo would do again, or an empty text when there is nothing."""

    def listen(self, listener: Listener, *, is_of_whole: bool = False) -> None:
        """Call ``listener`` with what has changed, after each step and each undo and redo.

        One ``is_of_whole`` that only wants to hear of what changes the project as a whole.
        """
        self._listeners[listener] = is_of_whole

    def unlisten(self, listener: Listener) -> None:
        """Call ``listener`` no more."""
        del self._listeners[listener]

    def record(self, recorder: Recorder) -> None:
        """Call ``recorder`` with the edits of each step, undo and redo, to be played again."""
        self._recorders.append(recorder)

    def unrecord(self, recorder: Recorder) -> None:
        """Call ``recorder`` no more."""
        self._recorders.remove(recorder)

    def finish_with(self, finisher: Finisher, *, is_on: bool = True) -> None:
        """Call ``finisher`` at the end of each new step: what it applies is part of the step."""
        if is_on:
            self._finishers.append(finisher)
        else:
            self._finishers.remove(finisher)

    @contextmanager
    def as_own(self) -> Iterator[None]:
        """All blocks that are made meanwhile are written by the person, or by us; nothing came in.

        Whole blocks count otherwise as somebody else's, with all that is in their fields.
        """
        before, self.is_own = self.is_own, True
        try:
            yield
        finally:
            self.is_own = before

    @contextmanager
    def transaction(self, label: Words) -> Iterator[Step]:
        """Everything applied inside is one step; an exception takes all of it back.

        A transaction inside another is part of the outer one; an exception takes back what was
        applied inside it, so that the outer one may go on.
        """
        if self._open is not None:
            with self._inner(self._open):
                yield self._open
            return
        self._last_number += 1
        step = self._open = Step(label, number=self._last_number)
        try:
            yield step
            for finisher in self._finishers if step.edits else ():
                finisher()
        except BaseException:
            self._take_back(step)
            self._applied.clear()
            raise
        else:
            if step.edits:
                self._redo.clear()
                if self._may_merge and self._undo and self._is_same_typing(step):
                    self._undo[-1].edits += [edit for edit in step.edits if _moves(edit)]
                else:
                    self._undo.append(step)
                self._may_merge = True
        finally:
            self._open = None
            self._tell()

    @contextmanager
    def _inner(self, step: Step) -> Iterator[None]:
        edits, applied = len(step.edits), len(self._applied)
        try:
            yield
        except BaseException:
            while len(step.edits) > edits:
                step.edits.pop().apply(self._project)
            del self._applied[applied:]
            raise

    def apply(self, edit: Edit, label: Words = "") -> None:
        """Apply an edit, as a step of its own when no transaction is open."""
        if self._open is None:
            with self.transaction(label or edit.label):
                self.apply(edit)
            return
        self._open.edits.append(edit.apply(self._project))
        self._applied.append(edit)

    def undo(self) -> bool:
        """Take the last step back; False when there is none."""
        return self._step(self._undo, self._redo)

    def redo(self) -> bool:
        """Do the step again that was taken back last; False when there is none."""
        return self._step(self._redo, self._undo)

    @property
    def steps(self) -> int:
        """How many steps can be taken back."""
        return len(self._undo)

    def drop(self, to: int) -> None:
        """Take steps back until ``to`` are left, as if they had never been: Esc in a field."""
        if self._open is not None:
            raise RuntimeError("steps cannot be dropped inside a transaction")
        self.seal()
        while len(self._undo) > to:
            self._take_back(self._undo.pop())
        self._tell()

    def seal(self) -> None:
        """End the typing: what follows is a step of its own (the field has lost the focus)."""
        self._may_merge = False

    def _step(self, source: list[Step], target: list[Step]) -> bool:
        if self._open is not None:
            raise RuntimeError("undo and redo cannot run inside a transaction")
        self.seal()
        if not source:
            return False
        target.append(self._take_back(source.pop()))
        self._tell()
        return True

    def _tell(self) -> None:
        """Tell the listeners what has changed since the last time."""
        last = self._undo[-1] if self._undo else Step("")
        self.position, self.undo_label = last.number, last.label
        self.redo_label = self._redo[-1].label if self._redo else ""
        applied, self._applied = tuple(self._applied), []
        for recorder in list(self._recorders) if applied else ():
            recorder(applied)
        changes, self._project.changes = self._project.changes, Changes()
        if changes:
            for listener, is_of_whole in list(self._listeners.items()):
                if changes.whole or not is_of_whole:
                    listener(changes)

    def _take_back(self, step: Step) -> Step:
        """Apply a step's edits, newest first; give the step that does the opposite."""
        opposite = Step(step.label, number=step.number)
        while step.edits:
            edit = step.edits.pop()
            opposite.edits.append(edit.apply(self._project))
            self._applied.append(edit)
        return opposite

    def _is_same_typing(self, step: Step) -> bool:
        """Whether a step sets the field or text that the last one did, which then undoes both.

        Stacks that it moves make room for what is typed.
        """
        last = [edit for edit in self._undo[-1].edits if not _moves(edit)]
        match last, [edit for edit in step.edits if not _moves(edit)]:
            case [SetField() as first], [SetField() as second]:
                return (first.block, first.slot) == (second.block, second.slot)
            case [SetComment() as first], [SetComment() as second]:
                return first.block == second.block
            case [ChangeNote() as first], [ChangeNote() as second]:
                # both are what undoes a step: the note as it was before it
                before, now = _without_text(second.note), self._project.notes[second.note.id]
                return _without_text(first.note) == before == _without_text(now)
        return False


def _moves(edit: Edit) -> bool:
    return isinstance(edit, MoveStack)


def _without_text(note: Note) -> Note:
    return msgspec.structs.replace(note, text="")


_BESIDE = 40.0
"""How far from its old stack a block is put that has lost its place, in canvas units."""


RULE_SLOT = "rule"
"""The slot in which a block names a rule, by the first block of that."""


class Editor:
    """A project with its language and its history."""

    def __init__(self, project: Project, language: Language) -> None:
        self.project = project
        self.history = History(project)
        self.transaction = self.history.transaction
        """Everything applied inside is one step of undo."""
        self._language = language.of(project)
        self._offered = dict(self._language.choices)
        self.history.listen(self._on_changes)

    @property
    def language(self) -> Language:
        """The language with the project's own blocks; always the same object, always up to date."""
        return self._language.of(self.project)

    def use_language(self, language: Language) -> None:
        """Go on with the same blocks in other words."""
        self._language = language.of(self.project)
        self._offered = dict(self._language.choices)

    def why_not(self, edit: Edit) -> Text | None:
        """Why an edit does not fit the language, or None when it does."""
        return why_not(edit, self.project, self.language)

    def apply(self, edit: Edit, label: Words = "") -> None:
        """Apply an edit, or raise EditRefused with the reason.

        Choices that depend on a field follow it in the same step.
        """
        reason = why_not(edit, self.project, self.language)
        if reason is not None:
            raise EditRefused(reason)
        if isinstance(edit, RenameVariable | SetScope | ChangeProcedure):
            with self.transaction(label or edit.label), self.renaming():
                self.history.apply(edit)
            return
        if not isinstance(edit, SetField) or not (followers := self._followers(edit)):
            self.history.apply(edit, label)
            return
        with self.history.transaction(label or edit.label):
            self.history.apply(edit)
            for slot in followers:
                self._follow(edit.block, slot)

    def renaming(self, robots: Mapping[str, str] = NO_ROBOTS) -> AbstractContextManager[None]:
        """What gets another name meanwhile gets it in people's own Python too.

        ``robots`` are the new names of robots by the old ones. Raises EditRefused where a name
        cannot be written: the transaction around it takes all back.
        """
        return names_followed(self.project, self.language, self.apply, robots)

    def create(self, block_type: str, place: Place) -> str:
        """Make a block with its default values; gives its id."""
        definition = self.language.definitions[block_type]
        block = definition.new_block(self.project.new_id("b"))
        self.apply(CreateBlocks((block.id,), (block,), place))
        return block.id

    def add_variable(self, name: str, scope: str = "") -> str:
        """Make a variable; gives its id."""
        variable_id = self.project.new_id("v")
        self.apply(AddVariable(variable_id, name, len(self.project.variables), scope))
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
        known = self.project.procedures.get(procedure_id) or Procedure(procedure_id, ())
        self.replace_procedure(changed(known, parts, gives_value=gives_value))

    def replace_procedure(self, procedure: Procedure) -> None:
        """Let an own block be another one of the same id; all that use it follow, as above."""
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
        """Bring the language up to date before anybody else is told; see Language.of.

        Another kind of robot concerns the words of all blocks, and what a rule begins with those
        that name it.
        """
        choices = self.language.choices
        if choices != self._offered:
            self._offered = dict(choices)
            changes.whole = True
        if not self._may_begin_otherwise(changes):
            return
        for block in self.project.blocks.values():
            rule = block.fields.get(RULE_SLOT)
            if rule and self._is_renamed(str(rule), changes):
                changes.stacks.add(self.project.stack_of(block.id).id)
                changes.owners.add(block.id)

    def _may_begin_otherwise(self, changes: Changes) -> bool:
        """Whether a stack has come or gone, or another first block; most edits are inside."""
        project = self.project
        if any(stack not in project.stacks for stack in changes.stacks):
            return True
        firsts = (project.stacks[stack].body[0] for stack in changes.stacks)
        return any(owner not in project.blocks for owner in changes.owners) or any(
            first in changes.owners for first in firsts
        )

    def _is_renamed(self, hat: str, changes: Changes) -> bool:
        """Whether what a rule begins with may say something else."""
        project = self.project
        return hat not in project.blocks or project.stack_of(hat).id in changes.stacks

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
