"""The central service of the broker network: an XSUB/XPUB proxy in a thread of its own."""

from __future__ import annotations

import contextlib
import threading

import zmq

from nep_core.endpoints import broker_endpoints
from nep_core.outbox import HIGH_WATER_MARK, bind


class Broker:
    """Passes messages from every publisher to every subscriber; raises PortTaken."""

    def __init__(self, endpoint: str | None = None) -> None:
        publishers_end, subscribers_end = broker_endpoints(endpoint)
        self._context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        self._publishers = self._open(zmq.XSUB)
        self._subscribers = self._open(zmq.XPUB)
        try:
            bind(self._publishers, publishers_end)
            bind(self._subscribers, subscribers_end)
        except BaseException:
            self._context.destroy(linger=0)
            raise
        self.endpoint = publishers_end
        self._thread = threading.Thread(target=self._run, name="nep-broker", daemon=True)
        self._thread.start()

    def wait(self, timeout_s: float | None = None) -> None:
        """Wait until the broker is closed."""
        self._thread.join(timeout_s)

    def close(self) -> None:
        """Stop passing messages on."""
        self._context.term()  # ends the proxy, whose thread then closes the sockets
        self._thread.join()

    def _open(self, kind: int) -> zmq.Socket[bytes]:
        socket = self._context.socket(kind)
        socket.linger = 0
        socket.sndhwm = socket.rcvhwm = HIGH_WATER_MARK
        return socket

    def _run(self) -> None:
        with contextlib.suppress(zmq.ContextTerminated):
            zmq.proxy(self._publishers, self._subscribers)
        self._publishers.close()
        self._subscribers.close()
