"""Run, from the press of the button to the end: one state machine, without Qt.

    idle -> checking -> generating -> starting -> running <-> paused -> stopping -> idle

Read it from ``run`` downwards. Checking and generating are work, done in slices by ``work``; what
was checked or generated already, while the person looked, is not done again. Only what really
waits, the session, has a thread, which posts what it has to say.
"""

from __future__ import annotations

import logging
import tempfile
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from faults import reason_of, text_of
from nep_core.errors import NepError
from nep_core.wire import messages as m
from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.blocks.deployment import rules
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.generate.program import ProgramGenerator
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Changes, Project
from nep_studio.blocks.slices import Sliced
from nep_studio.problems import Problem, problem_of
from nep_studio.project import surroundings, triggers
from nep_studio.project.trust import Concern

from .gate import concerns_of, node_concern
from .installation import problem_steps
from .plan import Choices, Ending, PlannedNode, Watching, plan

if TYPE_CHECKING:
    from .local_network import LocalNetwork
    from .session import Session

log = logging.getLogger(__name__)

State = Literal["idle", "checking", "generating", "starting", "running", "paused", "stopping"]
PREPARING: frozenset[State] = frozenset(("checking", "generating"))
"""No part of the program is there yet."""

AT_ONCE = frozenset((triggers.KEY, surroundings.KEY))
"""What a project keeps that a running program needs no new start for."""


@dataclass(frozen=True)
class Subject:
    """What is to be run: a project, where its files are, and who plays its robots.

    ``kept`` is the file of its variables that are kept. ``is_in_order``: it was checked as it is
    now, and nothing is wrong; ``code``: its Python, and ``known``: its nodes, where these were made
    already.
    """

    project: Project
    language: Language
    folder: Path
    choices: Choices = field(default_factory=Choices)
    kept: Path | None = None
    is_in_order: bool = False
    code: Code | None = None
    known: Sequence[PlannedNode] | None = None

    def nodes(self) -> list[PlannedNode]:
        """The nodes that it needs."""
        if self.known is not None:
            return list(self.known)
        return plan(self.project, self.language, self.choices, self.folder)


@dataclass(frozen=True)
class Request:
    """A program that is ready to be started: its code, and the nodes that it needs.

    ``kept`` is the file of its variables that are kept. ``is_shown``: its blocks are those on the
    canvas. ``is_watched``: it pauses at some of them, and goes at the pace that a person wants.
    """

    code: Code
    nodes: tuple[PlannedNode, ...]
    is_shown: bool = True
    is_watched: bool = True
    kept: Path | None = None


# What is told of a run, one after the other, in the thread of whoever owns the controller.


@dataclass(frozen=True)
class StateChanged:
    """The state is another one now."""

    state: State


@dataclass(frozen=True)
class Checked:
    """The checks are over; where it ``can_run``, it goes on by itself."""

    problems: list[Diagnostic]
    can_run: bool


@dataclass(frozen=True)
class Refused:
    """There is no program to start: it cannot become code, or its nodes are not known."""

    error: BlocksError | NepError
    is_shown: bool


@dataclass(frozen=True)
class NeedsApproval:
    """The program brings what is not blocks, of which nobody has approved these parts yet.

    Once somebody has, ``begin`` takes the subject and the request as they are.
    """

    concerns: list[Concern]
    subject: Subject
    request: Request


@dataclass(frozen=True)
class Begun:
    """A program is about to start."""

    request: Request


@dataclass(frozen=True)
class BecameStale:
    """The blocks have changed since the program was started."""


@dataclass(frozen=True)
class Troubled:
    """Something went wrong while the program goes on, at a line of its Python; a rule failed, or
    (not ``is_error``) a warning was told.
    """

    problem: Problem
    line: int
    is_error: bool


@dataclass(frozen=True)
class Ended:
    """How the program ended.

    ``was_stopped``: somebody wanted it; ``had_begun``: it ran at all; ``runs_again``: what is open
    now is run at once, and nobody needs to be told.
    """

    ending: Ending
    was_stopped: bool
    had_begun: bool
    runs_again: bool


Event = StateChanged | Checked | Refused | NeedsApproval | Begun | BecameStale | Troubled | Ended


