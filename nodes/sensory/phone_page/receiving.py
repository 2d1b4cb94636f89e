"""Takes the messages of all open pages, and gives on those of the phone that is followed."""

from __future__ import annotations

import itertools
import math
import time
from collections import OrderedDict
from collections.abc import Callable
from typing import Annotated, Literal

import msgspec

from faults import text_of
from nodes.sensory.connectors.connector import Arrived
from nodes.sensory.reading import Reading, Vector

# What the page sends: some samples, and how the phone is held.

MOST_BYTES = 65_536
MOST_SAMPLES = 512
_LARGEST = 1e4  # m/s² or rad/s; no phone in a hand means more

Hand = Literal["left", "hand", "right"]
Word = Annotated[str, msgspec.Meta(max_length=32)]
Times = Annotated[list[float], msgspec.Meta(max_length=MOST_SAMPLES)]
Vectors = Annotated[list[Vector], msgspec.Meta(max_length=MOST_SAMPLES)]


class PageMessage(msgspec.Struct, kw_only=True):
    """One message of the page as it is on the wire; no samples: the page is there, but rests."""

    id: Word
    t: Times
    acc: Vectors
    gyr: Vectors | None = None
    gravity: bool = True
    hand: Hand = "hand"
    device: Word = ""
    lost: Annotated[int, msgspec.Meta(ge=0, le=2**31)] = 0


def read_message(text: bytes | str) -> PageMessage:
    """The message, checked; raises ValueError with a reason when it is not one of our page."""
    try:
        message = _DECODER.decode(text)
    except RecursionError as error:
        raise ValueError("it is nested too deep") from error
    rows = [message.acc] if message.gyr is None else [message.acc, message.gyr]
    if any(len(vectors) != len(message.t) for vectors in rows):
        raise ValueError("times and values differ in number")
    values = itertools.chain(message.t, *itertools.chain.from_iterable(rows))
    if not all(map(math.isfinite, values)):
        raise ValueError("a value is not finite")
    flat = itertools.chain.from_iterable(itertools.chain.from_iterable(rows))
    if any(abs(value) > _LARGEST for value in flat):
        raise ValueError("a value is larger than any sensor's")
    return message


def readings_of(message: PageMessage) -> tuple[Reading, ...]:
    """The samples of a message, by the phone's own clock in seconds."""
    gyr: list[Vector] | list[None] = message.gyr or [None] * len(message.t)
    return tuple(
        Reading(acc, turn, stamp=t, stamp_unit_s=1.0, gravity_included=message.gravity)
        for t, acc, turn in zip(message.t, message.acc, gyr, strict=True)
    )


_DECODER = msgspec.json.Decoder(PageMessage)


# Which of several phones is followed, and how much each may send.

SILENT_S = 3.0
_MOST_SENDERS = 128


class Turn:
    """One phone is followed, until it leaves or is silent for some seconds; then the next."""

    def __init__(self) -> None:
        self._phone = ""
        self.heard_s = 0.0
        """When the phone that is followed sent something last."""

    def is_free_for(self, phone: str, now_s: float) -> bool:
        """Whether this phone is followed, or would be if it sent something now."""
        return self._phone in ("", phone) or now_s - self.heard_s >= SILENT_S

    def take(self, phone: str, now_s: float) -> bool:
        """Follow this phone, which sends samples, if it is free to; whether it is followed."""
        if not self.is_free_for(phone, now_s):
            return False
        self._phone, self.heard_s = phone, now_s
        return True

    def leave(self, phone: str, heard_s: float = math.inf) -> None:
        """The phone has closed a connection, by which it was followed last at ``heard_s``.

        Who was heard by another one since then has only changed its network.
        """
        if phone == self._phone and self.heard_s <= heard_s:
            self._phone = ""


class Allowance:
    """How much of something each sender may use: ``rate`` a second, and ``burst`` at once."""

    def __init__(self, rate: float, burst: float) -> None:
        self._rate, self._burst = rate, burst
        self._left: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def grants(self, sender: str, now_s: float, amount: float = 1.0) -> bool:
        """Whether the sender may use so much now; what is refused is not counted."""
        left, before_s = self._left.pop(sender, (self._burst, now_s))
        left = min(self._burst, left + (now_s - before_s) * self._rate)
        is_granted = amount <= left
        self._left[sender] = (left - amount if is_granted else left, now_s)
        while len(self._left) > _MOST_SENDERS:
            self._left.popitem(last=False)
        return is_granted


MESSAGES_S, MESSAGES_AT_ONCE = 60.0, 120.0
SAMPLES_S, SAMPLES_AT_ONCE = 500.0, 1500.0  # twice what the fastest phone sends
TOLD_EVERY_S = 5.0

FOLLOWED, BUSY = "followed", "busy"
"""What a phone is told: that its samples are used, or that another phone is followed."""


class Receiving:
    """``give`` gets each batch of the phone that is followed, and what the user should know."""

    def __init__(
        self, give: Callable[[Arrived], None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._give, self._clock = give, clock
        self._turn = Turn()
        self._messages = Allowance(MESSAGES_S, MESSAGES_AT_ONCE)
        self._samples = Allowance(SAMPLES_S, SAMPLES_AT_ONCE)
        self._sentences = Allowance(1 / TOLD_EVERY_S, 1.0)
        self._followed = ""
        self.hand = ""
        """Where the followed phone is, as chosen on the page: left, right or hand."""

    def may_send(self, address: str) -> bool:
        """Whether a message of this address is still one of a page, and not of a flood."""
        return self._messages.grants(address, self._clock())

    def take(self, message: PageMessage, address: str) -> str:
        """Give a message on if it is its phone's turn; what the phone is told."""
        now_s = self._clock()
        if not message.t:
            return FOLLOWED if self._turn.is_free_for(message.id, now_s) else BUSY
        if not self._turn.take(message.id, now_s):
            self._tell_of_second(_name(message, address), now_s)
            return BUSY
        self._followed = _name(message, address)
        is_granted = self._samples.grants(address, now_s, len(message.t))
        self.hand = message.hand
        arrived = Arrived(
            sender=self._followed,
            readings=readings_of(message) if is_granted else (),
            arrived_s=now_s,
            dropped=message.lost + (0 if is_granted else len(message.t)),
        )
        self._give(arrived)
        return FOLLOWED

    @property
    def followed_s(self) -> float:
        """When something came last from the phone that is followed."""
        return self._turn.heard_s

    def leave(self, phone: str, followed_s: float) -> None:
        """A connection of a phone, its id, was closed; by it the phone was followed last then."""
        self._turn.leave(phone, followed_s)

    def _tell_of_second(self, name: str, now_s: float) -> None:
        if self._sentences.grants("", now_s):
            told = text_of(
                "A second phone ({name}) has the page open; {followed} is followed.",
                name=name,
                followed=self._followed,
            )
            self._give(Arrived(self._followed, arrived_s=now_s, trouble=told))


def _name(message: PageMessage, address: str) -> str:
    return f"{message.device} {address}" if message.device.isalnum() else address
