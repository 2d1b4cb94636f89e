"""Who publishes and who subscribes, as the master knows it; no sockets in here."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

import msgspec

from nep_core.errors import NameTaken

LEASE_S = 3.0
"""A program that has been silent for so long is gone (heartbeats come every half second)."""


class Publishing(msgspec.Struct, frozen=True):
    """Where a topic's publisher is: its instance, its node's name and its endpoint."""

    instance: str
    node: str
    endpoint: str


class Registration(msgspec.Struct, kw_only=True):
    """All that one program tells of itself; sent again whole after every change.

    ``subscribes`` is the topic of each subscriber by the subscriber's id.
    """

    instance: str
    node: str
    pid: Annotated[int, msgspec.Meta(ge=0, le=2**31 - 1)]
    host: str
    endpoint: str
    publishes: list[str] = []
    subscribes: dict[str, str] = {}


@dataclass
class Entry:
    """A registration, when it was last confirmed, and how to reach its program."""

    registration: Registration
    seen_s: float
    address: bytes


@dataclass
class Registry:
    """The entries by instance; every change returns the topics whose publishers changed."""

    entries: dict[str, Entry] = field(default_factory=dict)

    def register(self, told: Registration, address: bytes, now_s: float) -> set[str]:
        """Take over what a program tells; raises NameTaken."""
        for entry in self.entries.values():
            other = entry.registration
            if other.node == told.node and other.instance != told.instance:
                raise NameTaken(
                    f'A node named "{told.node}" is already running (process {other.pid}).',
                    checklist=(
                        "Give the new node another name.",
                        f'Or stop the running "{told.node}" first.',
                    ),
                )
        before = self.entries.get(told.instance)
        self.entries[told.instance] = Entry(told, now_s, address)
        old_topics = set(before.registration.publishes) if before else set()
        return old_topics ^ set(told.publishes)

    def confirm(self, instance: str, now_s: float) -> bool:
        """Note a heartbeat; False when the instance is not registered."""
        entry = self.entries.get(instance)
        if entry is not None:
            entry.seen_s = now_s
        return entry is not None

    def remove(self, instance: str) -> set[str]:
        """Forget a program."""
        entry = self.entries.pop(instance, None)
        return set(entry.registration.publishes) if entry else set()

    def expired(self, now_s: float) -> list[str]:
        """The instances whose lease has run out."""
        return [i for i, entry in self.entries.items() if now_s - entry.seen_s > LEASE_S]

    def publishers(self, topic: str) -> list[Publishing]:
        """Who publishes ``topic``."""
        told = (entry.registration for entry in self.entries.values())
        return [Publishing(r.instance, r.node, r.endpoint) for r in told if topic in r.publishes]

    def subscribers(self, topic: str) -> list[str]:
        """The ids of the subscribers of ``topic``."""
        told = (entry.registration.subscribes for entry in self.entries.values())
        return [i for subscribes in told for i, wanted in subscribes.items() if wanted == topic]

    def listeners(self, topic: str) -> list[bytes]:
        """The addresses of the programs that subscribe to ``topic``."""
        return [
            entry.address
            for entry in self.entries.values()
            if topic in entry.registration.subscribes.values()
        ]
