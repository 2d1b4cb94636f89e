"""The central service of the broker network: a proxy for its messages, a master for its names."""

from __future__ import annotations

import contextlib
import threading

import zmq

from nep_core import security
from nep_core.endpoints import broker_endpoints, broker_registry
from nep_core.master import Master
from nep_core.outbox import HIGH_WATER_MARK, bind


class Broker:
    """Passes messages from every publisher to every subscriber; raises PortTaken.

    Its master, two ports on, knows who is there and lets each name be used once.
    """

    def __init__(self, endpoint: str | None = None) -> None:
        publishers_end, subscribers_end = broker_endpoints(endpoint)
        self._context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        self._security = security.from_environment(self._context)
        self._publishers = self._open(zmq.XSUB)
        self._subscribers = self._open(zmq.XPUB)
        try:
            bind(self._publishers, publishers_end, self._security)
            bind(self._subscribers, subscribers_end, self._security)
            self._master = Master(broker_registry(endpoint))
        except BaseException:
            self._publishers.close()
            self._subscribers.close()
            self._context.term()
            raise
        self.endpoint = publishers_end
        self._thread = threading.Thread(target=self._run, name="nep-broker", daemon=True)
        self._thread.start()

    def wait(self, timeout_s: float | None = None) -> None:
        """Wait until the broker is closed."""
        self._thread.join(timeout_s)

    def take_warning(self) -> str:
        """Who was refused since the last time, and what to do; "" when nobody was."""
        told = (
            self._security.take_warning() if self._security else "",
            self._master.take_warning(),
        )
        return " ".join(dict.fromkeys(filter(None, told)))

    def close(self) -> None:
        """Stop passing messages on."""
        self._master.close()
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
