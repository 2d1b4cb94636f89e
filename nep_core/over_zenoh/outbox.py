"""The sending side of a zenoh network: its streams, and who hears them."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from nep_core import handshake
from nep_core.errors import NetworkError
from nep_core.frames import Encoding
from nep_core.hearers import Hearers, SendFrame
from nep_core.over_zenoh.keys import frames_key, hears_token, last_part
from nep_core.stream import Stream

if TYPE_CHECKING:
    import zenoh


class ZenohOutbox:
    """Sends in the caller's thread; the I/O thread, which ``wake`` calls, welcomes who comes."""

    def __init__(
        self,
        session: zenoh.Session,
        node: str,
        instance: str,
        *,
        hurry: Callable[[], None],
        wake: Callable[[], None],
    ) -> None:
        self._session = session
        self._node = node
        self._instance = instance
        self._wake = wake
        self._watched: set[str] = set()
        self._seen: deque[handshake.Seen] = deque()
        self._hearers = Hearers(
            node,
            instance,
            lock=threading.Lock(),
            sender=self._sender,
            send_privately=self._send_privately,
            hurry=hurry,
        )
        self.stream: Callable[[str, Encoding | None], Stream] = self._hearers.stream
        self.subscribers = self._hearers.subscribers
        self.wait_for = self._hearers.wait_for
        self.abandon = self._hearers.abandon

    def watch(self, topic: str) -> None:
        """Welcome the subscribers of ``topic``: those that are there and those that come."""
        import zenoh

        if topic in self._watched:
            return
        self._watched.add(topic)
        # In zenoh's own thread it may not wait for anything: the I/O thread does the rest.
        on_change = zenoh.handlers.Callback(partial(self._on_change, topic), indirect=False)
        self._session.liveliness().declare_subscriber(hears_token(topic), on_change, history=True)

    def tend(self) -> None:
        """Note who came and left, welcome the newcomers, send what waits."""
        while self._seen:
            seen = self._seen.popleft()
            self._hearers.note(seen.topic, seen.subscriber, seen.present)
            if seen.present:  # the router does not say who is slow
                self._hearers.note_slow(seen.topic, seen.subscriber)
        self._hearers.tend()

    def close(self) -> None:
        """Send what waits; closing the session sends what zenoh still has."""
        self._hearers.flush()

    def _sender(self, topic: str) -> SendFrame:
        import zenoh

        try:
            put = self._session.declare_publisher(
                frames_key(topic), congestion_control=zenoh.CongestionControl.DROP
            ).put
        except zenoh.ZError as error:
            raise self._closed() from error

        def send(frame: bytes) -> None:
            try:
                put(frame)
            except zenoh.ZError as error:
                raise self._closed() from error

        return send

    def _closed(self) -> NetworkError:
        return NetworkError(
            f"The network of {self._node} is closed.", checklist=("Start it again.",)
        )

    def _send_privately(self, topic: str, subscriber: str, notice: bytes) -> None:
        frame = handshake.private_frame(topic, subscriber, self._instance, notice)
        self._session.put(frames_key(topic, subscriber), frame)

    def _on_change(self, topic: str, sample: zenoh.Sample) -> None:
        import zenoh

        present = sample.kind == zenoh.SampleKind.PUT
        self._seen.append(handshake.Seen(present, topic, last_part(str(sample.key_expr))))
        self._wake()
