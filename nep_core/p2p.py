"""The default network: publishers bind a free port, and the master tells subscribers where."""

from __future__ import annotations

from nep_core.endpoints import fixed_endpoint, master_endpoint
from nep_core.errors import NetworkError
from nep_core.inbox import Inbox
from nep_core.master_client import MasterClient
from nep_core.outbox import HIGH_WATER_MARK
from nep_core.registry import Publishing, Registration
from nep_core.security.addresses import endpoint_at, own_address
from nep_core.zmq_network import ZmqNetwork


class PeerNetwork(ZmqNetwork):
    """One program's place in a p2p network.

    Joining raises MasterNotFound when no master answers, NameTaken when a node of this name is
    already running.
    """

    def __init__(
        self,
        node: str = "",
        *,
        master: str | None = None,
        high_water_mark: int = HIGH_WATER_MARK,
        is_far: bool = False,
    ) -> None:
        self.master = fixed_endpoint(master or master_endpoint())
        super().__init__(node, high_water_mark=high_water_mark, is_far=is_far)
        self._topics: dict[str, int] = {}
        self._inboxes_by_topic: dict[str, list[Inbox]] = {}
        try:
            endpoint = self._open_outbox()
        except NetworkError:
            self.outbox.close()
            self._end()
            raise
        told = MasterClient.registration(self.node, self.instance, endpoint)
        if self.security is not None:
            told.key = self.security.key
        self._client = MasterClient(
            self.context,
            self.io,
            self.master,
            told,
            self._connect_subscribers,
            lambda: self.on_stop(),  # a node sets it later
            self.security.allow if self.security else lambda keys: None,
        )
        self.io.start()

    def join(self) -> None:
        """Make the node's name known at once; the first topic would do it too."""
        self._client.change(lambda told: None)

    def add_publisher(self, topic: str) -> set[str]:
        """Register the topic; the subscribers that the master knows."""
        with self._lock:
            self._topics[topic] = self._topics.get(topic, 0) + 1
        return set(self._client.change(self._tell_topics, topic).subscribers)

    def add_subscriber(self, topic: str, subscriber: str, inbox: Inbox) -> set[str]:
        """Register the subscriber; the publishers that the master knows."""
        with self._lock:
            self._inboxes_by_topic.setdefault(topic, []).append(inbox)

        def add(told: Registration) -> None:
            told.subscribes[subscriber] = topic

        return {publisher.instance for publisher in self._client.change(add, topic).publishers}

    def remove_publisher(self, topic: str) -> None:
        """Tell the master, without waiting, when the topic's last publisher here is closed."""
        with self._lock:
            self._topics[topic] = self._topics.get(topic, 0) - 1
        self._client.change_later(self._tell_topics)

    def remove_subscriber(self, subscriber: str) -> None:
        """End a subscriber and tell the master, without waiting."""
        with self._lock:
            inbox = self._inboxes.get(subscriber)
            for inboxes in self._inboxes_by_topic.values():
                if inbox in inboxes:
                    inboxes.remove(inbox)
        super().remove_subscriber(subscriber)
        self._client.change_later(lambda told: _forget(told, subscriber))

    def _open_outbox(self) -> str:
        """Where subscribers find the messages."""
        return self.outbox.bind(self._own_place())

    def _own_place(self) -> str:
        """Where to bind: this computer alone, or with keys where other computers reach it."""
        host = "127.0.0.1" if self.security is None else own_address(self.master)
        return endpoint_at(host, "*")

    def _tell_topics(self, told: Registration) -> None:
        told.publishes = sorted(topic for topic, count in self._topics.items() if count > 0)

    def _connect_subscribers(self, topic: str, publishers: list[Publishing]) -> None:
        endpoints = self._endpoints_of(publishers)
        with self._lock:
            inboxes = list(self._inboxes_by_topic.get(topic, []))
        for inbox in inboxes:
            inbox.connect(endpoints, {publisher.instance for publisher in publishers})

    def _endpoints_of(self, publishers: list[Publishing]) -> dict[str, str]:
        """Where they are heard, and their keys."""
        return {publisher.endpoint: publisher.key for publisher in publishers}

    def _leave(self) -> None:
        self._client.close()


def _forget(told: Registration, subscriber: str) -> None:
    told.subscribes.pop(subscriber, None)
