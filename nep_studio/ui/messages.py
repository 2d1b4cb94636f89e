"""The one door for messages to the person: cards over the canvas, and dialogs for questions."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, Protocol

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QAccessible, QAccessibleAnnouncementEvent
from PySide6.QtWidgets import QWidget

from faults import FaultError, Words
from nep_studio.problems import Problem, problem_of
from nep_studio.ui.words import tr

Kind = Literal["info", "success", "warning", "error"]

KIND_ICONS: dict[Kind, str] = {
    "info": "info",
    "success": "circle-check",
    "warning": "triangle-alert",
    "error": "circle-alert",
}
"""Each kind has a shape of its own: colour never speaks alone."""

MOST_TOLD = 500
"""So many messages are remembered until the window is closed."""


@dataclass(frozen=True)
class Answer:
    """Something that a person can press: its words, what it does, how it looks."""

    words: str
    do: Callable[[], object]
    look: Literal["primary", "quiet", ""] = ""


@dataclass(frozen=True)
class Message:
    """What happened and what to do.

    One that ``passes`` goes by itself after it could be read; one that ``is_busy`` tells of
    something that goes on, until it is withdrawn. All go with the project that is open, but one
    that ``outlives_project``: it is about the window, the computer or its network.
    """

    kind: Kind
    title: str
    sentence: str = ""
    checklist: tuple[str, ...] = ()
    details: str = ""
    answers: tuple[Answer, ...] = ()
    passes: bool = False
    is_busy: bool = False
    outlives_project: bool = False

    @property
    def spoken(self) -> str:
        """What a screen reader says."""
        return " ".join(part for part in (self.title, self.sentence, *self.checklist) if part)


@dataclass(frozen=True)
class LoggedMessage:
    """A message, and when it was told (time.time())."""

    message: Message
    time_s: float


class Place(Protocol):
    """Where messages are shown."""

    def show_message(self, message: Message) -> None:
        """Show one."""

    def withdraw(self, message: Message) -> None:
        """Take one away."""

    def clear_passing(self) -> None:
        """Take away those that go by themselves."""


class Messages(QObject):
    """Tells and asks; everything that the window has to say goes through here.

    ``told`` gives each message as it is told; ``history`` has the last ones, the newest last.
    """

    told = Signal(object)  # LoggedMessage

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self.history: deque[LoggedMessage] = deque(maxlen=MOST_TOLD)
        self._window = window
        self._place: Place | None = None
        self._has_passing = False
        """Whether something may be shown that goes by itself."""

    def show_in(self, place: Place) -> Place | None:
        """Use this place for what is told from now on; the place that was used before."""
        before, self._place = self._place, place
        return before

    def tell(self, message: Message) -> None:
        """Show a message; nobody has to answer it."""
        if self._place is not None:
            self._place.show_message(message)
        self._has_passing = self._has_passing or message.passes
        announce(self._window, message.spoken)
        self.history.append(LoggedMessage(message, time.time()))
        self.told.emit(self.history[-1])

    def tell_problem(self, problem: Problem, *answers: Answer, kind: Kind = "error") -> None:
        """Show an error that a person can act on."""
        place = f" {problem.place}" if problem.place else ""
        sentence = tr(problem.sentence) + place
        checklist = tuple(map(tr, problem.checklist))
        self.tell(Message(kind, tr(problem.title), sentence, checklist, problem.details, answers))

    def tell_error(self, error: FaultError, *answers: Answer) -> None:
        """Show what an error tells of."""
        self.tell_problem(problem_of(error), *answers)

    def refuse(self, reason: Words, checklist: tuple[Words, ...] = ()) -> None:
        """Say why something did not go; the program is as it was."""
        message = Message("warning", tr("This does not fit"), tr(reason), tuple(map(tr, checklist)))
        self.tell(replace(message, passes=True))

    def confirm(self, title: str, *answers: Answer) -> None:
        """Say that something has been done; it goes by itself."""
        self.tell(Message("success", title, answers=answers, passes=True))

    def clear_passing(self) -> None:
        """Take away what goes by itself: the person has gone on."""
        if self._place is not None and self._has_passing:
            self._has_passing = False
            self._place.clear_passing()

    def withdraw(self, message: Message) -> None:
        """Take a message away."""
        if self._place is not None:
            self._place.withdraw(message)

    def leave_project(self) -> None:
        """Take away what was told of a project that is open no more."""
        for told in self.history:
            if not (told.message.outlives_project or told.message.is_busy):
                self.withdraw(told.message)

    def ask(self, message: Message) -> None:
        """Ask a question that must be answered before the work goes on; Esc is the last answer."""
        from .message_cards import QuestionDialog

        QuestionDialog(message, self._window).open()


def announce(widget: QWidget, words: str) -> None:
    """Let a screen reader say something."""
    if QAccessible.isActive() and words:
        QAccessible.updateAccessibility(QAccessibleAnnouncementEvent(widget, words))
