"""Who drives a robot, and how it was found: both are kept in the robot's own memory.

NAOqi lets every program move a robot at any time. Our programs agree by a lease: a key of the
robot's ALMemory with the owner's name, computer, time, and a beat that changes while the owner
lives. Who comes second waits until the beat has stood still for a while, or was told to take the
robot over; the first reads that at its next beat, and lets go. No clock is compared with another
computer's. What is found at a robot that nobody drives is kept beside the lease, so that it is
known also after the driver has crashed.
"""

from __future__ import annotations

import contextlib
import getpass
import logging
import socket
import time
import uuid
from collections.abc import Generator
from functools import partial
from typing import Any, Literal

import msgspec

from faults import Fault, Text, fault_of
from robots.body.schedule import Task, is_over
from robots.errors import ActionFailed
from robots.naoqi.wire.errors import CallFailed, NaoqiError

from .calls import ANSWER_S, waited
from .moving import WAKING_S, rest
from .real import LIFE_OFF, RealRobot

log = logging.getLogger(__name__)

MEMORY = "ALMemory"
DRIVER_KEY = "NEP_Studio/Driver"
FOUND_KEY = "NEP_Studio/Found"

BEAT_S = 0.5
"""So often an owner shows that it lives."""
DEAD_S = 3.0
"""An owner whose beat has stood still for so long is gone."""
SURE_S = 2.0
"""Who has not read for so long that the lease is its own asks again before it acts."""
SETTLING_S = 0.4
"""Of several that write a lease at once the last one has it: so long each waits before it looks."""
TAKING_S = 1.2
"""The same for one that takes a robot over: by then who drove it has read that, and ended all."""
LONGEST_NAME = 60
CANNOT_READ = (ValueError, TypeError, RecursionError, OverflowError)
"""What reading a robot's memory can raise: anybody may have written there."""

USUAL_LIFE = "solitary"
"""NAOqi's word for a robot that does by itself what it wants."""

LeaseState = Literal["asking", "waiting", "held", "taken"]


class Owner(msgspec.Struct, frozen=True, kw_only=True):
    """Who drives a robot; ``beat`` changes as long as it lives, ``time`` is its own clock's."""

    id: str
    name: str = ""
    host: str = ""
    beat: int = 0
    time: float = 0.0

    @property
    def told(self) -> Text:
        """The owner in words."""
        name, host = self.name[:LONGEST_NAME], self.host[:LONGEST_NAME]
        return Text("{name} on {host}", {"name": name or "?", "host": host or "?"})


class Found(msgspec.Struct, frozen=True, kw_only=True):
    """How a robot was before anybody drove it: its own life's state ("": none), and awake."""

    life: str = ""
    awake: bool = True


def this_owner() -> Owner:
    """Return an owner with the names of the person and the computer here."""
    name = ""
    with contextlib.suppress(Exception):  # each system has errors of its own for "nobody"
        name = getpass.getuser()
    return Owner(id=uuid.uuid4().hex, name=name, host=socket.gethostname())


driven = partial(
    fault_of,
    "{robot} is driven by {owner}. Two programs at one robot would throw it over.",
    code="driven",
    checklist=(
        "Wait until {owner} has ended the program: this one looks again by itself.",
        "Try the program on the robot on your screen meanwhile.",
        "To take {robot} over now, put its node on the Nodes page, with take_over switched on.",
    ),
)
"""Somebody else drives the robot."""

taken_over = partial(
    fault_of,
    "{owner} has taken {robot} over: this program does not drive it any more.",
    code="taken_over",
    checklist=(
        "Ask {owner} when the robot is free again.",
        "Run the program again when they have ended theirs.",
    ),
)
"""Somebody else drives the robot now."""

left_on = partial(
    fault_of,
    "{robot}'s motors are still on, as they were when the program met it.",
    code="left_on",
    checklist=(
        "Let {robot} rest before you leave it: press its chest button twice.",
        'Or put the block "{robot} rests" at the end of the program.',
    ),
)
"""The program has ended and leaves a robot that holds itself."""


