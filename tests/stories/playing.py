"""Plays a project as a user would, ``nep-studio run FILE --json``, and listens."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

Event = dict[str, Any]
WAIT_S = 60.0
SPEED = 4
"""How fast the virtual watch and robot of a story live: what they do is the same, only sooner."""


class Play:
    """A running project and all that it has said."""

    def __init__(self, *words: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "nep_studio", "run", *words, "--json"],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.events: list[Event] = []
        self.pids: dict[str, int] = {}
        self._coming: queue.Queue[Event | None] = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def wait_for(self, is_it: Callable[[Event], bool], timeout_s: float = WAIT_S) -> Event:
        """The next event of this kind; fails with all that was said when it does not come."""
        while (event := self._coming.get(timeout=timeout_s)) is not None:
            self._note(event)
            if is_it(event):
                return event
        raise AssertionError("\n".join([*map(str, self.events), self.errors()]))

    def find(self, is_it: Callable[[Event], bool]) -> Event:
        """The first event of this kind, heard already or to come: some come apart."""
        heard = next((event for event in self.events if is_it(event)), None)
        return heard or self.wait_for(is_it)

    def finish(self, timeout_s: float = WAIT_S) -> int:
        """Wait for the end; the exit code."""
        code = self.process.wait(timeout_s)
        while (event := self._coming.get(timeout=timeout_s)) is not None:
            self._note(event)
        return code

    def interrupt(self) -> None:
        """End it as Ctrl-C does."""
        self.process.send_signal(signal.SIGINT)

    def errors(self) -> str:
        """What it wrote to its error output; after the end."""
        return self.process.stderr.read() if self.process.stderr else ""

    def said(self, robot: str = "NAO") -> list[str]:
        """The sentences that the robot began to say, in their order."""
        requests = {e["id"]: e for e in self.events if e["topic"] == "/action_request"}
        sentences: dict[str, str] = {}
        for event in self.events:
            if event["topic"] == "/action_result" and event["state"] == "started":
                request = requests.get(event["id"])
                if request and event["robot"] == robot and request["action"] == "say":
                    sentences[event["id"]] = request["args"]["text"]
        return list(sentences.values())

    def rules(self) -> list[str]:
        """The rules that fired, in their order."""
        return [e["rule"] for e in self.events if e.get("event") == "rule_started"]

    def _note(self, event: Event) -> None:
        self.events.append(event)
        if event["topic"] == "/node_state":
            self.pids[event["node"]] = event["pid"]

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._coming.put(json.loads(line))
        self._coming.put(None)


@contextlib.contextmanager
def playing(*words: str | Path | float) -> Iterator[Play]:
    """A play that is stopped, as by Ctrl-C, if it still runs at the end."""
    play = Play(*map(str, words))
    try:
        yield play
    finally:
        if play.process.poll() is None:
            play.interrupt()
            play.process.wait(20)
        for stream in (play.process.stdout, play.process.stderr):
            if stream:
                stream.close()


def node_is(node: str, event: str) -> Callable[[Event], bool]:
    """Whether an event is this state of this node."""
    return lambda e: e["topic"] == "/node_state" and e["node"] == node and e["event"] == event


def says(text: str) -> Callable[[Event], bool]:
    """Whether an event is the request to say something."""
    return lambda e: e["topic"] == "/action_request" and e["args"].get("text") == text


def result_of(request: Event, state: str) -> Callable[[Event], bool]:
    """Whether an event is this result of a request."""
    return lambda e: (
        e["topic"] == "/action_result" and (e["id"], e["state"]) == (request["id"], state)
    )


def kill(pid: int) -> None:
    """Kill a process as nothing else does."""
    os.kill(pid, signal.SIGKILL)
