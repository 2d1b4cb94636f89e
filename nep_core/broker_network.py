"""The network with a central service: names go through its registry, messages through itself."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from nep_core.endpoints import broker_endpoints, broker_registry
from nep_core.errors import BrokerNotFound, MasterNotFound, NotLetIn
from nep_core.inbox import Inbox
from nep_core.p2p import PeerNetwork
from nep_core.registry import Publishing


class BrokerNetwork(PeerNetwork):
    """Everybody connects to one central service (``nep broker``), which passes messages on.

    Joining raises BrokerNotFound when no broker answers, NameTaken as over p2p.
    """

    def __init__(self, broker: str | None = None, *, node: str = "") -> None:
        self._publishers_end, self._subscribers_end = broker_endpoints(broker)
        super().__init__(node, master=broker_registry(broker), is_far=True)

    def join(self) -> None:
        """Make the node's name known at once; the first topic would do it too."""
        with self._broker_found():
            super().join()

    def add_publisher(self, topic: str) -> set[str]:
        """Register the topic; the subscribers that are known."""
        with self._broker_found():
            return super().add_publisher(topic)

    def add_subscriber(self, topic: str, subscriber: str, inbox: Inbox) -> set[str]:
        """Connect to the broker and register; the publishers that are known."""
        inbox.connect(self._endpoints_of([]))
        with self._broker_found():
            return super().add_subscriber(topic, subscriber, inbox)

    def _open_outbox(self) -> str:
        self.outbox.connect(self._publishers_end)
        return self._publishers_end

    def _endpoints_of(self, publishers: list[Publishing]) -> dict[str, str]:
        return {self._subscribers_end: self._key_at(self._subscribers_end)}

    @contextlib.contextmanager
    def _broker_found(self) -> Iterator[None]:
        try:
            yield
        except NotLetIn:
            raise
        except MasterNotFound as error:
            raise no_broker(self._publishers_end) from error


def no_broker(endpoint: str) -> BrokerNotFound:
    """The error to raise when no broker answers at ``endpoint``."""
    return BrokerNotFound(
        f"No NEP broker answers at {endpoint}.",
        checklist=(
            "Start one in another terminal: nep broker",
            "Is it at another place? Set NEP_BROKER to its endpoint.",
        ),
    )
