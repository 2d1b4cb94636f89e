"""``nep-studio run FILE.nep``: a project without a window; what happens is printed."""

from __future__ import annotations

import argparse
import contextlib
import logging
import queue
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from pathlib import Path

import msgspec

from nep_core.cli.console import seconds, visible
from nep_core.errors import NepError
from nep_core.processes.node import STOP_SIGNALS
from nep_core.program.kept import SUFFIX
from nep_core.wire.messages import ProgramState
from nep_studio.blocks import text
from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.blocks.deployment import robot_entries
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.problems import Problem, on_one_line
from nep_studio.project.trust import Concern
from nep_studio.run.controller import (
    PREPARING,
    Begun,
    Checked,
    Ended,
    Event,
    NeedsApproval,
    Refused,
    RunController,
    StateChanged,
    Subject,
)
from nep_studio.run.gate import NotApproved, concerns_of, listing
from nep_studio.run.local_network import LocalNetwork
from nep_studio.run.plan import Choices, Ending, PlannedNode
from nep_studio.run.timeline import Timeline

from .project import UNUSABLE, describe, explain, print_utf8, read_project, speed

# What ``nep-studio run`` prints while a project plays.


class Printer:
    """Prints messages as they come: a timeline for people, or JSON for programs.

    A JSON line is one message, in UTF-8: ``{"topic": "/node_state", "node": "NAO", "event":
    "ready", ...}``, the topic and then every key of the topic's struct in
    nep_core/wire/messages.py, those with their default value too. Printing raises OSError when
    nobody reads any more.
    """

    def __init__(self, language: Language, *, as_json: bool) -> None:
        self._timeline = Timeline(language)
        self._as_json = as_json
        self._started_s = time.monotonic()

    def title(self, project: Project, nodes: Iterable[PlannedNode]) -> None:
        """Say what is played, and which nodes were added."""
        self._tell(f"{project.name}. Ctrl-C stops it.")
        self._tell("")
        for node in nodes:
            if node.reason:
                self._tell(f"   added  {node.name} ({node.node}): {node.reason}")

    def joined(self, master: str) -> None:
        """Say that the project takes part in a network that was there before."""
        self._tell(f"   joined the network of the NEP master at {master}")

    def hear(self, topic: str, message: msgspec.Struct) -> None:
        """Print a message."""
        if self._as_json:
            told = {"topic": topic, **msgspec.structs.asdict(message)}
            print_utf8(visible(msgspec.json.encode(told).decode()) + "\n")
            return
        elapsed_s = time.monotonic() - self._started_s
        for who, what in self._timeline.lines(message):
            self._tell(f"{elapsed_s:8.2f}  {who:<16} {what}")

    def end(self) -> None:
        """Say that everything is stopped."""
        self._tell("")
        self._tell(f"Everything is stopped after {time.monotonic() - self._started_s:.1f} s.")

    def _tell(self, line: str) -> None:
        if not self._as_json:
            print(on_one_line(line), flush=True)


FAILED = 1
NOT_APPROVED = 3
"""The exit code where a project brings what nobody has approved."""
LOOK_S = 0.2
"""How long Python may wait at once: a signal can miss a wait that is just beginning."""


def main(arguments: list[str]) -> int:
    """Play a project; 0 when it ended well, 1 when it failed, 2 when it cannot be used.

    3 when it brings what is not blocks, and nobody has approved that.
    """
    options = _parser().parse_args(arguments)
    logging.basicConfig(level=logging.ERROR, format="%(message)s")
    try:
        project, language = read_project(options.file)
        robots = [entry.name for entry in robot_entries(project, language)]
        choices = _choices(options, robots)
    except (BlocksError, NepError) as error:
        explain(error)
        return UNUSABLE
    file = Path(options.file).resolve()
    subject = Subject(project, language, file.parent, choices, file.with_suffix(SUFFIX))
    play = _Play(subject, Printer(language, as_json=options.json), options.seconds)
    if options.trust:
        play.trust()
    return play.play()


