"""What the page sends: some samples, and how the phone is held."""

from __future__ import annotations

import itertools
import math
from typing import Annotated, Literal

import msgspec

from nodes.sensory.reading import Reading, Vector

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
