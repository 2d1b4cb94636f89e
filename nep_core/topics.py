"""Which topics a network has, and who publishes and hears each, as its master knows it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from nep_core.registry import Registration


@dataclass(frozen=True)
class TopicEnds:
    """A topic, and the names of the nodes at its two ends, sorted."""

    topic: str
    publishers: tuple[str, ...] = ()
    subscribers: tuple[str, ...] = ()


def topics_of(registrations: Iterable[Registration]) -> list[TopicEnds]:
    """All topics that somebody publishes or hears, sorted by name."""
    ends: dict[str, tuple[set[str], set[str]]] = {}
    for told in registrations:
        for topic in told.publishes:
            ends.setdefault(topic, (set(), set()))[0].add(told.node)
        for topic in told.subscribes.values():
            ends.setdefault(topic, (set(), set()))[1].add(told.node)
    return [
        TopicEnds(topic, tuple(sorted(says)), tuple(sorted(hears)))
        for topic, (says, hears) in sorted(ends.items())
    ]
