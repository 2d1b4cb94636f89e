"""What the master has to tell others after a change, told once for many changes.

A topic such as /node_state is published and heard by all: when many nodes come at once, telling
each change at once would be the square of the nodes in messages, each as long as the list.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable

from nep_core import master_messages as says
from nep_core.registry import LEASE_S, Registry

REST = 10.0
"""After telling, the master rests for so many times as long as it took, while more gathers ..."""
LONGEST_REST_S = 0.1
"""... but not longer: a new publisher waits a second for its subscribers."""

Send = Callable[[bytes, bytes], bool]


class News:
    """Gathers changes and tells who should know: subscribers of topics, and who watches.

    ``send`` gives an encoded answer to an address; False when it cannot be delivered.
    """

    def __init__(self, epoch: str, registry: Registry, send: Send) -> None:
        self.number = 0
        self._epoch = epoch
        self._registry = registry
        self._send = send
        self._topics: set[str] = set()
        self._instances: set[str] = set()
        self._watchers: dict[bytes, float] = {}
        self._rest_until_s = 0.0

    def note(self, instance: str, topics: Iterable[str]) -> None:
        """A program has changed, and with it the publishers of these topics."""
        self._instances.add(instance)
        self._topics.update(topics)

    def watch(self, address: bytes, now_s: float) -> None:
        """Tell this one of all changes for a lease."""
        self._watchers[address] = now_s + LEASE_S

    def due_in_s(self, now_s: float) -> float:
        """When there is something to tell."""
        is_any = self._topics or self._instances
        return max(0.0, self._rest_until_s - now_s) if is_any else float("inf")

    def tell(self, now_s: float) -> None:
        """Tell what is due."""
        if self.due_in_s(now_s) > 0:
            return
        began_s = time.perf_counter()
        topics, self._topics = self._topics, set()
        instances, self._instances = self._instances, set()
        for topic in topics:
            self._tell_listeners(topic)
        self._tell_watchers(instances, now_s)
        took_s = time.perf_counter() - began_s
        self._rest_until_s = now_s + min(REST * took_s, LONGEST_REST_S)

    def _tell_listeners(self, topic: str) -> None:
        listeners = self._registry.listeners(topic)
        if not listeners:
            return
        publishers = self._registry.publishers(topic)
        news = says.encode(says.Publishers(topic=topic, publishers=publishers))
        for entry in listeners:
            if not self._send(entry.address, news):
                entry.has_missed = True  # its next heartbeat makes it register again

    def _tell_watchers(self, instances: set[str], now_s: float) -> None:
        self.number += 1
        self._watchers = {who: until for who, until in self._watchers.items() if until > now_s}
        if not self._watchers:
            return
        entries = self._registry.entries
        changed = says.Changed(
            epoch=self._epoch,
            number=self.number,
            came=[entries[i].registration for i in instances if i in entries],
            gone=[i for i in instances if i not in entries],
        )
        news = says.encode(changed)
        self._watchers = {
            who: until for who, until in self._watchers.items() if self._send(who, news)
        }
