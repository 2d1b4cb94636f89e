"""Which commands run now and which wait: a limb does one thing at a time."""

from __future__ import annotations

from bisect import insort
from collections.abc import Generator, Iterator
from dataclasses import dataclass
from typing import NamedTuple

from faults import fault_of
from robots.errors import ActionFailed

from .actions import Action
from .driver import Ended
from .limbs import Limb


@dataclass(frozen=True)
class Command:
    """An action to be done, with the limbs that it needs for itself."""

    id: str
    action: Action
    limbs: frozenset[Limb]
    priority: int = 0
    by: str = ""
    """What the rule or goal that asks for it is called."""

    def yields_to(self, other: Command) -> bool:
        """Whether this makes way for another one: what listens only waits for its turn."""
        is_in_way = self.limbs & other.limbs - {Limb.EARS}
        return bool(is_in_way) and self.priority < other.priority


class Kept(NamedTuple):
    """Until when a limb is kept for what is at least so important."""

    priority: int
    until_s: float


class Schedule:
    """Commands on different limbs run together, on the same limb by priority, then by time.

    A limb is kept for ``keep_s`` seconds from what is less important than what it did last, so
    that a task of several steps is not taken turns with. ``now_s`` is what that is counted by.
    """

    def __init__(self, keep_s: float = 0.0) -> None:
        self.now_s = 0.0
        self._keep_s = keep_s
        self._kept: dict[Limb, Kept] = {}
        self._waiting: list[Command] = []
        self._running: dict[str, Command] = {}

    @property
    def running(self) -> tuple[Command, ...]:
        """The commands that have been started and have not ended."""
        return tuple(self._running.values())

    @property
    def waiting(self) -> tuple[Command, ...]:
        """The commands that wait for their limbs, the next one first."""
        return tuple(self._waiting)

    def add(self, command: Command) -> None:
        """Let a command wait: behind those of its own priority, before those of a lower one."""
        insort(self._waiting, command, key=lambda waiting: -waiting.priority)

    def start_ready(self) -> list[Command]:
        """Move the commands whose limbs are free from waiting to running, and return them."""
        ready = list(self._ready())
        for command in ready:
            self._waiting.remove(command)
            self._running[command.id] = command
        return ready

    def end(self, *command_ids: str) -> None:
        """Forget commands, running or waiting; their limbs are free."""
        ended = set(command_ids)
        for command_id in ended:
            if (command := self._running.pop(command_id, None)) is not None:
                self._keep(command)
        self._waiting = [command for command in self._waiting if command.id not in ended]

    def free(self) -> None:
        """Keep no limb any longer."""
        self._kept.clear()

    def displaced(self) -> dict[str, Command]:
        """The running commands that are to make way, by id, each with the one that it is for.

        None makes way for a command that would have to wait for its other limbs all the same.
        """
        making_way: dict[str, Command] = {}
        reserved: set[Limb] = set()
        for command in self._waiting:
            in_way = [one for one in self._running.values() if one.limbs & command.limbs]
            if not reserved & command.limbs and all(one.yields_to(command) for one in in_way):
                making_way |= {one.id: command for one in in_way if one.id not in making_way}
            reserved |= command.limbs
        return making_way

    def _keep(self, command: Command) -> None:
        for limb in command.limbs:
            known = self._kept.get(limb)
            if known is None or known.until_s <= self.now_s or known.priority <= command.priority:
                self._kept[limb] = Kept(command.priority, self.now_s + self._keep_s)

    def _is_kept_from(self, command: Command) -> bool:
        kept = (self._kept[limb] for limb in command.limbs if limb in self._kept)
        return any(one.until_s > self.now_s and one.priority > command.priority for one in kept)

    def _ready(self) -> Iterator[Command]:
        taken: set[Limb] = set()
        for command in self._running.values():
            taken |= command.limbs
        for command in self._waiting:
            if not taken & command.limbs and not self._is_kept_from(command):
                yield command
            # A waiting command keeps its place: a later one may not take its limbs meanwhile.
            taken |= command.limbs


# What a robot does at the moment: tasks by the command that asked for them.

Task = Generator[None, None, str]
"""Goes on by one step at each ``next``; returns what there is to say at its end."""


class Running(NamedTuple):
    """A task that has begun, and the limbs that it uses."""

    task: Task
    limbs: frozenset[Limb]


def advance(running: dict[str, Running], command_id: str) -> Ended | None:
    """Let a task go on by one step; one that has ended or failed is taken out, and told."""
    try:
        next(running[command_id].task)
    except StopIteration as end:
        ended = Ended(command_id, "done", fault_of(end.value or ""))
    except ActionFailed as problem:
        ended = Ended(command_id, "failed", problem.fault)
    else:
        return None
    del running[command_id]
    return ended


def is_over(task: Task) -> bool:
    """Advance a task by one step, and return whether that was its end."""
    try:
        next(task)
    except StopIteration:
        return True
    return False
