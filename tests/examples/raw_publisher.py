"""A publisher of a few lines of ZeroMQ, written from docs/wire.md: it can also do it wrong."""

from __future__ import annotations

import json
import os
import socket
from typing import Any, Self

import zmq

WAIT_MS = 10_000


class RawPublisher:
    """Publishes ``/imu`` as the node "raw"; its messages have the numbers that it is given."""

    def __init__(self, master: str, run: str = "11aa22bb") -> None:
        self._context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        self._master = self._context.socket(zmq.DEALER)
        self._out = self._context.socket(zmq.XPUB)
        self._out.bind("tcp://127.0.0.1:*")
        self._master.connect(master)
        self._run = run
        self.private = b""

    def register(self) -> None:
        """Tell the master, and wait until somebody hears us."""
        registration = {
            "instance": f"{self._run}00",
            "node": "raw",
            "pid": os.getpid(),
            "host": socket.gethostname(),
            "endpoint": self._out.getsockopt_string(zmq.LAST_ENDPOINT),
            "publishes": ["/imu"],
            "subscribes": {},
        }
        request = {"do": "register", "version": 1, "epoch": "", "registration": registration}
        self._master.send(json.dumps(request).encode())
        while not self.private:
            assert self._out.poll(WAIT_MS)
            event = self._out.recv()
            self.private = event[1:] if event.startswith(b"\1\xffs/imu\0") else b""

    def send(self, number: int, *messages: dict[str, Any]) -> None:
        """Send a frame with these messages."""
        payloads = [json.dumps(message).encode() for message in messages]
        self._out.send(b"\0".join([b"/imu", self._header(number), *payloads]))

    def send_notice(self, number: int, sent: int, *messages: dict[str, Any]) -> None:
        """Tell the subscriber how many messages were sent, perhaps with the latched one."""
        payloads = [json.dumps(message).encode() for message in messages]
        notice = b"\0".join([b"/imu", self._header(number, sent), *payloads])
        self._out.send(self.private + self._run.encode() + b"00\0" + notice)

    def _header(self, number: int, *more: int) -> bytes:
        header = ["raw", number, 1767225600000000000, "json", self._run, *more]
        return json.dumps(header, separators=(",", ":")).encode()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self._context.destroy(linger=0)
