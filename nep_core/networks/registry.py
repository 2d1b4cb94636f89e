"""Who publishes and who subscribes, as the master knows it; no sockets in here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, TypeVar

import msgspec

from nep_core.errors import NameTaken, NetworkError
from nep_core.wire.frames import check_topic, has_controls

from .endpoints import fixed_endpoint

V = TypeVar("V")

LEASE_S = 3.0
"""A program that has been silent for so long is gone (heartbeats come every half second)."""


class Publishing(msgspec.Struct, frozen=True, omit_defaults=True):
    """Where a topic's publisher is: its instance, its node's name, its endpoint, its public key."""

    instance: str
    node: str
    endpoint: str
    key: str = ""


class Registration(msgspec.Struct, kw_only=True):
    """All that one program tells of itself.

    ``subscribes`` is the topic of each subscriber by the subscriber's id; ``key`` the public key
    of the program's publishers, empty where nothing is encrypted.
    """

    instance: str
    node: str
    pid: Annotated[int, msgspec.Meta(ge=0, le=2**31 - 1)]
    host: str
    endpoint: str
    publishes: list[str] = []
    subscribes: dict[str, str] = {}
    key: str = ""

    @property
    def publishing(self) -> Publishing:
        """Where this program's publishers are."""
        return Publishing(self.instance, self.node, self.endpoint, self.key)


def check_registration(told: Registration) -> None:
    """Raise NetworkError when others could not use what a program tells of itself."""
    if not told.instance or not told.node:
        raise NetworkError("A registration names its instance and its node.")
    check_name(told.node)
    check_name(told.host)
    if told.endpoint or told.publishes:
        fixed_endpoint(told.endpoint)
    for topic in (*told.publishes, *told.subscribes.values()):
        check_topic(topic)


def check_name(name: str) -> None:
    """Raise NetworkError when a node's or a computer's name would write more than a name."""
    if has_controls(name):
        raise NetworkError(
            "{name} cannot be a name: names are written without control characters.",
            checklist=("Give it a name of letters, digits and spaces.",),
            name=repr(name),
        )


@dataclass
class Entry:
    """A registration, when it was last confirmed, and how to reach its program.

    ``has_missed`` is true when something could not be told to it: it must register again.
    """

    registration: Registration
    seen_s: float
    address: bytes
    version: int = 0
    has_missed: bool = False


class Registry:
    """The entries by instance, and who is at each topic; changes return the topics to tell."""

    def __init__(self) -> None:
        self.entries: dict[str, Entry] = {}
        self._by_node: dict[str, Entry] = {}
        self._publishers: dict[str, dict[str, Publishing]] = {}
        self._subscribers: dict[str, dict[str, list[str]]] = {}

    def holder(self, node: str) -> Entry | None:
        """Who has the name ``node``."""
        return self._by_node.get(node)

    def register(
        self, told: Registration, address: bytes, now_s: float, version: int = 0
    ) -> set[str]:
        """Take over what a program tells; raises NameTaken.

        ``told`` is all that it tells, ``address`` its connection, ``now_s`` the time of a
        steady clock, ``version`` the number of what it tells.
        """
        holder = self.holder(told.node)
        if holder is not None and holder.registration.instance != told.instance:
            raise NameTaken(
                'A node named "{node}" is already running (process {pid}).',
                checklist=(
                    "Give the new node another name.",
                    'Or stop the running "{node}" first.',
                ),
                node=told.node,
                pid=holder.registration.pid,
            )
        before = self.entries.get(told.instance)
        entry = Entry(told, now_s, address, version)
        self.entries[told.instance] = entry
        if before is not None and before.registration.node != told.node:
            del self._by_node[before.registration.node]
        self._by_node[told.node] = entry
        return self._index(before.registration if before else _without_topics(told), told)

    def confirm(self, instance: str, address: bytes, now_s: float) -> bool:
        """Note a heartbeat; False when the program should register (again)."""
        entry = self.entries.get(instance)
        if entry is None:
            return False
        entry.seen_s = now_s
        return entry.address == address and not entry.has_missed

    def remove(self, instance: str) -> set[str]:
        """Forget a program."""
        entry = self.entries.pop(instance, None)
        if entry is None:
            return set()
        del self._by_node[entry.registration.node]
        return self._index(entry.registration, _without_topics(entry.registration))

    def expired(self, now_s: float) -> list[str]:
        """The instances whose lease has run out."""
        return [i for i, entry in self.entries.items() if now_s - entry.seen_s > LEASE_S]

    def lengthen_leases(self, by_s: float) -> None:
        """The master itself was held up for so long: no program's silence counts."""
        for entry in self.entries.values():
            entry.seen_s += by_s

    def publishers(self, topic: str) -> list[Publishing]:
        """Who publishes ``topic``."""
        return list(self._publishers.get(topic, {}).values())

    def subscribers(self, topic: str) -> list[str]:
        """The ids of the subscribers of ``topic``."""
        return [i for ids in self._subscribers.get(topic, {}).values() for i in ids]

    def listeners(self, topic: str) -> list[Entry]:
        """The programs that subscribe to ``topic``."""
        return [self.entries[instance] for instance in self._subscribers.get(topic, {})]

    def _index(self, old: Registration, new: Registration) -> set[str]:
        """Note what is different in what a program tells; the topics whose publishers changed."""
        instance = new.instance
        for subscriber, topic in old.subscribes.items() - new.subscribes.items():
            ids = self._subscribers[topic][instance]
            ids.remove(subscriber)
            if not ids:
                _take_out(self._subscribers, topic, instance)
        for subscriber, topic in new.subscribes.items() - old.subscribes.items():
            self._subscribers.setdefault(topic, {}).setdefault(instance, []).append(subscriber)
        before, after = set(old.publishes), set(new.publishes)
        came, gone = after - before if old.publishing == new.publishing else after, before - after
        for topic in gone:
            _take_out(self._publishers, topic, instance)
        for topic in came:
            self._publishers.setdefault(topic, {})[instance] = new.publishing
        return came | gone


def _without_topics(told: Registration) -> Registration:
    return msgspec.structs.replace(told, publishes=[], subscribes={})


def _take_out(index: dict[str, dict[str, V]], topic: str, instance: str) -> None:
    """Take a program out of a topic, and the topic with its last program."""
    programs = index[topic]
    del programs[instance]
    if not programs:
        del index[topic]
