"""Who was not let in to an opened network, from what the master, the nodes and the door tell."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

RefusalKind = Literal["stranger", "own_program", "unable", "wrong_code", "code_used_up"]

MOST = 20

_TOLD: tuple[tuple[RefusalKind, re.Pattern[str]], ...] = (
    ("stranger", re.compile(r"A program at (?P<places>.+?) showed no key of this network")),
    ("own_program", re.compile(r"A program of this computer showed no key of this network")),
    ("unable", re.compile(r"The program at (?P<places>.+?) does not have the keys")),
)
"""How nep_core/security/refusals.py tells of those who were not let in."""


@dataclass(frozen=True)
class Refusal:
    """Who was not let in, from where ("" when it is this computer), and when (time.time())."""

    kind: RefusalKind
    address: str
    time_s: float


class Refusals:
    """The last ones, each once; who knocks again moves to the front."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, str], Refusal] = {}

    def add(self, refusal: Refusal) -> bool:
        """Note one; whether it is news."""
        key = refusal.kind, refusal.address
        is_new = self._known.pop(key, None) is None
        self._known[key] = refusal
        while len(self._known) > MOST:
            del self._known[next(iter(self._known))]
        return is_new

    def clear(self) -> None:
        """Forget all."""
        self._known.clear()

    @property
    def newest_first(self) -> list[Refusal]:
        """All that are known."""
        return list(reversed(self._known.values()))


def refusals_in(told: str) -> Iterator[Refusal]:
    """What a warning says of those who were refused; nothing when it is about something else."""
    for kind, pattern in _TOLD:
        for found in pattern.finditer(told):
            places = found.groupdict().get("places", "")
            for address in places.partition(" and ")[0].split(", "):
                yield Refusal(kind, address, time.time())