class Lease:
    """The lease of one robot for this driver; ``step`` never waits.

    ``takes_over``: a robot that somebody else drives is taken from them. ``other`` is who else
    drives it, ``found`` how it was when nobody had driven it yet, ``has_followed``: whether another
    had it before who has not ended in good order, so that the robot may still do what that asked.
    """

    def __init__(
        self, robot: RealRobot, own: Owner, *, takes_over: bool = False, is_taken: Owner | None
    ) -> None:
        self.other: Owner | None = is_taken
        self.state: LeaseState = "asking" if is_taken is None else "taken"
        self.found: Found | None = None
        self.has_followed = False
        self._robot = robot
        self._own = own
        self._takes_over = takes_over
        self._keeps = True
        """Whether the robot's memory can be read and written: by it all is agreed."""
        self._read_s = 0.0
        self._task: Task | None = None if is_taken else self._run()

    @property
    def is_held(self) -> bool:
        """Whether this driver may move the robot: it is sure that it still has the lease."""
        return self.state == "held" and time.monotonic() - self._read_s < SURE_S

    def step(self) -> None:
        """Go on asking for the lease, or renewing it."""
        if self._task is None:
            return
        try:
            next(self._task)
        except StopIteration:
            self._task = None
        except (ActionFailed, NaoqiError) as problem:
            log.info("the lease of %s: %s", self._robot.name, problem)
            self._task = self._run()

    def fault(self) -> Fault | None:
        """What a person should know of who drives the robot, None when this program does."""
        if self.other is None or self.state not in ("waiting", "taken"):
            return None
        kind = driven if self.state == "waiting" else taken_over
        return kind(robot=self._robot.name, owner=self.other.told)

    def leave(self) -> Task:
        """Leave the robot as it was found, then let others have it."""
        with contextlib.suppress(ActionFailed, NaoqiError):
            yield from self._look_who()
        restoring = self._restore()
        try:
            while self.state == "held" and not is_over(restoring):
                self.step()  # it is this driver's until it is as it was
                yield
        except ActionFailed as problem:
            log.info("%s could not be left as it was found: %s", self._robot.name, problem)
        finally:
            restoring.close()
        self._task = None
        with contextlib.suppress(ActionFailed, NaoqiError):
            yield from self._look_who()
            if self.state == "held":
                yield from self._write(FOUND_KEY, "")
                yield from self._write(DRIVER_KEY, "")
        return ""

    @property
    def leaves_on(self) -> bool:
        """Whether the robot is left with its motors on, and nobody to look after that."""
        robot = self._robot
        is_alive = self.found is not None and self.found.life not in ("", LIFE_OFF)
        return not robot.known.released >= set(robot.parts) and not is_alive

    def _restore(self) -> Task:
        found, robot = self.found, self._robot
        if found is None:
            return ""
        now = yield from self._look()
        if now.awake and not found.awake:
            yield from rest(robot)  # which switches its own life off
            now = yield from self._look()
        if now.life == LIFE_OFF and found.life not in ("", LIFE_OFF):
            yield from self._revive(found.life)
        return ""

    def _revive(self, life: str) -> Task:
        """Let the robot live by itself, as it did; not from each state it may go to each other."""
        for state in dict.fromkeys((life, USUAL_LIFE)):
            try:
                yield from self._robot.call("ALAutonomousLife", "setState", state, limit_s=WAKING_S)
                return ""
            except ActionFailed as problem:
                log.info("%s does not become %s: %s", self._robot.name, state, problem)
        return ""

    def _run(self) -> Task:
        """Get the lease, and renew it until somebody else has it."""
        if not all(self._robot.calls.has(MEMORY, one) for one in ("getData", "insertData")):
            self._keeps = False
        if self.state != "held" and self._keeps:
            yield from self._claim()
        self.found = self.found or (yield from self._remember())
        self.other, self.state = None, "held"
        return (yield from self._renew())

    def _renew(self) -> Task:
        """Show that this driver lives, until somebody else has the lease."""
        while True:
            asked_s = time.monotonic()
            yield from self._look_who()
            if self.state == "taken":
                return ""
            if time.monotonic() - asked_s > SURE_S:
                continue  # this process may have stood still: what was read is not true any more
            self._read_s = time.monotonic()
            yield from self._beat()
            yield from waited(BEAT_S)

    def _look_who(self) -> Task:
        """See whether somebody else has taken the robot."""
        told = (yield from self._read()) if self._keeps else None
        if told is not None and told.id != self._own.id:
            self.other, self.state = told, "taken"
        return ""

    def _claim(self) -> Task:
        """Wait until nobody has the lease, or take it; then have it."""
        first = ""  # from whom alone it is taken: of several who do so at once the last one has it
        while True:
            settling_s = SETTLING_S
            told = yield from self._read()
            if told is not None and told.id != self._own.id:
                self.has_followed = True
                first = first or told.id
                if self._takes_over and told.id == first:
                    settling_s = TAKING_S
                else:
                    yield from self._await_end_of(told)
            yield from self._beat()
            if not self._keeps:
                return ""
            yield from waited(settling_s)
            told = yield from self._read()
            if told is not None and told.id == self._own.id:
                self._read_s = time.monotonic()
                return ""

    def _await_end_of(self, first: Owner) -> Task:
        """Wait until an owner has ended or is gone; say who it is once it has shown that it lives.

        One that has just crashed is not told of: its lease ends before a person could ask it.
        """
        told: Owner | None = first
        seen, since_s = (first.id, first.beat), time.monotonic()
        while told is not None and time.monotonic() - since_s < DEAD_S:
            yield from waited(BEAT_S / 2.0)
            told = yield from self._read()
            if told is not None and (told.id, told.beat) != seen:
                seen, since_s = (told.id, told.beat), time.monotonic()
                self.other, self.state = told, "waiting"
        self.has_followed = told is not None
        self.other, self.state = None, "asking"
        return ""

    def _beat(self) -> Task:
        own = self._own
        self._own = msgspec.structs.replace(own, beat=own.beat + 1, time=round(time.time(), 3))
        return (yield from self._write(DRIVER_KEY, msgspec.json.encode(self._own).decode()))

    def _remember(self) -> Generator[None, None, Found]:
        """Return how the robot was found: by us, or by who has not ended in good order."""
        text = (yield from self._data(FOUND_KEY)) if self._keeps else ""
        with contextlib.suppress(*CANNOT_READ):
            return msgspec.json.decode(text, type=Found)
        found = yield from self._look()
        yield from self._write(FOUND_KEY, msgspec.json.encode(found).decode())
        return found

    def _look(self) -> Generator[None, None, Found]:
        robot, life, awake = self._robot, "", True
        if robot.calls.has("ALAutonomousLife", "getState"):
            life = str((yield from robot.call("ALAutonomousLife", "getState")))
        if robot.calls.has("ALMotion", "robotIsWakeUp"):
            awake = bool((yield from robot.call("ALMotion", "robotIsWakeUp")))
        return Found(life=life, awake=awake)

    def _read(self) -> Generator[None, None, Owner | None]:
        """Return who has the lease; None when nobody has, or what is there is no lease."""
        text = yield from self._data(DRIVER_KEY)
        with contextlib.suppress(*CANNOT_READ):
            return msgspec.json.decode(text, type=Owner)
        return None

    def _data(self, key: str) -> Generator[None, None, Any]:
        """Return what is kept under a key, "" when there is none. Raises NaoqiError."""
        try:
            return (yield from self._asked("getData", key))
        except CallFailed:  # which is NAOqi's answer for a key that nobody has written
            return ""

    def _write(self, key: str, text: str) -> Task:
        """Keep something; a memory that refuses it is not asked again. Raises NaoqiError."""
        try:
            if self._keeps:
                yield from self._asked("insertData", key, text)
        except CallFailed as problem:
            log.warning("nobody can be told who drives %s: %s", self._robot.name, problem)
            self._keeps = False
        return ""

    def _asked(self, method: str, *args: str) -> Generator[None, None, Any]:
        pending = self._robot.calls.begin(MEMORY, method, *args)
        end_s = time.monotonic() + ANSWER_S
        while not pending.done and time.monotonic() < end_s:
            yield
        return pending.result(0.0)
