"""``nep-studio run FILE.nep``: a project without a window; what happens is printed."""

from __future__ import annotations

import argparse
import logging
import sys
import tempfile
import threading
import time
from dataclasses import replace
from pathlib import Path

import msgspec

from nep_core.cli.console import seconds
from nep_core.errors import NepError
from nep_studio.blocks import text
from nep_studio.blocks.deployment import robot_entries
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.problems import on_one_line
from nep_studio.run.plan import Choices, PlannedNode, plan
from nep_studio.run.session import Ending, Session
from nep_studio.run.signals import interrupt_once
from nep_studio.run.timeline import Timeline

from .project import UNUSABLE, explain, print_utf8, read_project, speed, tell_errors

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
        self._lock = threading.Lock()
        self._started_s = time.monotonic()

    def title(self, project: Project, nodes: list[PlannedNode]) -> None:
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
        """Print a message; safe from any thread."""
        with self._lock:
            if self._as_json:
                told = {"topic": topic, **msgspec.structs.asdict(message)}
                print_utf8(msgspec.json.encode(told).decode() + "\n")
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


def main(arguments: list[str]) -> int:
    """Play a project; 0 when it ended well, 1 when it failed, 2 when it cannot be used."""
    options = _parser().parse_args(arguments)
    logging.basicConfig(level=logging.ERROR, format="%(message)s")
    interrupt_once()
    try:
        project, language = read_project(options.file)
        folder = Path(options.file).resolve().parent
        if tell_errors(project, language, folder):
            return UNUSABLE
        code = generate_program(project, language)
        robots = [entry.name for entry in robot_entries(project, language)]
        nodes = plan(project, language, _choices(options, robots), folder)
    except (BlocksError, NepError) as error:
        explain(error)
        return UNUSABLE
    printer = Printer(language, as_json=options.json)
    printer.title(project, nodes)
    try:
        ending = _play(code, nodes, printer, options.seconds)
    except NepError as error:
        explain(error)
        return FAILED
    printer.end()
    if ending.problem is None:
        return 0
    place = _place(ending, code, project, language)
    print(replace(ending.problem, place=place), file=sys.stderr)
    return FAILED


def _play(code: Code, nodes: list[PlannedNode], printer: Printer, most_s: float | None) -> Ending:
    """Play until the end, Ctrl-C, or until nobody reads any more, which raises OSError."""
    unheard: list[OSError] = []

    def hear(topic: str, message: msgspec.Struct) -> None:
        try:
            printer.hear(topic, message)
        except OSError as error:
            unheard.append(error)
            session.end()

    with tempfile.TemporaryDirectory(prefix="nep-") as folder:
        program = Path(folder) / "program.py"
        program.write_text(code.text, encoding="utf-8")
        session = Session(program, nodes, hear)
        try:
            with session:
                if session.network.shared_master:
                    printer.joined(session.network.shared_master)
                ending = session.wait(most_s)
        except KeyboardInterrupt:
            ending = Ending()
    if unheard:
        raise unheard[0]
    return ending


def _place(ending: Ending, code: Code, project: Project, language: Language) -> str:
    block = code.block_at(ending.line)
    if block is None:
        return ""
    return f"“{text.sentence(project, language, block)}” (line {ending.line} of the Python)"


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
    return Choices(recording, options.speed, addresses)


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
        "--robot",
        action="append",
        default=[],
        metavar="NAME=ADDRESS",
        help="where a real robot is; may be given for several",
    )
    return parser
