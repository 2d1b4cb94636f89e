"""Plays a project for a public: begins it, tells how it goes, begins it again when it failed."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import msgspec
from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.errors import NepError
from nep_core.wire import messages as m
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.generate.program import generate_program
from nep_studio.problems import Problem, problem_of
from nep_studio.project.triggers import Cue, cues_now
from nep_studio.run.controller import Request, Subject
from nep_studio.run.plan import Ending
from nep_studio.settings import ShowOptions
from nep_studio.ui.messages import LoggedMessage
from nep_studio.ui.running.stage import Marks
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.documents import Document
    from nep_studio.ui.host import Host


# Whether and when a show that has ended is begun again; no clock and no Qt in here.

PAUSE_S = 5.0
LONGEST_PAUSE_S = 60.0
STEADY_S = 60.0
"""A show that has gone on for so long was not broken from the beginning."""


@dataclass
class Restarts:
    """Counts failures in a row; after ``most`` of them somebody must look.

    ``again``: a show that ended well begins anew, too. ``total`` is how often it was begun again
    since somebody pressed Run.
    """

    most: int = 5
    again: bool = False
    failures: int = 0
    total: int = 0
    _began_s: float = field(default=0.0, repr=False)

    def pressed(self) -> None:
        """Somebody has pressed Run: what was before does not count any more."""
        self.failures = self.total = 0

    def began(self, now_s: float) -> None:
        """A show begins."""
        self._began_s = now_s

    def failed(self, now_s: float) -> float | None:
        """How long to wait before it begins again, in s; None: somebody must look."""
        if now_s - self._began_s >= STEADY_S:
            self.failures = 0
        self.failures += 1
        if self.failures > self.most:
            return None
        self.total += 1
        return min(PAUSE_S * 2.0 ** (self.failures - 1), LONGEST_PAUSE_S)

    def ended(self) -> float | None:
        """The same for a show that ended well; None: it waits for somebody to press Run."""
        self.failures = 0
        if not self.again:
            return None
        self.total += 1
        return PAUSE_S


# What the robots say at this moment; no Qt in here.

SPEECHES = ("say", "ask")
LINGER_S = 3.0
"""What was said stays for so long: who stands far away reads slowly."""
MOST_SPEECHES = 50


class Speeches:
    """Hears what robots are asked and how it goes, in whichever order that comes."""

    def __init__(self) -> None:
        self._texts: dict[str, str] = {}
        self._begun: dict[tuple[str, str], None] = {}
        self._ended_s: dict[tuple[str, str], float] = {}

    def hear(self, message: msgspec.Struct, now_s: float) -> bool:
        """Take a message in; whether it may have changed what is said."""
        if isinstance(message, m.ActionRequest) and message.action in SPEECHES:
            self._texts[message.id] = str(message.args.get("text", ""))
            _keep_the_last(self._texts)
            return True
        if not isinstance(message, m.ActionResult):
            return False
        speech = message.robot, message.id
        if message.state == "started":
            self._begun.setdefault(speech)
            _keep_the_last(self._begun)
        elif message.state in ("done", "failed", "cancelled"):
            self._ended_s.setdefault(speech, now_s)
            _keep_the_last(self._ended_s)
        return True

    def now(self, now_s: float) -> list[str]:
        """What each robot says, or has just said; who says it where several do."""
        said = {}
        for robot, action in self._begun:
            text, ended_s = self._texts.get(action), self._ended_s.get((robot, action), now_s)
            if text and now_s - ended_s < LINGER_S:
                said[robot] = text
        if len(said) < 2:
            return list(said.values())
        return [f"{robot}: {text}" for robot, text in said.items()]


def _keep_the_last(entries: dict[Any, Any]) -> None:
    while len(entries) > MOST_SPEECHES:
        del entries[next(iter(entries))]


State = Literal["ready", "opening", "starting", "playing", "stopping", "waiting", "attention"]
TICK_MS = 1000
LOOK_MS = 250
"""How often at most the public is told something else."""
_STATES: dict[str, State] = {
    "starting": "starting",
    "running": "playing",
    "paused": "playing",
    "stopping": "stopping",
}


class Performance(QObject):
    """The show of one window. ``changed`` tells of its state, ``told`` of what the public is told:
    ``said`` by the robots, and ``invited``, what somebody can do now.

    A project that is named by ``path`` is opened when it is needed, and again when that failed:
    the disk that it is on may come later than the show.
    """

    changed = Signal()
    told = Signal()

    def __init__(
        self,
        host: Host,
        options: ShowOptions,
        path: Path | None = None,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(host.widget)
        self._host, self._options, self._path, self._now = host, options, path, now
        self._runner = host.services.runner
        self.state: State = "ready"
        self.problem: Problem | None = None
        self.restarts = Restarts(options.restarts, options.again)
        self.said: list[str] = []
        self.invited: list[Cue] = []
        self.seconds_left = 0
        self._was_stopped = False
        self._speeches = Speeches()
        self._marks: Marks | None = None
        self._look = QTimer(self, singleShot=True, interval=LOOK_MS)
        self._look.timeout.connect(self._on_look)
        self._clock = QTimer(self, interval=TICK_MS)
        self._clock.timeout.connect(self._on_tick)
        self._runner.state_changed.connect(self._on_state_changed)
        self._runner.arrived.connect(self._on_arrived)
        self._runner.ended.connect(self._on_ended)
        host.services.files.document_changed.connect(self._on_document_changed)
        host.services.messages.told.connect(self._on_told)
        if self._runner.state in _STATES:
            self.state = _STATES[self._runner.state]
            self._look.start()

    @property
    def title(self) -> str:
        """What is played."""
        document = self._host.services.document
        if document is not None:
            return document.title
        return self._path.stem if self._path is not None else ""

    @property
    def is_running(self) -> bool:
        """Whether there is something to stop."""
        return self.state in ("opening", "starting", "playing", "waiting")

    def run(self) -> None:
        """Somebody wants it to begin."""
        if self.state in ("ready", "attention"):
            self.restarts.pressed()
            self._begin()

    def stop(self) -> None:
        """Somebody wants it to end: the robots first, and no other beginning."""
        self._clock.stop()
        self._was_stopped = True
        if self._runner.state == "idle":
            self._set_state("ready")
        else:
            self._runner.stop()

    def retire(self) -> None:
        """Follow the window no more; what runs goes on."""
        self._clock.stop()
        self._look.stop()
        self._runner.state_changed.disconnect(self._on_state_changed)
        self._runner.arrived.disconnect(self._on_arrived)
        self._runner.ended.disconnect(self._on_ended)
        self._host.services.files.document_changed.disconnect(self._on_document_changed)
        self._host.services.messages.told.disconnect(self._on_told)
        self.deleteLater()

    # How it goes on

    def _begin(self) -> None:
        self._was_stopped = False
        self.problem = None
        self.restarts.began(self._now())
        document = self._host.services.document
        if document is not None:
            self._play(document)
        elif self._path is not None:
            self._set_state("opening")
            self._host.services.files.open(self._path)
        else:
            steps = (tr("Open a project in the studio first."),)
            self._fail(Problem(tr("There is no project to play"), "", steps))

    def _play(self, document: Document) -> None:
        self._speeches = Speeches()
        try:
            code = generate_program(document.project, document.editor.language)
            nodes = self._host.services.running.planned()
        except (BlocksError, NepError) as error:
            self._fail(problem_of(error))
            return
        self._marks = Marks(code)
        subject = Subject(document.project, document.editor.language, document.folder)
        if not self._runner.begin(subject, Request(code, tuple(nodes), is_watched=False)):
            steps = (tr("Press Run, and look at what it brings."),)
            self.problem = Problem(tr("Nobody has approved this project yet"), "", steps)
            self._set_state("attention")

    def _fail(self, problem: Problem) -> None:
        self.problem = problem
        self._wait(self.restarts.failed(self._now()), "attention")

    def _wait(self, pause_s: float | None, otherwise: State) -> None:
        if pause_s is None:
            self._set_state(otherwise)
            return
        self.seconds_left = round(pause_s)
        self._clock.start()
        self._set_state("waiting")

    def _set_state(self, state: State) -> None:
        self.state = state
        self.changed.emit()
        self._look_soon()

    def _on_tick(self) -> None:
        self.seconds_left -= 1
        if self.seconds_left > 0:
            self.changed.emit()
            return
        self._clock.stop()
        self._begin()

    def _on_document_changed(self, document: Document | None) -> None:
        if self.state == "opening" and document is not None:
            self._play(document)
        self.changed.emit()

    def _on_told(self, told: LoggedMessage) -> None:
        """A project that cannot be opened is told by a message only."""
        message = told.message
        if self.state == "opening" and message.kind == "error":
            self._fail(Problem(message.title, message.sentence, message.checklist, message.details))

    def _on_state_changed(self, state: str) -> None:
        if state in _STATES:
            self._set_state(_STATES[state])

    def _on_ended(self, ending: Ending) -> None:
        if self._was_stopped:
            self._set_state("ready")
        elif ending.problem is not None:
            self._fail(ending.problem)
        else:
            self._wait(self.restarts.ended(), "ready")

    def _on_arrived(self, batch: list[tuple[str, msgspec.Struct]]) -> None:
        for _, message in batch:
            if isinstance(message, m.ProgramState):
                if self._marks is not None:
                    self._marks.take(message)
                self._look_soon()
            elif self._speeches.hear(message, self._now()):
                self._look_soon()

    def _look_soon(self) -> None:
        if not self._look.isActive():
            self._look.start()

    def _on_look(self) -> None:
        """See what is said and waited for now; what was said goes after a while."""
        said, invited = self._speeches.now(self._now()), self._waited_for()
        if (said, invited) != (self.said, self.invited):
            self.said, self.invited = said, invited
            self.told.emit()
        if said:
            self._look.start()

    def _waited_for(self) -> list[Cue]:
        document = self._host.services.document
        if document is None or self.state != "playing":
            return []
        marks = self._marks or Marks()
        running = marks.glowing | marks.around
        waited = cues_now(document.project, document.editor.language, running)
        # a cue without a meaning of its own is its operator's: no visitor can do it
        return [cue for cue in waited if cue.kind != "state" or cue.label]
