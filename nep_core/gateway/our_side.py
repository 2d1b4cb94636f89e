"""A topic on our side of the gateway: it speaks and listens in our network for the original's.

Each has a thread of its own, because joining a topic waits for other programs.
"""

from __future__ import annotations

import logging
import queue
import threading
from collections.abc import Callable
from typing import Any, Literal, TypeVar

from nep_core.errors import BadMessage, MasterNotFound, NameTaken, NetworkError
from nep_core.gateway.warner import Warner
from nep_core.p2p import PeerNetwork
from nep_core.pubsub import Publisher, Subscriber

T = TypeVar("T")

log = logging.getLogger(__name__)

WAITING = 10_000
"""Messages that may wait for our network; when there are more, the newest are dropped."""
AGAIN_S = 1.0
ENDS_S = 2.0


class Speaker:
    """Publishes in our network what a program of the original says."""

    def __init__(
        self, network: PeerNetwork, topic: str, encoding: Literal["msgpack"] | None = None
    ) -> None:
        self._network = network
        self._topic = topic
        self._encoding = encoding
        self._warn = Warner()
        self._closing = threading.Event()
        self._waiting: queue.Queue[Any] = queue.Queue(WAITING)
        self._thread = threading.Thread(target=self._run, name=f"nep-original-{topic}", daemon=True)
        self._thread.start()

    def say(self, value: Any) -> None:
        """Publish soon."""
        try:
            self._waiting.put_nowait((value,))
        except queue.Full:
            self._warn(f"{self._topic}: messages of the original come too fast for our network.")

    def close(self) -> None:
        """Publish what waits, then no more."""
        self._closing.set()
        try:
            self._waiting.put_nowait(None)
        except queue.Full:
            log.debug("%s: what waits is published first", self._topic)

    def wait(self) -> None:
        """Wait until all is said, but not for ever."""
        self._thread.join(ENDS_S)

    def _run(self) -> None:
        publisher = _joined(self._network, self._closing, self._open)
        if publisher is None:
            return
        while not (self._closing.is_set() and self._waiting.empty()):
            item = self._waiting.get()
            if item is None or self._network.closed:
                break
            try:
                publisher.send(*item)
            except BadMessage as error:
                self._warn(f"{self._topic}: {error.sentence}")
        publisher.close()

    def _open(self) -> Publisher:
        try:
            return Publisher(self._topic, network=self._network, encoding=self._encoding)
        except (MasterNotFound, NameTaken):
            raise
        except NetworkError:  # published already with another encoding: then as it comes
            return Publisher(self._topic, network=self._network)


class Listener:
    """Hears a topic of our network, but not what the gateway itself says there."""

    def __init__(
        self, network: PeerNetwork, topic: str, on_value: Callable[[str, Any], None]
    ) -> None:
        self._network = network
        self._topic = topic
        self._on_value = on_value
        self._closing = threading.Event()
        self._lock = threading.Lock()
        self._subscriber: Subscriber[Any] | None = None
        self._thread = threading.Thread(target=self._run, name=f"nep-original-{topic}", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Hear no more."""
        self._closing.set()
        with self._lock:
            if self._subscriber is not None:
                self._subscriber.close()

    def wait(self) -> None:
        """Wait until it has ended, but not for ever."""
        self._thread.join(ENDS_S)

    def _run(self) -> None:
        subscriber = _joined(self._network, self._closing, self._open)
        if subscriber is None:
            return
        for value in subscriber:
            header = subscriber.header
            if header is not None and header.node != self._network.node:
                self._on_value(self._topic, value)

    def _open(self) -> Subscriber[Any]:
        subscriber: Subscriber[Any] = Subscriber(self._topic, network=self._network)
        with self._lock:
            self._subscriber = subscriber
            if self._closing.is_set():
                subscriber.close()
        return subscriber


def _joined(network: PeerNetwork, closing: threading.Event, attempt: Callable[[], T]) -> T | None:
    """What ``attempt`` gives, as soon as there is a master; None when it is too late for it."""
    while not (closing.is_set() or network.closed):
        try:
            network.join()  # first: an attempt that fails would leave its half behind
            return attempt()
        except NetworkError as error:
            log.warning("programs of the original have to wait: %s", error.sentence)
            closing.wait(AGAIN_S)
    return None
