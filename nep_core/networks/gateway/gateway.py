"""The gateway: to programs of the original it is their master, to us it is one more program."""

from __future__ import annotations

import logging
import queue
import threading
import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Literal

import zmq

from nep_core.errors import BadMessage, NetworkError, PortTaken
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.frames import to_json
from nep_core.wire.io_thread import Wake
from nep_core.wire.outbox import bind

from .doors import Context, Shape, Warner, Watch, WayOut, granted, read, read_request, refused
from .lines import Line, Lines, Listener, Speaker, recall, remember

log = logging.getLogger(__name__)


# Tells programs of the original which topics they have: their master's port 7777.

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
            bind(self._socket, endpoint, is_watched=False)
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


NODE = "original-nep"
SWEEP_S = 0.25
WAITING = 1000
"""Messages of ours that may wait for the original's programs; the others wait in our network."""
MAX_SOCKETS = 8000
MAX_REQUEST = 1_000_000

Encoding = Literal["msgpack"] | None


@dataclass(frozen=True)
class Ports:
    """Where programs of the original look: they have these numbers built in.

    ``old`` and ``new`` are for requests; topics get ports from ``topics`` on.
    """

    old: int = 7000
    new: int = 50000
    registry: int = 7777
    topics: int = 9000


class Gateway:
    """Serves in a thread of its own, and costs nothing until a program of the original comes.

    ``troubles`` are sentences about ports that other programs use; raises PortTaken when no
    request could come. ``memory`` is a file by which a gateway that is started anew serves the
    programs of the one before.

    ``master`` is the endpoint of ours, ``host`` the address at which programs reach the
    gateway, ``node`` its name in the network, ``ports`` where it listens (None: where the
    original does).
    """

    def __init__(
        self,
        master: str,
        ports: Ports | None = None,
        *,
        host: str = "127.0.0.1",
        node: str = NODE,
        memory: Path | None = None,
    ) -> None:
        self.ports = ports or Ports()
        self.troubles: list[str] = []
        self._master = master
        self._host = host
        self._node = node
        self._memory = memory
        self._network: PeerNetwork | None = None
        self._speakers: dict[tuple[str, Encoding], Speaker] = {}
        self._listeners: dict[str, Listener] = {}
        self._arrived: queue.Queue[tuple[str, Any]] = queue.Queue(WAITING)
        self._warn = Warner()
        self._stopping = threading.Event()
        self._wake = Wake()
        self._context: Context = zmq.Context()
        self._context.max_sockets = MAX_SOCKETS
        self._watch = Watch()
        self._watch.add(self._wake.fileno(), self._pass_on_arrived)
        self._lines = Lines(
            self._context, self._watch, host, self.ports.topics, self._pass_on, self._open_topic
        )
        try:
            self._feed = self._open_ports()
        except BaseException:
            self._context.destroy(linger=0)
            self._wake.close()
            raise
        if memory is not None and (kept := recall(memory)):
            self._lines.reopen(kept)
            self._tell_registry()
        self._thread = threading.Thread(target=self._run, name="nep-gateway", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Free all ports and leave our network."""
        self._stopping.set()
        self._wake()
        self._thread.join()
        ours: list[Speaker | Listener] = [*self._speakers.values(), *self._listeners.values()]
        for side in ours:
            side.close()
        if self._network is not None:
            for side in ours:
                side.wait()
            self._network.close()
        self._context.destroy(linger=0)
        self._wake.close()

    def _open_ports(self) -> RegistryFeed | None:
        troubles: list[PortTaken] = []
        for port, old in ((self.ports.old, True), (self.ports.new, False)):
            socket = self._context.socket(zmq.REP)
            socket.linger = 200
            socket.maxmsgsize = MAX_REQUEST
            try:
                bind(socket, self._endpoint(port), is_watched=False)
            except PortTaken as error:
                socket.close()
                troubles.append(error)
                generation = "up to 0.5.4.5 and nep-js" if old else "from 0.5.4.6 on"
                self.troubles.append(
                    f"Programs of the original NEP {generation} cannot join: port {port} is used "
                    "by another program."
                )
                continue
            self._watch.add(socket, partial(self._serve, socket, old))
        if len(troubles) > 1:
            raise troubles[0]
        try:
            return RegistryFeed(self._context, self._watch, self._endpoint(self.ports.registry))
        except PortTaken:
            self.troubles.append(
                "Programs of the original NEP get no list of topics: port "
                f"{self.ports.registry} is used by another program."
            )
            return None

    def _endpoint(self, port: int) -> str:
        return f"tcp://{self._host}:{port}"

    def _run(self) -> None:
        next_sweep_s = 0.0
        while not self._stopping.is_set():
            try:
                self._watch.once(SWEEP_S if self._lines.all else 60.0)
                if time.monotonic() >= next_sweep_s:
                    next_sweep_s = time.monotonic() + SWEEP_S
                    self._sweep()
            except Exception:  # a fault of ours must not end everybody's master
                log.exception("the gateway goes on after an error")
                self._stopping.wait(0.05)
        self._lines.close()

    def _serve(self, socket: zmq.Socket[bytes], old: bool) -> None:
        frame = socket.recv_multipart(zmq.NOBLOCK)[-1]
        try:
            answer = self._answer(frame, old)
        except NetworkError as error:
            self._warn(f"A program of the original asked in vain: {error.sentence}")
            answer = refused(frame, str(error), self._host)
        except Exception:
            log.exception("a program of the original could not be answered well")
            answer = refused(frame, "The gateway could not open the topic.", self._host)
        socket.send(answer)

    def _answer(self, frame: bytes, old: bool) -> bytes:
        request = read_request(frame, old)
        port = self._lines.ask(request)
        self._tell_registry()
        return granted(request, port, self._host)

    def _tell_registry(self) -> None:
        if self._memory is not None:
            remember(self._memory, self._lines.kept())
        if self._feed is not None:
            self._feed.show(registry(self._lines.all, self._host))

    def _sweep(self) -> None:
        if self._lines.sweep():
            self._tell_registry()
        for key in [key for key in self._speakers if not self._is_spoken(*key)]:
            self._speakers.pop(key).close()
        for topic in [topic for topic in self._listeners if not self._wanted(topic)]:
            self._listeners.pop(topic).close()

    def _open_topic(self, topic: str) -> None:
        """Take part in a topic as soon as a program of the original is there."""
        if self._stopping.is_set():
            return
        for encoding in {_encoding(line.request.shape) for line in self._lines.of(topic)}:
            if self._is_spoken(topic, encoding):
                self._speaker(topic, encoding)
        if topic not in self._listeners and self._wanted(topic):
            self._listeners[topic] = Listener(self._ours(), topic, self._take_ours)

    def _speaker(self, topic: str, encoding: Encoding) -> Speaker:
        key = (topic, encoding)
        if key not in self._speakers:
            self._speakers[key] = Speaker(self._ours(), topic, encoding)
        return self._speakers[key]

    def _ours(self) -> PeerNetwork:
        if self._network is None:
            self._network = PeerNetwork(self._node, master=self._master)
        return self._network

    def _is_spoken(self, topic: str, encoding: Encoding) -> bool:
        return any(
            way.connections
            for line in self._lines.of(topic)
            if _encoding(line.request.shape) == encoding
            for way in line.ways_in
        )

    def _pass_on(self, topic: str, shape: Shape, frame: bytes) -> None:
        """A program of the original says something: others like it get the frame as it is."""
        others = [way for way in self._wanted(topic) if not way.takes(frame, shape)]
        try:
            value = read(frame, topic, shape.kind)
        except BadMessage as error:
            self._warn(str(error))
            return
        self._give(others, value)
        self._speaker(topic, _encoding(shape)).say(value, len(frame))

    def _take_ours(self, topic: str, value: Any) -> None:
        """Our network says something (in a thread of the listener)."""
        while not self._stopping.is_set():
            try:
                self._arrived.put((topic, value), timeout=SWEEP_S)
            except queue.Full:
                continue
            self._wake()
            return

    def _pass_on_arrived(self) -> None:
        self._wake.clear()
        for _ in range(WAITING):
            try:
                topic, value = self._arrived.get_nowait()
            except queue.Empty:
                return
            self._give(self._wanted(topic), value)
        self._wake()

    def _wanted(self, topic: str) -> list[WayOut]:
        ways = [way for line in self._lines.of(topic) for way in line.ways_out]
        return [way for way in ways if way.wanted]

    def _give(self, ways: list[WayOut], value: Any) -> None:
        """Give a value to programs of the original, each in its shape."""
        for way in ways:
            try:
                way.send(value)
            except BadMessage as error:
                self._warn(str(error))


def _encoding(shape: Shape) -> Encoding:
    return "msgpack" if shape.kind == "msgpack" else None