class RunController:
    """Runs what is open, one program at a time; nothing in here waits, but ``close``.

    ``network`` gives what is played on, once it is needed: its modules take a while to load.
    ``subject`` gives what is open, or None. ``post`` lets something be done in the owner's thread,
    soon and in order. ``tell`` hears of each Event. While the state is one of PREPARING, the owner
    calls ``work`` whenever it has time. Programs that are ``is_traced`` tell of each of their
    lines, and can be paused.
    """

    def __init__(
        self,
        network: Callable[[], LocalNetwork],
        subject: Callable[[], Subject | None],
        post: Callable[[Callable[[], None]], None],
        tell: Callable[[Event], None],
        *,
        is_traced: bool = True,
    ) -> None:
        self._network, self._subject, self._post, self._tell = network, subject, post, tell
        self._is_traced = is_traced
        self.state: State = "idle"
        self.request: Request | None = None
        """What was started last."""
        self.is_stale = False
        """Whether the blocks have changed since then."""
        self._prepared: Subject | None = None
        self._is_shown = True
        self._checks: Sliced[list[Diagnostic]] | None = None
        self._code: Sliced[Code] | None = None
        self._session: Session | None = None
        self._thread: threading.Thread | None = None
        self._troubles: set[tuple[int, str]] = set()
        """What went wrong at which line: a rule that fails again and again tells it once."""
        self._breakpoints: frozenset[str] = frozenset()
        self._line_s = 0.0
        self._was_stopped = self._had_begun = self._runs_again = self._is_closed = False

    # From the press to the start

    def run(self) -> None:
        """Run what is open: from its beginning if it runs; a paused program goes on."""
        if self._is_closed:
            return
        if self.state == "paused":
            self.resume()
        elif self.state == "running":
            self.run_next()
        elif self.state == "idle" and (subject := self._subject()) is not None:
            if not subject.is_in_order:
                self._check(subject)
            elif subject.code is None:
                self._generate(subject, is_shown=True)
            else:
                try:
                    self.begin(
                        subject, Request(subject.code, tuple(subject.nodes()), kept=subject.kept)
                    )
                except (BlocksError, NepError) as error:
                    self._tell(Refused(error, is_shown=True))

    def run_next(self) -> None:
        """Run what is open as soon as what runs now is stopped."""
        if self.state in PREPARING or self.state == "idle":
            self.run()
            return
        self.stop()
        self._runs_again = True

    def try_out(self, subject: Subject) -> None:
        """Run a program whose blocks are not on the canvas, and were checked already."""
        if self.state == "idle" and not self._is_closed:
            self._generate(subject, is_shown=False)

    def work(self, slice_s: float) -> None:
        """Go on with the checks, or with the code, for so long."""
        try:
            if self._checks is not None and self._checks.run(slice_s):
                problems = self._checks.result
                subject, self._checks = self._prepared, None
                assert subject is not None
                has_rules = next(rules(subject.project, subject.language), None) is not None
                can_run = has_rules and all(problem.severity != "error" for problem in problems)
                if can_run:
                    self._generate(subject, is_shown=True)
                else:
                    self._give_up()
                self._tell(Checked(problems, can_run))
            elif self._code is not None and self._code.run(slice_s):
                assert self._prepared is not None
                nodes = tuple(self._prepared.nodes())
                request = Request(
                    self._code.result, nodes, self._is_shown, kept=self._prepared.kept
                )
                subject, self._prepared, self._code = self._prepared, None, None
                if not self.begin(subject, request):
                    self._set_state("idle")
        except (BlocksError, NepError) as error:
            self._give_up()
            self._tell(Refused(error, self._is_shown))

    def _check(self, subject: Subject) -> None:
        """What is wrong with it?"""
        self._prepared, self._is_shown = subject, True
        project, language = subject.project, subject.language.of(subject.project)
        self._checks = Sliced(problem_steps(project, language, subject.folder))
        self._set_state("checking")

    def _generate(self, subject: Subject, *, is_shown: bool) -> None:
        """What is its Python?"""
        self._prepared, self._is_shown = subject, is_shown
        self._code = Sliced(ProgramGenerator(subject.project, subject.language).steps())
        self._set_state("generating")

    def edited(self, changes: Changes) -> None:
        """What is open has changed: what is prepared begins anew with that, what runs is old."""
        if self.state in PREPARING and self._is_shown:
            assert self._prepared is not None
            prepared = replace(self._prepared, known=None)
            self._cancel_work()
            self._check(prepared)
        elif changes.kept and changes.kept <= AT_ONCE and not changes.stacks:
            return
        elif self.state not in PREPARING and self.state != "idle" and not self.is_stale:
            self.is_stale = True
            self._tell(BecameStale())

    def _give_up(self) -> None:
        """Prepare no more."""
        self._cancel_work()
        self._set_state("idle")

    def _cancel_work(self) -> None:
        for work in (self._checks, self._code):
            if work is not None:
                work.cancel()
        self._prepared = self._checks = self._code = None

    # From the start to the end

    def begin(self, subject: Subject, request: Request) -> bool:
        """Start what was made of a project, if a person knows all that it brings.

        What the choices add to the project, such as the address of a robot, a person has said.
        """
        gate = self._network().gate
        # First what is to start, then what is approved: a file that is swapped between is noticed
        concerns = [(node, node_concern(node)) for node in request.nodes]
        brought = concerns_of(subject.project, subject.language, subject.folder)
        left = gate.unapproved(brought)
        if left:
            self._tell(NeedsApproval(left, subject, request))
            return False
        known, choices = {one.key for one in brought}, subject.choices
        gate.vouch(
            concern.key
            for node, concern in concerns
            if concern is not None and (concern.key in known or choices.have_made(node))
        )
        gate.admit(request.code.text)
        self.start(request)
        return True

    def start(self, request: Request) -> None:
        """Start a program that is ready, and has passed the gate; Ended tells how it went."""
        if self._session is not None or self._is_closed:
            return
        self.request = request
        self.is_stale = self._was_stopped = self._had_begun = False
        self._troubles.clear()
        self._tell(Begun(request))
        watching = self._watching() if self._is_traced else None
        from .session import Session  # it takes a while to load

        self._session = Session(
            request.nodes, self._network(), kept=request.kept, watching=watching
        )
        self._set_state("starting")
        play = partial(self._play, self._session, request.code)
        self._thread = threading.Thread(target=play, name="nep-studio-run", daemon=True)
        self._thread.start()

    def _play(self, session: Session, code: Code) -> None:
        """Start everything, wait for the end, stop everything; in a thread of its own."""
        try:
            with tempfile.TemporaryDirectory(prefix="nep-", ignore_cleanup_errors=True) as folder:
                program = Path(folder) / "program.py"
                program.write_text(code.text, encoding="utf-8")
                session.program = program
                with session:
                    self._post(self._on_begun)
                    ending = session.wait()
        except NepError as error:
            ending = Ending(problem_of(error))
        except OSError as error:
            ending = Ending(_disk_problem(error))
        except Exception as error:
            log.exception("the program could not be run")
            sentence = f"{type(error).__name__}: {error}"
            steps = ("Try it once more.", "Save the project, and start NEP Studio again.")
            ending = Ending(Problem("The program could not be started", sentence, steps))
        self._post(lambda: self._on_over(ending))

    def _on_begun(self) -> None:
        if self.state == "starting":
            self._had_begun = True
            self._set_state("running")

    def _on_over(self, ending: Ending) -> None:
        assert self._thread is not None
        self._thread.join()
        self._session = self._thread = None
        runs_again, self._runs_again = self._runs_again, False
        self._set_state("idle")
        self._tell(Ended(ending, self._was_stopped, self._had_begun, runs_again))
        if runs_again:
            self.run()

    def stop(self) -> None:
        """Stop the robots at once, then the program, then what was started for it."""
        self._was_stopped, self._runs_again = True, False
        if self.state in PREPARING:
            self._give_up()
        elif self._session is not None and self.state != "stopping":
            self._set_state("stopping")
            self._end(self._session)

    def close(self) -> None:
        """Stop, and wait for the end; nothing starts after it."""
        self.stop()
        self._is_closed = True
        if self._thread is not None and self._session is not None:
            self._end(self._session)
            self._thread.join()

    def _end(self, session: Session) -> None:
        """The robots first; the rest follows in the session's thread."""
        session.stop_robots()
        session.end()

    # While it runs

    def pause(self) -> None:
        """Let the program pause at its next lines."""
        if self._session is not None and self.state == "running":
            self._session.order("pause")
            self._set_state("paused")  # parts that are waiting only tell when they go on

    def resume(self) -> None:
        """Let a paused program go on."""
        if self._session is not None and self.state == "paused":
            self._session.order("resume")
            self._set_state("running")

    def step(self, thread: str = "") -> None:
        """Let a paused program run one line more."""
        if self._session is not None and self.state == "paused":
            self._session.order("step", thread)

    def watch(self, breakpoints: frozenset[str], line_s: float) -> None:
        """Pause at these blocks, and stay so long at each, from now on."""
        self._breakpoints, self._line_s = breakpoints, line_s
        if self._session is not None and self.state != "stopping":
            self._session.watch(self._watching())

    def heard(self, told: m.ProgramState) -> None:
        """The program has told of itself: at a breakpoint it pauses without being asked."""
        if told.event == "paused" and self.state == "running":
            self._set_state("paused")
        elif told.event in ("rule_failed", "warning") and self._session is not None:
            trouble = told.line, told.fault.sentence.text
            if trouble not in self._troubles:
                self._troubles.add(trouble)
                self._tell(_trouble(told))

    def _watching(self) -> Watching:
        request = self.request
        if request is None or not request.is_watched:
            return Watching()
        if not request.is_shown:
            return Watching((), self._line_s)
        lines = {request.code.stop_at(block) for block in self._breakpoints}
        return Watching(tuple(sorted(line for line in lines if line)), self._line_s)

    def _set_state(self, state: State) -> None:
        if state != self.state:
            self.state = state
            self._tell(StateChanged(state))


def _trouble(told: m.ProgramState) -> Troubled:
    """What went wrong while the program goes on."""
    fault = told.fault
    if told.event == "rule_failed":
        problem = Problem(
            "A rule ended with an error; the others go on", fault.sentence, fault.checklist
        )
        return Troubled(problem, told.line, is_error=True)
    problem = Problem("The program goes on, but look at this", fault.sentence, fault.checklist)
    return Troubled(problem, told.line, is_error=False)


def _disk_problem(error: OSError) -> Problem:
    return Problem(
        "The program could not be written",
        text_of("The computer says: {reason}.", reason=reason_of(error)),
        (
            "Is there room on the disk?",
            "May this program write into the folder for temporary files?",
        ),
        details=str(error),
        place=error.filename or "",
    )