class _Play:
    """One run of a project: all that is to be done is done in turn, in the thread of ``play``."""

    def __init__(self, subject: Subject, printer: Printer, most_s: float | None) -> None:
        self._subject, self._printer, self._most_s = subject, printer, most_s
        self._turns: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._network = LocalNetwork()
        self._network.listen(lambda *heard: self._turns.put(partial(self._hear, *heard)))
        self._controller = RunController(
            lambda: self._network, lambda: subject, self._turns.put, self._on_event, is_traced=False
        )
        self._exit_code = 0
        self._failed_rule: ProgramState | None = None
        self._problem: Problem | None = None

    def trust(self) -> None:
        """Let all run that the project brings now, this once."""
        project, language = self._subject.project, self._subject.language
        found = concerns_of(project, language, self._subject.folder)
        self._network.gate.vouch(concern.key for concern in found)

    def play(self) -> int:
        """Play until the end or Ctrl-C; the exit code. Raises OSError when nobody reads."""
        for number in STOP_SIGNALS:
            signal.signal(number, lambda *_: self._turns.put(self._controller.stop))
        try:
            self._controller.run()
            while self._controller.state != "idle":
                if self._controller.state in PREPARING:
                    self._controller.work(LOOK_S)
                with contextlib.suppress(queue.Empty):
                    self._turns.get(timeout=LOOK_S)()
        finally:
            self._controller.close()
            self._network.close()
        if self._exit_code not in (UNUSABLE, NOT_APPROVED):
            self._printer.end()
            if self._failed_rule is not None and self._problem is None:
                self._exit_code = FAILED
                fault, line = self._failed_rule.fault, self._failed_rule.line
                problem = Problem(
                    "A rule failed while others went on", fault.sentence, fault.checklist
                )
                self._problem = self._placed(Ending(problem, line))
        if self._problem is not None:
            print(self._problem, file=sys.stderr)
        return self._exit_code

    def _hear(self, topic: str, message: msgspec.Struct) -> None:
        if isinstance(message, ProgramState) and message.event == "rule_failed":
            self._failed_rule = self._failed_rule or message
        self._printer.hear(topic, message)

    def _on_event(self, event: Event) -> None:
        match event:
            case Checked(problems, can_run=False):
                self._refuse(problems)
            case Refused(error):
                explain(error)
                self._exit_code = UNUSABLE
            case NeedsApproval(concerns=concerns):
                self._ask_for(concerns)
            case Begun(request):
                self._printer.title(self._subject.project, request.nodes)
            case StateChanged("running"):
                self._on_running()
            case Ended(ending):
                self._exit_code = 0 if ending.problem is None else FAILED
                self._problem = self._placed(ending)

    def _refuse(self, problems: list[Diagnostic]) -> None:
        project, language = self._subject.project, self._subject.language
        for problem in problems:
            if problem.severity == "error":
                print(describe(problem, project, language), file=sys.stderr)
        self._exit_code = UNUSABLE

    def _ask_for(self, concerns: list[Concern]) -> None:
        """List what nobody has approved: all of it, for it is to be read before --trust."""
        print(f"Not started. {NotApproved(concerns)}", file=sys.stderr)
        for line in listing(concerns):
            print(on_one_line(line).rstrip(), file=sys.stderr)
        print("If you trust who made it, start it with --trust.", file=sys.stderr)
        self._exit_code = NOT_APPROVED

    def _on_running(self) -> None:
        if self._network.shared_master:
            self._printer.joined(self._network.shared_master)
        if self._most_s is not None:
            timer = threading.Timer(self._most_s, self._turns.put, [self._controller.stop])
            timer.daemon = True
            timer.start()

    def _placed(self, ending: Ending) -> Problem | None:
        """The problem of an ending, with the block where it is."""
        request, subject = self._controller.request, self._subject
        block = request.code.block_at(ending.line) if request is not None else None
        if ending.problem is None or block is None:
            return ending.problem
        words = text.sentence(subject.project, subject.language, block)
        return replace(ending.problem, place=f"“{words}” (line {ending.line} of the Python)")


class CannotPlay(NepError):
    """The command asks for what this project cannot do."""

    title = "This project cannot be played like that"


def _choices(options: argparse.Namespace, robots: list[str]) -> Choices:
    addresses = {}
    for word in options.robot:
        name, _, address = word.partition("=")
        if not name or not address:
            raise CannotPlay(
                '"{word}" does not say where a robot is.',
                checklist=("Write --robot NAO=192.168.1.10",),
                word=word,
            )
        if name not in robots:
            raise CannotPlay(
                "There is no robot {name} on the Robots page.",
                checklist=("The robots there are: {robots}.",),
                name=name,
                robots=", ".join(robots) or "none",
            )
        addresses[name] = address
    recording = Path(options.recording).resolve() if options.recording is not None else None
    if recording is not None and not (options.recording and recording.exists()):
        raise CannotPlay(
            "There is no recording “{recording}”.",
            checklist=("Is the name spelled right, and is the file still there?",),
            recording=options.recording,
        )
    return Choices(recording, options.speed, addresses, by_itself=True)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="nep-studio run",
        description="Play a project without a window, on the virtual robot unless it names others.",
    )
    parser.add_argument("file", metavar="FILE.nep")
    parser.add_argument("--seconds", type=seconds, metavar="N", help="stop after so long")
    parser.add_argument("--recording", metavar="CSV", help="play this instead of the sensors")
    parser.add_argument(
        "--speed",
        type=speed,
        default=1.0,
        metavar="N",
        help="let the recording, or virtual watches, and virtual robots go N times as fast: "
        "0.1 to 50",
    )
    parser.add_argument(
        "--json",
        action="store_true",
        help="print each message as one JSON object a line: its topic, then its own keys",
    )
    parser.add_argument(
        "--trust",
        action="store_true",
        help="run its Python, its own nodes, and what uses the network, though nobody has "
        "approved them in the window; without it they are listed, and the exit code is 3",
    )
    parser.add_argument(
        "--robot",
        action="append",
        default=[],
        metavar="NAME=ADDRESS",
        help="where a real robot is; may be given for several",
    )
    return parser
