"""What ``nep-studio run`` prints while a project plays."""

from __future__ import annotations

import threading
import time

import msgspec

from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.commands.project import print_utf8
from nep_studio.plan import PlannedNode
from nep_studio.problems import on_one_line
from nep_studio.timeline import Timeline


class Printer:
    """Prints messages as they come: a timeline for people, or JSON for programs.

    A JSON line is one message, in UTF-8: ``{"topic": "/node_state", "node": "NAO", "event":
    "ready", ...}``, the topic and then every key of the topic's struct in nep_core/messages.py,
    those with their default value too. Printing raises OSError when nobody reads any more.
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
