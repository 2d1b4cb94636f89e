"""How a watch or phone reaches this computer: what every way looks like to the node."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from faults import Text, Words
from nodes.sensory.reading import Reading, Vector

ADDRESSES = {"this computer": "127.0.0.1", "network": "0.0.0.0"}  # the user's explicit choice


@dataclass(frozen=True)
class Settings:
    """What the user has set; a way takes what it needs.

    ``port`` is never 0 here (the usual port of the way is filled in); ``address`` is the phone's
    (phyphox, SensorServer) or the device's (Bluetooth); ``listen_on`` is a key of ADDRESSES;
    ``token`` is the phone page's; ``columns`` overrides the guess for lines; ``units`` is "guess",
    "standard" (m/s², Android's axes) or "apple" (an iPhone's or Apple Watch's own: g, turned
    round).
    """

    port: int
    address: str = ""
    listen_on: str = "this computer"
    token: str = ""
    columns: str = ""
    units: str = "guess"

    @property
    def own_address(self) -> str:
        """The address of this computer that a server binds to."""
        return ADDRESSES[self.listen_on]

    @property
    def where(self) -> Text:
        """Who may send, for a sentence."""
        is_closed = self.listen_on == "this computer"
        return Text("from this computer only" if is_closed else "from the network")


@dataclass(frozen=True)
class Arrived:
    """What came from one sender at one moment.

    ``sender`` names it to the user and tells senders apart ("192.168.1.7", "Ana's iPhone");
    ``arrived_s`` is ``time.monotonic()``; ``readings`` are in the order of their stamps. A
    ``trouble`` is a whole sentence about what could not be used; the node warns of it at most
    every few seconds. ``columns`` is how its numbers are understood, without words that need
    translating ("t (ms), ax, ay, az (m/s²)"): the node adds it to "connected". ``number`` counts
    the sender's messages, where it does, so that a lost one is noticed; messages are then handed
    over in this order. ``dropped`` are readings that were left out because too many came.
    An arrival with neither readings nor trouble says: the sender is there, but silent.
    """

    sender: str
    readings: Sequence[Reading] = ()
    arrived_s: float = 0.0
    trouble: Words = ""
    columns: str = ""
    number: int | None = None
    dropped: int = 0


class Connector(Protocol):
    """A way that sensor data come in; used by one thread, the node's.

    Servers and clients that run in a thread of their own hand over through a bounded queue
    (nodes/sensory/connectors/servers.py has one for asyncio).
    """

    @property
    def where(self) -> Words:
        """What the node is ready for: "waits for a watch on UDP port 8085 (from the network)"."""
        ...

    @property
    def missing(self) -> Words:
        """A whole sentence on what to check when nothing has arrived for 10 seconds."""
        ...

    def open(self) -> None:
        """Start; raises a NepError (PortTaken, ...) whose checklist says what to do."""
        ...

    def readings(self, until_s: float) -> list[Arrived]:
        """What arrives until then (``time.monotonic()``); returns early only with much to give.

        Never raises for anything that a sender does, and its memory is bounded whatever comes.
        """
        ...

    def close(self) -> None:
        """Stop at once (under 1 s), also when it was never opened."""
        ...


# Puts the sensors of one device together, which it measures and tells separately.

Timed = tuple[float, Vector]
"""A time on the sender's clock, in its unit, and three values."""


def nearest(measured: Sequence[Timed], time: float, within: float) -> Vector | None:
    """The values at ``time``, between the two beside it, or of the nearest; None if far away.

    ``measured`` is in the order of its times.
    """
    at = bisect_left(measured, time, key=lambda one: one[0])
    before = measured[at - 1] if at > 0 else None
    after = measured[at] if at < len(measured) else None
    if before is not None and after is not None and after[0] - before[0] <= 2 * within:
        span = after[0] - before[0]
        share = (time - before[0]) / span if span > 0 else 0.0
        x, y, z = (
            one + share * (other - one) for one, other in zip(before[1], after[1], strict=True)
        )
        return x, y, z
    near = [one for one in (before, after) if one is not None and abs(one[0] - time) <= within]
    return min(near, key=lambda one: abs(one[0] - time))[1] if near else None


# Puts numbered messages that overtook each other back into their order.

T = TypeVar("T")

_MOST_HELD = 4
_LONGEST_HELD_S = 0.4


class Ordering(Generic[T]):
    """Holds a message back for a moment while the one before it is on its way."""

    def __init__(self) -> None:
        self._next: int | None = None
        self._held: dict[int, tuple[float, T]] = {}

    def put(self, number: int, message: T, now_s: float) -> list[tuple[int, T]]:
        """A message that came; those that are in their order now, with their numbers."""
        if self._next is None or abs(number - self._next) > 1_000:  # counted anew
            self._next, self._held = number, {}
        if number < self._next:
            return [(number, message)]  # too late to be put before the others
        self._held[number] = (now_s, message)
        return self.ready(now_s)

    def ready(self, now_s: float) -> list[tuple[int, T]]:
        """Those that are in their order, or that waited long enough for the one before."""
        found: list[tuple[int, T]] = []
        while self._held and self._next is not None:
            first = min(self._held)
            waited_s = now_s - self._held[first][0]
            is_late = waited_s > _LONGEST_HELD_S or len(self._held) > _MOST_HELD
            if first != self._next and not is_late:
                break
            found.append((first, self._held.pop(first)[1]))
            self._next = first + 1
        return found
