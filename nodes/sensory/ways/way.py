"""How a watch or phone reaches this computer: what every way looks like to the node."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from nodes.sensory.reading import Reading

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
    def who(self) -> str:
        """Who may send, for a sentence."""
        return (
            "from this computer only" if self.listen_on == "this computer" else "from the network"
        )


@dataclass(frozen=True)
class Arrived:
    """What came from one sender at one moment.

    ``sender`` names it to the user and tells senders apart ("192.168.1.7", "Ana's iPhone");
    ``arrived_s`` is ``time.monotonic()``; ``readings`` are in the order of their stamps. A
    ``trouble`` is a whole sentence about what could not be used; the node warns of it at most
    every few seconds. ``told`` is how its numbers are understood, without words that need
    translating ("t (ms), ax, ay, az (m/s²)"): the node adds it to "connected". ``number`` counts
    the sender's messages, where it does, so that a lost one is noticed; messages are then handed
    over in this order. ``dropped`` are readings that were left out because too many came.
    An arrival with neither readings nor trouble says: the sender is there, but silent.
    """

    sender: str
    readings: Sequence[Reading] = ()
    arrived_s: float = 0.0
    trouble: str = ""
    told: str = ""
    number: int | None = None
    dropped: int = 0


class Way(Protocol):
    """A way that sensor data come in; used by one thread, the node's.

    Servers and clients that run in a thread of their own hand over through a bounded queue
    (nodes/sensory/ways/background.py has one for asyncio).
    """

    @property
    def where(self) -> str:
        """What the node is ready for: "waits for a watch on UDP port 8085 (from the network)"."""
        ...

    @property
    def missing(self) -> str:
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
