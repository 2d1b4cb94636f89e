"""The link to a robot: made in a thread of its own, made anew when it breaks, told in sentences.

offline -> connecting -> ready -> lost -> connecting ...; a try that fails is followed by the next
one after a pause that grows.
"""

from __future__ import annotations

import itertools
import logging
import queue
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Literal

from nodes.action.naobody.driver import Connection
from nodes.action.naoqi.client import (
    LoginRefused,
    NaoqiError,
    NeedsTls,
    NoAnswer,
    NotNaoqi,
    Refused,
    RemoteObject,
    Session,
)
from nodes.action.naoqi.driver import told
from nodes.action.naoqi.driver.address import Address, plain_address

log = logging.getLogger(__name__)

State = Literal["offline", "connecting", "ready", "lost"]
TRY_S = 2.6
"""Who has not answered by then is told as not answering; a late answer still counts."""
FIRST_PAUSE_S = 1.0
LONGEST_PAUSE_S = 15.0


@dataclass
class Reached:
    """What a try that has succeeded brings: the session, and what was asked in its thread."""

    session: Session
    services: dict[str, RemoteObject]
    found: dict[str, Any] = field(default_factory=dict)


Connect = Callable[[Callable[[str], None]], Reached]
"""Connects and looks around; may wait. Its argument is to be called when the link is lost."""


class Link:
    """Keeps the link to one robot; ``step`` never waits."""

    def __init__(self, robot: str, address: Address, connect: Connect) -> None:
        self.robot = robot
        self.place = plain_address(address)
        self.state: State = "offline"
        self.connection = Connection("disconnected", "")
        self.reached: Reached | None = None
        self._connect = connect
        self._news: queue.SimpleQueue[tuple[int, Reached | NaoqiError | str]] = queue.SimpleQueue()
        self._numbers = itertools.count(1)
        self._try = 0
        self._try_until_s = 0.0
        self._next_s = 0.0
        self._pause_s = FIRST_PAUSE_S

    def connect(self) -> None:
        """Begin to look for the robot."""
        self.connection = Connection("connecting", f"Looking for {self.robot} at {self.place}.")
        self._begin()

    def disconnect(self) -> None:
        """Give the robot up; a try that is under way ends by itself."""
        self._drop()
        self.state = "offline"
        self.connection = Connection("disconnected", "")

    def step(self) -> Reached | None:
        """Take in what has happened; return the link when it has just been made."""
        while not self._news.empty():
            number, what = self._news.get()
            if number != self._try:  # an older try: what it brings is not wanted any more
                _close(what)
            elif isinstance(what, Reached):
                return self._arrive(what)
            elif isinstance(what, NaoqiError):
                self._fail(*self._told(what))
            else:
                self.lose(*told.lost(self.robot, self.place))
        now_s = time.monotonic()
        if self.state == "connecting" and now_s > self._try_until_s:
            self._try_until_s = float("inf")
            self.connection = self._failed(*told.no_answer(self.robot, self.place))
        elif self.state == "lost" and now_s >= self._next_s:
            self._begin()
        return None

    def lose(self, sentence: str, steps: told.Steps) -> None:
        """The link is gone, or no use any more; look for the robot again soon."""
        self._drop()
        self.connection = told.connection("disconnected", (sentence, steps))
        self._pause_s = FIRST_PAUSE_S
        self._wait()

    def freeze(self) -> None:
        """Nothing comes over the link any more."""
        self.lose(*told.frozen(self.robot, self.place))

    def _begin(self) -> None:
        self.state = "connecting"
        self._try = next(self._numbers)
        self._try_until_s = time.monotonic() + TRY_S
        threading.Thread(target=self._run, args=(self._try,), daemon=True).start()

    def _run(self, number: int) -> None:
        """One try, in a thread of its own."""
        try:
            self._news.put((number, self._connect(lambda why: self._news.put((number, why)))))
        except NaoqiError as problem:
            self._news.put((number, problem))
        except Exception as error:  # a fault of this program must not end the tries
            log.exception("connecting to %s", self.robot)
            self._news.put((number, NaoqiError(str(error))))

    def _arrive(self, reached: Reached) -> Reached:
        self.state, self.reached = "ready", reached
        self._pause_s = FIRST_PAUSE_S
        return reached

    def _fail(self, sentence: str, steps: told.Steps) -> None:
        self.connection = self._failed(sentence, steps)
        self._wait()

    def _wait(self) -> None:
        self.state = "lost"
        self._next_s = time.monotonic() + self._pause_s
        self._pause_s = min(2.0 * self._pause_s, LONGEST_PAUSE_S)

    def _drop(self) -> None:
        self._try = next(self._numbers)
        if self.reached is not None:
            _close(self.reached)
        self.reached = None

    def _failed(self, sentence: str, steps: told.Steps) -> Connection:
        return told.connection("connection_failed", (sentence, steps))

    def _told(self, problem: NaoqiError) -> tuple[str, told.Steps]:
        match problem:
            case NotNaoqi():
                return told.not_naoqi(self.robot, self.place)
            case LoginRefused():
                return told.login_refused(self.robot, self.place)
            case NeedsTls():
                return told.needs_tls(self.robot, self.place)
            case NoAnswer() | Refused():
                return told.no_answer(self.robot, self.place)
        sentence, steps = told.no_answer(self.robot, self.place)
        return problem.sentence or sentence, problem.checklist or steps


def _close(what: object) -> None:
    """Close a session without waiting for it."""
    if isinstance(what, Reached):
        threading.Thread(target=what.session.close, daemon=True).start()
