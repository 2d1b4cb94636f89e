"""Which commands the palette shows for what is typed, in which order."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from .commands import Command
from .matching import match

MOST_SHOWN = 200
RECENT_WORTH = 8.0
"""What a command that was used last is worth more than one that was not."""


@dataclass(frozen=True)
class Ranked:
    """A command that fits, with the letters of its words that were typed."""

    command: Command
    letters: tuple[int, ...] = ()
    is_recent: bool = False


def ranked(commands: Iterable[Command], typed: str, recent: Sequence[str]) -> list[Ranked]:
    """The commands that fit, the best first; with nothing typed, those that were used last first.

    ``recent`` are the ids of commands that were used, the last one first.
    """
    places = {one: number for number, one in enumerate(recent)}
    found: list[tuple[float, float, int, Ranked]] = []
    for number, command in enumerate(_once(commands)):
        fit = match(typed, command.words, f"{command.kind} {command.also}")
        if fit is None:
            continue
        place = places.get(command.id)
        bonus = RECENT_WORTH / (1 + place) if place is not None else 0.0
        score = fit.score + bonus if typed.strip() else bonus
        one = Ranked(command, fit.letters, place is not None and not typed.strip())
        found.append((-score, bool(command.why_not), number, one))
    found.sort(key=lambda entry: entry[:3])
    return [one for *_, one in found[:MOST_SHOWN]]


def _once(commands: Iterable[Command]) -> Iterable[Command]:
    """Each command once, as it was given first."""
    first: dict[str, Command] = {}
    for command in commands:
        first.setdefault(command.id, command)
    return first.values()
