"""The private subscriptions by which two peers know that they hear each other.

After its data subscription a subscriber makes a private one. When a publisher sees the private
one, the data subscription is in force, and it answers with a *welcome* on the private topic,
which no other subscriber gets: its instance and a notice (frames.py) of what was sent so far.

The order holds because ZeroMQ sends what is already subscribed in the order of the bytes when a
connection is made: private topics begin with 0xFF, which no UTF-8 text holds, and come last.
"""

from __future__ import annotations

from typing import NamedTuple

PRIVATE = b"\xffs"
PRIVATE_BYTE = 0xFF
_NUL = b"\0"


class Seen(NamedTuple):
    """A private subscription as its publisher sees it; ``present`` is False when it is gone."""

    present: bool
    topic: str
    subscriber: str


def private_subscription(topic: str, subscriber: str) -> bytes:
    """The private subscription of ``subscriber`` (an id of its own) for ``topic``."""
    return PRIVATE + topic.encode() + _NUL + subscriber.encode() + _NUL


def read_subscription(event: bytes) -> Seen | None:
    """What an XPUB event tells of a subscriber; None for ordinary subscriptions and rubbish."""
    if not event[1:].startswith(PRIVATE) or event[:1] not in (b"\0", b"\1"):
        return None
    parts = event[1 + len(PRIVATE) :].split(_NUL)
    if len(parts) != 3:
        return None
    topic, subscriber = (part.decode(errors="replace") for part in parts[:2])
    return Seen(event[:1] == b"\1", topic, subscriber)


def private_frame(topic: str, subscriber: str, instance: str, notice: bytes = b"") -> bytes:
    """What one subscriber is told: by whom, and a notice (empty: only that it is heard)."""
    return private_subscription(topic, subscriber) + instance.encode() + _NUL + notice


def read_welcome(frame: bytes) -> tuple[str, bytes]:
    """The instance that sent a private frame, and its notice."""
    _topic, _subscriber, rest = frame[len(PRIVATE) :].split(_NUL, 2)
    instance, _, notice = rest.partition(_NUL)
    return instance.decode(errors="replace"), notice
