"""Waits on many sockets and calls what belongs to the one that has something."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

import zmq


class Watch:
    """Belongs to one thread."""

    def __init__(self) -> None:
        self._poller = zmq.Poller()
        self._calls: dict[Any, Callable[[], None]] = {}

    def add(self, readable: zmq.Socket[bytes] | int, call: Callable[[], None]) -> None:
        """Call ``call`` whenever this socket or file number has something.

        It must not wait: a REP socket has something when a request without a head has come, which
        ZeroMQ then keeps to itself.
        """
        self._poller.register(readable, zmq.POLLIN)
        self._calls[readable] = call

    def forget(self, readable: zmq.Socket[bytes] | int) -> None:
        """Watch it no more."""
        self._poller.unregister(readable)
        del self._calls[readable]

    def once(self, timeout_s: float) -> None:
        """Wait for something, and call what belongs to it."""
        for readable, _ in self._poller.poll(round(timeout_s * 1000)):
            call = self._calls.get(readable)
            if call is not None:  # an earlier call may have closed it
                with contextlib.suppress(zmq.Again):  # it was nothing that ZeroMQ gives us
                    call()
