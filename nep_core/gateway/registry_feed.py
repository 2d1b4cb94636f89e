"""Tells programs of the original which topics they have: their master's port 7777."""

from __future__ import annotations

from typing import Any

import zmq

from nep_core.frames import to_json
from nep_core.gateway.doors import Context
from nep_core.gateway.lines import Line
from nep_core.gateway.watch import Watch
from nep_core.outbox import bind

TOPIC = b"master"
"""The old generation subscribes to it; the new one to everything, and reads bare JSON."""


def registry(lines: list[Line], host: str) -> dict[str, Any]:
    """What the original's master would publish; a topic shows the port of its first line."""
    topics: dict[str, Any] = {}
    for line in lines:
        asked = line.request
        shown = {"port": line.port, "socket": asked.socket, "ip": host}
        if asked.role != "service":
            shown["mode"] = asked.mode
        shown |= {"msg_type": asked.msg_type, "nodes": {}}
        nodes = topics.setdefault(asked.topic, shown)["nodes"]
        for program in line.programs:
            pid = program.pid or "n.a."
            nodes[program.node] = {"socket": program.socket, "pid": pid, "ip": host}
    return topics


class RegistryFeed:
    """Publishes the registry at each change, and when somebody begins to listen.

    Both generations share the port: those who want everything get only what begins like JSON.
    """

    def __init__(self, context: Context, watch: Watch, endpoint: str) -> None:
        self._watch = watch
        self._shown: dict[str, Any] = {}
        self._socket = context.socket(zmq.XPUB)
        self._socket.linger = 0
        self._socket.setsockopt(zmq.XPUB_MANUAL, 1)
        try:
            bind(self._socket, endpoint)
        except BaseException:
            self._socket.close()
            raise
        watch.add(self._socket, self._receive)

    def show(self, shown: dict[str, Any]) -> None:
        """Publish this from now on."""
        self._shown = shown
        frame = to_json(shown)
        self._socket.send(frame)
        self._socket.send(TOPIC + b" " + frame)

    def close(self) -> None:
        """Free the port."""
        self._watch.forget(self._socket)
        self._socket.close()

    def _receive(self) -> None:
        event = self._socket.recv(zmq.NOBLOCK)
        if event[:1] == b"\1":
            self._socket.setsockopt(zmq.SUBSCRIBE, event[1:] or b"{")
            self.show(self._shown)
        elif event[:1] == b"\0":
            self._socket.setsockopt(zmq.UNSUBSCRIBE, event[1:] or b"{")
