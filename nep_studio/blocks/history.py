"""Undo and redo: transactions of edits, each one step; typing in one field is one step too."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import msgspec

from .edits import ChangeNote, Edit, SetComment, SetField
from .program import Changes, Note, Project

Listener = Callable[[Changes], None]
Recorder = Callable[[tuple[Edit, ...]], None]


@dataclass(slots=True)
class Step:
    """One step that a person can take back: its label for the menu, and the edits to do so."""

    label: str
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
        self._listeners: list[Listener] = []
        self._applied: list[Edit] = []
        self._recorders: list[Recorder] = []

    def listen(self, listener: Listener) -> None:
        """Call ``listener`` with what has changed, after each step and each undo and redo."""
        self._listeners.append(listener)

    def unlisten(self, listener: Listener) -> None:
        """Call ``listener`` no more."""
        self._listeners.remove(listener)

    def record(self, recorder: Recorder) -> None:
        """Call ``recorder`` with the edits of each step, undo and redo, to be played again."""
        self._recorders.append(recorder)

    def unrecord(self, recorder: Recorder) -> None:
        """Call ``recorder`` no more."""
        self._recorders.remove(recorder)

    @property
    def position(self) -> int:
        """The number of the step that undo would take back: tells whether a program is saved."""
        return self._undo[-1].number if self._undo else 0

    @property
    def undo_label(self) -> str:
        """What undo would take back, or an empty text when there is nothing."""
        return self._undo[-1].label if self._undo else ""

    @property
    def redo_label(self) -> str:
        """What redo would do again, or an empty text when there is nothing."""
        return self._redo[-1].label if self._redo else ""

    @contextmanager
    def transaction(self, label: str) -> Iterator[Step]:
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
        except BaseException:
            self._take_back(step)
            self._applied.clear()
            raise
        else:
            self._record(step)
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

    def apply(self, edit: Edit, label: str = "") -> None:
        """Apply an edit, as a step of its own when no transaction is open."""
        with self.transaction(label or edit.label) as step:
            step.edits.append(edit.apply(self._project))
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
        applied, self._applied = tuple(self._applied), []
        for recorder in list(self._recorders) if applied else ():
            recorder(applied)
        changes, self._project.changes = self._project.changes, Changes()
        if changes:
            for listener in list(self._listeners):
                listener(changes)

    def _take_back(self, step: Step) -> Step:
        """Apply a step's edits, newest first; give the step that does the opposite."""
        opposite = Step(step.label, number=step.number)
        while step.edits:
            edit = step.edits.pop()
            opposite.edits.append(edit.apply(self._project))
            self._applied.append(edit)
        return opposite

    def _record(self, step: Step) -> None:
        if not step.edits:
            return
        self._redo.clear()
        if not (self._may_merge and self._undo and self._is_same_typing(step)):
            self._undo.append(step)
        self._may_merge = True

    def _is_same_typing(self, step: Step) -> bool:
        """Whether a step goes on with the typing of the last one."""
        if not _same_typing(self._undo[-1], step):
            return False
        edit = step.edits[0]
        if not isinstance(edit, ChangeNote):
            return True
        return _without_text(edit.note) == _without_text(self._project.notes[edit.note.id])


def _same_typing(earlier: Step, later: Step) -> bool:
    """Whether two steps set the same field or comment; the earlier one then undoes both."""
    if len(earlier.edits) != 1 or len(later.edits) != 1:
        return False
    first, second = earlier.edits[0], later.edits[0]
    if isinstance(first, SetField) and isinstance(second, SetField):
        return (first.block, first.slot) == (second.block, second.slot)
    if isinstance(first, SetComment) and isinstance(second, SetComment):
        return first.block == second.block
    if isinstance(first, ChangeNote) and isinstance(second, ChangeNote):
        # both are what undoes a step: the note as it was before it
        return _without_text(first.note) == _without_text(second.note)
    return False


def _without_text(note: Note) -> Note:
    return msgspec.structs.replace(note, text="")
