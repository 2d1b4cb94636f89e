"""``nep-studio run FILE.nep``: a project without a window; what happens is printed."""

from __future__ import annotations

import argparse
import logging
import os
import signal
import sys
import tempfile
import threading
import time
from pathlib import Path

import msgspec

from nep_core.errors import NepError, ParameterError
from nep_studio.blocks import text
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.commands.check import tell_errors
from nep_studio.commands.project import UNUSABLE, explain, read_project
from nep_studio.plan import Choices, PlannedNode, plan
from nep_studio.session import Ending, Session
from nep_studio.timeline import Timeline

FAILED = 1


def main(arguments: list[str]) -> int:
    """Play a project; 0 when it ended well, 1 when it failed, 2 when it cannot be used."""
    options = _parser().parse_args(arguments)
    logging.basicConfig(level=logging.ERROR, format="%(message)s")
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # as Ctrl-C: stop everything
    try:
        project, language = read_project(options.file)
        if tell_errors(project, language):
            return UNUSABLE
        code = generate_program(project, language)
        nodes = plan(project, language, _choices(options), Path(options.file).resolve().parent)
    except (BlocksError, NepError) as error:
        explain(error)
        return UNUSABLE
    printer = _Printer(language, as_json=options.json)
    printer.title(project, nodes)
    try:
        ending = _play(code, nodes, printer, options.seconds)
    except NepError as error:
        explain(error)
        return FAILED
    return _tell_ending(ending, code, project, language, printer)


def _play(code: Code, nodes: list[PlannedNode], printer: _Printer, seconds: float | None) -> Ending:
    with tempfile.TemporaryDirectory(prefix="nep-") as folder:
        program = Path(folder) / "program.py"
        program.write_text(code.text, encoding="utf-8")
        try:
            with Session(program, nodes, printer.hear) as session:
                return session.wait(seconds)
        except KeyboardInterrupt:
            return Ending()


def _tell_ending(
    ending: Ending, code: Code, project: Project, language: Language, printer: _Printer
) -> int:
    printer.end()
    if not ending.failed:
        return 0
    place = ""
    block = code.block_at(ending.line)
    if block is not None:
        words = text.sentence(project, language, block)
        place = f"\n  at “{words}” (line {ending.line} of the Python)"
    print(f"The program stopped with an error\n{ending.sentence}{place}", file=sys.stderr)
    for step in ending.checklist:
        print(f"  [ ] {step}", file=sys.stderr)
    return FAILED


class _Printer:
    """Prints messages as they come: a timeline for people, or one JSON object a line."""

    def __init__(self, language: Language, *, as_json: bool) -> None:
        self._timeline = Timeline(language)
        self._as_json = as_json
        self._lock = threading.Lock()
        self._started_s = time.monotonic()

    def title(self, project: Project, nodes: list[PlannedNode]) -> None:
        """Say what is played, and which nodes were added."""
        if self._as_json:
            return
        print(f"{project.name}. Ctrl-C stops it.\n")
        for node in nodes:
            if node.reason:
                print(f"   added  {node.name} ({node.node}): {node.reason}")

    def hear(self, topic: str, message: msgspec.Struct) -> None:
        """Print a message."""
        if self._as_json:
            self._write(msgspec.json.encode({"topic": topic, **msgspec.structs.asdict(message)}))
            return
        line = self._timeline.line(message)
        if line is not None:
            who, what = line
            elapsed_s = time.monotonic() - self._started_s
            self._write(f"{elapsed_s:8.2f}  {who:<16} {what}".encode())

    def end(self) -> None:
        """Say that everything is stopped."""
        if not self._as_json:
            print(f"\nEverything is stopped after {time.monotonic() - self._started_s:.1f} s.")

    def _write(self, line: bytes) -> None:
        with self._lock:
            try:
                print(line.decode(), flush=True)
            except BrokenPipeError:  # whoever read us has gone: stop, as for Ctrl-C
                os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
                signal.raise_signal(signal.SIGINT)


def _choices(options: argparse.Namespace) -> Choices:
    addresses = {}
    for word in options.robot:
        name, _, address = word.partition("=")
        if not name or not address:
            raise ParameterError(
                f'"{word}" does not say where a robot is.',
                checklist=("Write --robot NAO=192.168.1.10",),
            )
        addresses[name] = address
    recording = Path(options.recording).resolve() if options.recording else None
    return Choices(recording, options.speed, addresses)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="nep-studio run",
        description="Play a project without a window, on the virtual robot unless it names others.",
    )
    parser.add_argument("file", metavar="FILE.nep")
    parser.add_argument("--seconds", type=float, metavar="N", help="stop after so long")
    parser.add_argument("--recording", metavar="CSV", help="play this instead of the sensors")
    parser.add_argument("--speed", type=float, default=1.0, help="how fast to play the recording")
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    parser.add_argument(
        "--robot",
        action="append",
        default=[],
        metavar="NAME=ADDRESS",
        help="where a real robot is; may be given for several",
    )
    return parser
