"""The one door for messages to the person: cards over the canvas, and dialogs for questions."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

from PySide6.QtCore import QObject
from PySide6.QtGui import QAccessible, QAccessibleAnnouncementEvent
from PySide6.QtWidgets import QWidget

from nep_core.errors import NepError
from nep_studio.blocks.errors import BlocksError
from nep_studio.problems import Problem, problem_of
from nep_studio.ui.words import tr

log = logging.getLogger(__name__)

Kind = Literal["info", "success", "warning", "error"]

KIND_ICONS: dict[Kind, str] = {
    "info": "info",
    "success": "circle-check",
    "warning": "triangle-alert",
    "error": "circle-alert",
}
"""Each kind has a shape of its own: colour never speaks alone."""


@dataclass(frozen=True)
class Answer:
    """Something that a person can press: its words, what it does, how it looks."""

    words: str
    do: Callable[[], object]
    look: Literal["primary", "quiet", ""] = ""


@dataclass(frozen=True)
class Message:
    """What happened and what to do; one that ``passes`` goes by itself after it could be read."""

    kind: Kind
    title: str
    sentence: str = ""
    checklist: tuple[str, ...] = ()
    details: str = ""
    answers: tuple[Answer, ...] = ()
    passes: bool = False

    @property
    def spoken(self) -> str:
        """What a screen reader says."""
        return " ".join(part for part in (self.title, self.sentence, *self.checklist) if part)


class Messages(QObject):
    """Tells and asks; everything that the window has to say goes through here."""

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self._window = window
        self._show: Callable[[Message], None] = _log_only
        self._clear_passing: Callable[[], None] = lambda: None

    def show_in(self, show: Callable[[Message], None], clear_passing: Callable[[], None]) -> None:
        """Use this place for what is told from now on."""
        self._show, self._clear_passing = show, clear_passing

    def tell(self, message: Message) -> None:
        """Show a message; nobody has to answer it."""
        self._show(message)
        announce(self._window, message.spoken)

    def tell_problem(self, problem: Problem, *answers: Answer, kind: Kind = "error") -> None:
        """Show an error that a person can act on."""
        place = f" {problem.place}" if problem.place else ""
        sentence = tr(problem.sentence) + place
        checklist = tuple(map(tr, problem.checklist))
        self.tell(Message(kind, tr(problem.title), sentence, checklist, problem.details, answers))

    def tell_error(self, error: NepError | BlocksError, *answers: Answer) -> None:
        """Show what an error tells of."""
        self.tell_problem(problem_of(error), *answers)

    def refuse(self, reason: str, checklist: tuple[str, ...] = ()) -> None:
        """Say why something did not go; the program is as it was."""
        message = Message("warning", tr("This does not fit"), tr(reason), checklist)
        self.tell(replace(message, passes=True))

    def confirm(self, title: str, *answers: Answer) -> None:
        """Say that something has been done; it goes by itself."""
        self.tell(Message("success", title, answers=answers, passes=True))

    def clear_passing(self) -> None:
        """Take away what goes by itself: the person has gone on."""
        self._clear_passing()

    def ask(self, message: Message) -> None:
        """Ask a question that must be answered before the work goes on; Esc is the last answer."""
        from nep_studio.ui.messages_question import QuestionDialog

        QuestionDialog(message, self._window).open()


def announce(widget: QWidget, words: str) -> None:
    """Let a screen reader say something."""
    if QAccessible.isActive() and words:
        QAccessible.updateAccessibility(QAccessibleAnnouncementEvent(widget, words))


def _log_only(message: Message) -> None:
    log.warning("Nobody sees this message: %s", message.spoken)
