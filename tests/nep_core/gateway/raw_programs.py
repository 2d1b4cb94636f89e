"""Programs of the original as bare sockets: what they ask, publish and hear, frame by frame."""

from __future__ import annotations

import json
import os
import random
import socket
import time
from collections.abc import Callable
from typing import Any

import zmq

from nep_core.networks.gateway.gateway import Ports

WAIT_MS = 10_000


def free_ports() -> Ports:
    """Ports that nobody used a moment ago; those of topics are none that a connection may get."""
    with socket.socket() as a, socket.socket() as b, socket.socket() as c:
        numbers = []
        for probe in (a, b, c):
            probe.bind(("127.0.0.1", 0))
            numbers.append(int(probe.getsockname()[1]))
    of_this_process = 12_000 + os.getpid() % 90 * 200  # tests run side by side
    return Ports(*numbers, of_this_process + random.randrange(0, 200, 2))


def is_free(port: int) -> bool:
    """Whether nobody is bound to the port."""
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) != 0


def until(is_so: Callable[[], bool], timeout_s: float = 10.0) -> None:
    """Wait until something is so."""
    deadline = time.monotonic() + timeout_s
    while not is_so():
        assert time.monotonic() < deadline, "it did not become so"
        time.sleep(0.01)


class RawPrograms:
    """Old ones ask at one port, new ones at the other."""

    def __init__(self, ports: Ports) -> None:
        self.ports = ports
        self._context = zmq.Context()
        self._opened: list[zmq.Socket[bytes]] = []

    def ask(self, frame: bytes, old: bool = False) -> dict[str, Any]:
        """The answer to any bytes."""
        with self._context.socket(zmq.REQ) as asking:
            asking.linger = 0
            asking.rcvtimeo = WAIT_MS
            asking.connect(self.at(self.ports.old if old else self.ports.new))
            asking.send(frame)
            return json.loads(asking.recv())

    def register(self, topic: str, role: str, *, old: bool = False, **more: object) -> int:
        """The port that a program is told; its process is this one unless ``more`` has another."""
        request = {"node": "raw", "topic": topic, "socket": role, "mode": "many2many"}
        request |= {"pid": os.getpid(), "msg_type": "json"} | more
        answer = self.ask(json.dumps(request).encode(), old)
        assert answer["state"] == "success", answer
        return int(answer["port"])

    def publisher(self, port: int, *, binds: bool = False) -> zmq.Socket[bytes]:
        """One that knows the gateway's subscription, so that nothing is lost."""
        publisher = self._open(zmq.XPUB, port, binds)
        publisher.recv()
        return publisher

    def reader(self, port: int, prefix: str = "", *, binds: bool = False) -> zmq.Socket[bytes]:
        """One that hears frames which begin with the prefix."""
        reader = self._open(zmq.SUB, port, binds)
        reader.subscribe(prefix)
        return reader

    def at(self, port: int) -> str:
        return f"tcp://127.0.0.1:{port}"

    def close(self) -> None:
        for opened in self._opened:
            opened.close()
        self._context.term()

    def _open(self, kind: int, port: int, binds: bool) -> zmq.Socket[bytes]:
        opened = self._context.socket(kind)
        self._opened.append(opened)
        opened.linger = 0
        opened.rcvtimeo = WAIT_MS
        opened.rcvhwm = opened.sndhwm = 0
        (opened.bind if binds else opened.connect)(self.at(port))
        return opened
