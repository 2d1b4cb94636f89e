"""Watches a network from a thread of its own: who is there, what is sent, what it costs."""

from __future__ import annotations

import contextlib
import logging
import socket
import threading
import time
from collections import Counter
from collections.abc import Callable
from typing import Any

from nep_core import transports
from nep_core.errors import NepError
from nep_core.messages import NODE_STATE
from nep_core.network import Network
from nep_core.pubsub import Subscriber
from nep_core.registry import Registration
from nep_core.topics import topics_of

from .process_meter import ProcessMeter
from .seen import Flow, NodeSeen, Route, Seen, TopicSeen, Use
from .traffic import Traffic

log = logging.getLogger(__name__)

DRAIN_S = 0.1
"""How often what has arrived is counted; the network keeps 10,000 messages of a topic meanwhile."""
MEASURE_S = 1.0
"""How often the processes are measured."""
MOST_AT_ONCE = 3000
"""So many messages of a topic are counted before the next topic has its turn."""


class NetworkWatch:
    """Looks at the network that ``find_network`` gives, from ``start`` to ``stop``.

    ``latest`` is what was seen last, a new object each time; any thread may read it.
    """

    def __init__(self, find_network: Callable[[], Network | None]) -> None:
        self._find_network = find_network
        self._ending = threading.Event()
        self._network: Network | None = None
        self._subscribers: dict[str, Subscriber[Any]] = {}
        self._traffic = Traffic()
        self._meter = ProcessMeter()
        self._uses: dict[int, Use | None] = {}
        self._feed: transports.Feed | None = None
        self._registered: list[Registration] = []
        self._measured_s = 0.0
        self.latest = Seen()

    def start(self) -> None:
        """Begin to look."""
        threading.Thread(target=self._run, name="nep-studio-watch", daemon=True).start()

    def stop(self) -> None:
        """Look no more; does not wait."""
        self._ending.set()

    def _run(self) -> None:
        while not self._ending.wait(DRAIN_S):
            try:
                self._look()
            except NepError as error:  # the network is being closed
                log.debug("the network cannot be watched: %s", error)
                self._leave()
            except Exception:
                log.exception("the network cannot be watched")
                self._leave()
        self._leave()

    def _look(self) -> None:
        network = self._find_network()
        if network is not self._network or (network is not None and network.closed):
            self._leave()
            self._network = None if network is None or network.closed else network
            if self._network is not None:
                self._feed = transports.follow_in(self._network, self._on_registrations)
        if self._network is None:
            if self.latest.is_up:
                self.latest = Seen()
            return
        now_s = time.monotonic()
        if now_s - self._measured_s >= MEASURE_S:
            self._measured_s = now_s
            self._measure()
        self._forget_topics()
        self._hear_one_more(self._network)
        for topic, subscriber in self._subscribers.items():
            self._drain(topic, subscriber)
        self.latest = self._seen()

    def _leave(self) -> None:
        """Forget the network that was watched."""
        for subscriber in self._subscribers.values():
            with contextlib.suppress(NepError):
                subscriber.close()
        if self._feed is not None:
            self._feed.close()
        self._feed = None
        self._subscribers, self._traffic = {}, Traffic()
        self._registered, self._uses, self._measured_s = [], {}, 0.0
        self._network = None

    def _on_registrations(self, told: list[Registration]) -> None:
        """Who is there now; while the master is away its nodes still talk."""
        self._registered = told
        self._measured_s = 0.0  # measure newcomers at once

    def _measure(self) -> None:
        """Measure the processes on this computer."""
        here = socket.gethostname()
        local = {told.pid for told in self._registered if told.host == here}
        self._meter.keep_only_running()
        self._uses = {pid: self._meter.measure(pid) for pid in local}

    def _forget_topics(self) -> None:
        """Hear no more what nobody publishes."""
        wanted = {topic for told in self._registered for topic in told.publishes}
        for topic in set(self._subscribers) - wanted:
            self._subscribers.pop(topic).close()
            self._traffic.forget(topic)

    def _hear_one_more(self, network: Network) -> None:
        """Hear a new topic, one at a time: a publisher that is frozen takes a second."""
        published = (topic for told in self._registered for topic in told.publishes)
        topic = next((one for one in published if one not in self._subscribers), None)
        if topic is not None:
            self._subscribers[topic] = Subscriber(topic, network=network)
            self._traffic.begin(topic, time.monotonic())

    def _drain(self, topic: str, subscriber: Subscriber[Any]) -> None:
        senders: Counter[str] = Counter()
        message = None
        for _ in range(MOST_AT_ONCE):
            received = subscriber.receive(0)
            if received is None:
                break
            message = received
            header = subscriber.header
            senders[header.node if header else ""] += 1
        if message is None:
            return
        self._traffic.note(topic, dict(senders), time.monotonic())
        known, header = self._traffic.topics[topic], subscriber.header
        known.last, known.lost = message, subscriber.lost
        known.last_s = header.time_ns / 1e9 if header else time.time()

    def _seen(self) -> Seen:
        flows = self._traffic.flows(time.monotonic())
        nodes = {told.node: self._node(told, flows) for told in self._registered}
        topics = {
            ends.topic: self._topic(ends.topic, ends.publishers, ends.subscribers)
            for ends in topics_of(self._registered)
        }
        return Seen(True, nodes, topics, flows)

    def _node(self, told: Registration, flows: dict[Route, Flow]) -> NodeSeen:
        hears = tuple(sorted(set(told.subscribes.values())))
        says = tuple(sorted(told.publishes))
        # Heartbeats are no messages that a person thinks of.
        rates = [flows[told.node, topic].rate_hz for topic in says if (told.node, topic) in flows]
        beats = flows.get((told.node, NODE_STATE), Flow()).rate_hz
        rate_hz = max(0.0, sum(rates) - beats)
        return NodeSeen(told.node, says, hears, told.pid, self._uses.get(told.pid), rate_hz)

    def _topic(
        self, name: str, publishers: tuple[str, ...], subscribers: tuple[str, ...]
    ) -> TopicSeen:
        known = self._traffic.topics.get(name)
        if known is None:
            return TopicSeen(name, publishers, subscribers)
        rate_hz, count = known.counter.rate_hz(time.monotonic()), known.counter.count
        return TopicSeen(
            name, publishers, subscribers, rate_hz, count, known.lost, known.last_s, known.last
        )
