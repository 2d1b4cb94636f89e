"""Counts the messages of each node and topic, and how many a second they are."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import Any

from .seen import Flow, Route

WINDOW_S = 2.0
"""A rate is that of so many seconds: long enough to stand still, short enough to be now."""


@dataclass
class Counter:
    """How many messages there were, and when: (time, how many before it)."""

    count: int = 0
    marks: deque[tuple[float, int]] = field(default_factory=deque)

    def add(self, count: int, now_s: float) -> None:
        """Count some more."""
        self.count += count
        self.mark(now_s)

    def mark(self, now_s: float) -> None:
        """Remember how many there are now; forget what is older than the window."""
        self.marks.append((now_s, self.count))
        while len(self.marks) > 2 and self.marks[1][0] <= now_s - WINDOW_S:
            self.marks.popleft()

    def rate_hz(self, now_s: float) -> float:
        """How many a second there were in the window."""
        if not self.marks:
            return 0.0
        self.mark(now_s)
        first_s, before = self.marks[0]
        return (self.count - before) / max(now_s - first_s, 1e-3) if now_s > first_s else 0.0


@dataclass
class TopicTraffic:
    """What is known of one topic."""

    counter: Counter = field(default_factory=Counter)
    lost: int = 0
    last_s: float = 0.0
    last: Any = None


class Traffic:
    """The messages of a network since it is watched. Times are monotonic, ``sent_s`` is not."""

    def __init__(self) -> None:
        self.topics: dict[str, TopicTraffic] = {}
        self._routes: dict[Route, Counter] = {}

    def begin(self, topic: str, now_s: float) -> None:
        """Watch a topic from now on."""
        self.topics.setdefault(topic, TopicTraffic()).counter.mark(now_s)

    def forget(self, topic: str) -> None:
        """Watch it no more."""
        self.topics.pop(topic, None)
        for route in [route for route in self._routes if route[1] == topic]:
            del self._routes[route]

    def note(self, topic: str, senders: dict[str, int], now_s: float) -> None:
        """Count messages of a topic by the nodes that sent them."""
        self.topics[topic].counter.add(sum(senders.values()), now_s)
        for node, count in senders.items():
            route = (node, topic)
            if route not in self._routes:
                self._routes[route] = Counter()
                self._routes[route].mark(self.topics[topic].counter.marks[0][0])
            self._routes[route].add(count, now_s)

    def flows(self, now_s: float) -> dict[Route, Flow]:
        """How much each node publishes on each topic."""
        return {
            route: Flow(counter.rate_hz(now_s), counter.count)
            for route, counter in self._routes.items()
        }
