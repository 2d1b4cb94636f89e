"""Checks the program after each edit, when the person pauses, and never for longer than a frame."""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer, Signal

from nep_studio.blocks.checks.diagnostic import Diagnostic, in_time
from nep_studio.blocks.program import Changes, Project
from nep_studio.blocks.slices import Sliced
from nep_studio.run.installation import KnownProblems, problem_steps
from nep_studio.ui.canvas.selection import Selection
from nep_studio.ui.documents import Document
from nep_studio.ui.edits import Edits, edits_of

SLICE_S = 0.006
"""How long a check may take of one frame of the screen."""

BETWEEN_SLICES_MS = 4


class LiveChecks(QObject):
    """Follows one editor at a time; ``found`` gives the problems, errors first.

    What a block lacks that is just being made is told once the person goes on to another, or asks:
    ``selection`` says which one they are at.
    """

    found = Signal(list)

    def __init__(self, selection: Selection, parent: QObject) -> None:
        super().__init__(parent)
        self._document: Document | None = None
        self._edits: Edits | None = None
        self._known = KnownProblems()
        self._check: Sliced[list[Diagnostic]] | None = None
        self._next = QTimer(self, singleShot=True, interval=BETWEEN_SLICES_MS)
        self._next.timeout.connect(self._on_next_slice)
        self.problems: list[Diagnostic] = []
        """Those that are told."""
        self._all: list[Diagnostic] = []
        self._are_true = False
        self._selection = selection
        self._is_asked = False
        """Whether somebody wanted to know all of this project."""
        self._blocks: set[str] = set()
        self._made: set[str] = set()
        """The blocks that were made or changed, and not left alone since."""
        # Only what is selected in the end counts: a drop selects in several steps
        self._leaving = QTimer(self, singleShot=True, interval=0)
        self._leaving.timeout.connect(self._tell)
        selection.changed.connect(self._leaving.start)

    @property
    def is_in_order(self) -> bool:
        """Whether the program was checked as it is now, files and all, and nothing is wrong."""
        errors = (problem for problem in self._all if problem.severity == "error")
        return self._are_true and self._known.is_whole and not any(errors)

    def follow(self, document: Document | None) -> None:
        """Check another project; None checks nothing."""
        self.cancel()
        if self._edits is not None:
            self._edits.edited.disconnect(self.cancel)
            self._edits.settled.disconnect(self._on_settled)
        self._document, self._known = document, KnownProblems()
        self._is_asked, self._blocks, self._made = False, set(), set()
        self._edits = None if document is None else edits_of(document.editor)
        if document is None or self._edits is None:
            self._all = []
            self._tell(is_news=True)
            return
        self._blocks = set(document.project.blocks)
        self._edits.edited.connect(self.cancel)
        self._edits.settled.connect(self._on_settled)
        self._next.start()

    def start(self) -> None:
        """Check now."""
        self.cancel()
        if (document := self._document) is None:
            return
        editor = document.editor
        self._check = Sliced(
            problem_steps(editor.project, editor.language, document.folder, self._known)
        )
        self._on_next_slice()

    def ask(self) -> None:
        """Tell all that is known from now on, also of what is just being made."""
        self._is_asked = True
        if self._edits is not None:
            self._edits.settle()  # what was made just now is asked about, too
        self._made.clear()
        self._tell()

    def begin_again(self) -> None:
        """Check in the words of another language: nothing is known in them yet."""
        self._known = KnownProblems()
        self.start()

    def take(self, problems: list[Diagnostic]) -> None:
        """Take what somebody has just found who was asked: it need not be looked for again."""
        self.cancel()
        self._all, self._is_asked = problems, True
        self._made.clear()
        self._tell(is_news=True)

    def cancel(self) -> None:
        """Give up the check that is under way; what was found may be true no more."""
        self._next.stop()
        self._are_true = False
        if self._check is not None:
            self._check.cancel()
            self._check = None

    def _on_settled(self, changes: Changes) -> None:
        if self._document is not None:
            blocks = self._document.project.blocks
            if not changes.whole:  # a whole program that is another one is not being made
                self._made |= (blocks.keys() - self._blocks) | (changes.owners & blocks.keys())
            self._blocks = set(blocks)
        self.start()

    def _on_next_slice(self) -> None:
        check = self._check
        if check is None:
            self.start()  # of what was just opened
        elif check.run(SLICE_S):
            self._check, self._all, self._are_true = None, check.result, True
            self._tell(is_news=True)
        else:
            self._next.start()

    def _tell(self, *, is_news: bool = False) -> None:
        """Tell what is to be told now, if that is something else than before, or checked anew."""
        if self._document is not None:
            self._made &= _at_hand(self._document.project, self._selection.ids, self._made)
        told = in_time(self._all, self._made, is_asked=self._is_asked)
        if is_news or told != self.problems:
            self.problems = told
            self.found.emit(told)


def _at_hand(project: Project, selected: tuple[str, ...], blocks: set[str]) -> set[str]:
    """Those of the blocks that are selected, are inside of what is, or have it inside."""
    chosen = set(selected)
    around = {owner for block in selected for owner in _line_of(project, block)}
    return {
        block
        for block in blocks
        if block in around or not chosen.isdisjoint(_line_of(project, block))
    }


def _line_of(project: Project, block: str) -> list[str]:
    """A block, the one that it is inside of, and so on; nothing for one that is gone."""
    line = list[str]()
    while block in project.blocks:
        line.append(block)
        block = project.parents[block].owner
    return line
