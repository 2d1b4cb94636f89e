"""Checks the program after each edit, when the person pauses, and never for longer than a frame."""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer, Signal

from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.blocks.slices import Sliced
from nep_studio.run.installation import KnownProblems, problem_steps
from nep_studio.ui.documents import Document
from nep_studio.ui.edits import Edits, edits_of

SLICE_S = 0.006
"""How long a check may take of one frame of the screen."""

BETWEEN_SLICES_MS = 4


class LiveChecks(QObject):
    """Follows one editor at a time; ``found`` gives the problems, errors first."""

    found = Signal(list)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._document: Document | None = None
        self._edits: Edits | None = None
        self._known = KnownProblems()
        self._check: Sliced[list[Diagnostic]] | None = None
        self._next = QTimer(self, singleShot=True, interval=BETWEEN_SLICES_MS)
        self._next.timeout.connect(self._on_next_slice)
        self.problems: list[Diagnostic] = []
        self._are_true = False

    @property
    def is_in_order(self) -> bool:
        """Whether the program was checked as it is now, files and all, and nothing is wrong."""
        errors = (problem for problem in self.problems if problem.severity == "error")
        return self._are_true and self._known.is_whole and not any(errors)

    def follow(self, document: Document | None) -> None:
        """Check another project; None checks nothing."""
        self.cancel()
        if self._edits is not None:
            self._edits.edited.disconnect(self.cancel)
            self._edits.settled.disconnect(self.start)
        self._document, self._known = document, KnownProblems()
        self._edits = None if document is None else edits_of(document.editor)
        if self._edits is None:
            self.take([])
            return
        self._edits.edited.connect(self.cancel)
        self._edits.settled.connect(self.start)
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

    def begin_again(self) -> None:
        """Check in the words of another language: nothing is known in them yet."""
        self._known = KnownProblems()
        self.start()

    def take(self, problems: list[Diagnostic]) -> None:
        """Take what somebody else has just found: it need not be looked for again."""
        self.cancel()
        self.problems = problems
        self.found.emit(problems)

    def cancel(self) -> None:
        """Give up the check that is under way; what was found may be true no more."""
        self._next.stop()
        self._are_true = False
        if self._check is not None:
            self._check.cancel()
            self._check = None

    def _on_next_slice(self) -> None:
        check = self._check
        if check is None:
            self.start()  # of what was just opened
        elif check.run(SLICE_S):
            self._check, self.problems, self._are_true = None, check.result, True
            self.found.emit(self.problems)
        else:
            self._next.start()
