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


class Schedule:
    """Commands on different limbs run together, on the same limb by priority, then by time."""

    def __init__(self) -> None:
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
            self._running.pop(command_id, None)
        self._waiting = [command for command in self._waiting if command.id not in ended]

    def _ready(self) -> Iterator[Command]:
        taken: set[Limb] = set()
        for command in self._running.values():
            taken |= command.limbs
        for command in self._waiting:
            if not taken & command.limbs:
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
