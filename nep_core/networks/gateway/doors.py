"""Where programs of the original NEP meet the gateway: its sockets, and what is said at them."""

from __future__ import annotations

import base64
import binascii
import contextlib
import json
import logging
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, cast

import msgspec
import zmq

from nep_core.errors import BadMessage, NetworkError
from nep_core.wire.frames import CANNOT_DECODE, CANNOT_ENCODE, check_topic, to_json
from nep_core.wire.io_thread import socket_event
from nep_core.wire.outbox import bind

# How programs of the original put messages into frames, and how our values become such frames.
#
# A frame is the payload alone ("bare"), or the topic, a space and the payload ("prefixed").

Kind = Literal["json", "text", "msgpack", "bytes", "image"]

KINDS: dict[str, Kind] = {
    "string": "text",
    "msgpack": "msgpack",
    "bytes": "bytes",
    "images": "image",
    "image": "image",
}
"""Every other message type of theirs is JSON."""


@dataclass(frozen=True)
class Shape:
    """What a program's frames of a topic look like."""

    prefixed: bool
    kind: Kind


def shape_of(msg_type: str, old: bool) -> Shape:
    """The shape that a program of the old or the new generation means by a message type."""
    kind = KINDS.get(msg_type, "json")
    if old:
        return Shape(kind in ("json", "text") or msg_type == "image", kind)
    return Shape(msg_type == "dictionary", kind)


def read(frame: bytes, topic: str, kind: Kind) -> Any:
    """The value in a frame: text, bytes, or what JSON and MessagePack can hold.

    Raises BadMessage.
    """
    try:
        if kind == "bytes":
            return frame
        if kind == "msgpack":
            return msgspec.msgpack.decode(frame)
        payload = frame.removeprefix(topic.encode() + b" ")
        if kind == "text":
            return payload.decode()
        if kind == "image":
            return base64.b64decode(payload, validate=True)
        value = _json(payload)
        if isinstance(value, str) and value[:1] in ("{", "["):  # 0.5.4.7 encodes twice
            with contextlib.suppress(*CANNOT_DECODE):
                return _json(value)
        return value
    except CANNOT_DECODE as error:
        raise BadMessage(
            "A message on {topic} is not {kind}: {error}.", topic=topic, kind=kind, error=error
        ) from error


def write(value: Any, topic: str, kind: Kind, prefixed: bool) -> bytes:
    """A frame that holds ``value``; raises BadMessage when such a frame cannot hold it.

    ``topic`` and ``kind`` (how messages are written) are those of the line; ``prefixed``: the
    topic stands before the message.
    """
    try:
        payload = _payload(value, kind)
    except (*CANNOT_ENCODE, binascii.Error) as error:
        raise BadMessage(
            "A message on {topic} cannot be sent as {kind}: {error}.",
            topic=topic,
            kind=kind,
            error=error,
        ) from error
    if not prefixed:
        return payload
    start = topic.encode()
    if kind == "json" and start.startswith(b"/"):
        # WORKAROUND: nep-js splits the frame wherever the topic occurs in it. In JSON, a slash
        # stands in texts only, where it may be written by its number.
        payload = payload.replace(start, b"\\u002f" + start[1:])
    return start + b" " + payload


def _json(payload: bytes | str) -> Any:
    try:
        return msgspec.json.decode(payload)
    except msgspec.MsgspecError:
        return json.loads(payload)  # theirs may hold NaN


def _payload(value: Any, kind: Kind) -> bytes:
    if kind == "msgpack":
        return msgspec.msgpack.encode(value)
    if isinstance(value, bytes):
        if kind == "image":
            return base64.b64encode(value)
        if kind == "bytes":
            return value
        raise TypeError("it is bytes")
    if kind == "image":
        raise TypeError("an image is bytes")
    if isinstance(value, str) and kind != "json":
        return value.encode()
    return to_json(value)


Mode = Literal["many2many", "one2many", "many2one"]
Role = Literal["publisher", "subscriber", "service", "unknown"]

MODES = ("many2many", "one2many", "many2one")
SERVICES = ("client", "server", "surveyor", "respondent")
MAX_PID = 2**31 - 1
LONGEST_NAME = 200
"""So many letters of a name are kept: whoever asks writes them, and all who look are told them."""


@dataclass(frozen=True)
class Request:
    """A program asks at which port it finds a topic.

    ``paper`` is how the paper's own programs ask: they do not say what they are going to do.
    """

    node: str
    topic: str
    role: Role
    mode: Mode
    socket: str
    msg_type: str
    shape: Shape
    pid: int = 0
    paper: bool = False


def read_request(frame: bytes, old: bool) -> Request:
    """Take a request in; raises BadMessage. Only the topic must be there."""
    told = _decoded(frame)
    topic = told.get("topic")
    if not isinstance(topic, str):
        raise BadMessage('The request has no "topic".')
    try:
        check_topic(topic)
    except NetworkError as error:
        raise BadMessage(error.sentence) from error
    if len(topic) > LONGEST_NAME:
        raise BadMessage("A topic here has {longest} letters at most.", longest=LONGEST_NAME)
    paper = "node_name" in told and "node" not in told
    mode = _text(told, "mode", "one2many" if paper else "many2many")
    if mode not in MODES:
        raise BadMessage(
            "There is no mode {mode}: use one of {modes}.", mode=repr(mode), modes=", ".join(MODES)
        )
    socket, pid = _text(told, "socket", "unknown"), told.get("pid")
    msg_type = _text(told, "msg_type", "json")
    return Request(
        node=_text(told, "node_name" if paper else "node", "default"),
        topic=topic,
        role=_role(socket),
        mode=cast(Mode, mode),
        socket=socket,
        msg_type=msg_type,
        shape=shape_of(msg_type, old),
        pid=pid if type(pid) is int and 0 < pid <= MAX_PID else 0,
        paper=paper,
    )


def granted(request: Request, port: int, ip: str) -> bytes:
    """The answer that names the port."""
    answer: dict[str, Any] = {"topic": request.topic, "port": port}
    if not request.paper:
        answer |= {"ip": ip, "socket": request.socket, "state": "success"}
        if request.role != "service":
            answer["mode"] = request.mode
    return to_json(answer)


def refused(frame: bytes, sentence: str, ip: str) -> bytes:
    """The answer to what cannot be: their clients go on without that topic.

    They would wait for ever for an answer that names another topic than they asked for.
    """
    try:
        topic = _decoded(frame).get("topic", "")
    except BadMessage:
        topic = ""
    if isinstance(topic, dict | list):  # it may be too deep to be written again
        topic = ""
    answer = {"topic": topic, "port": 0, "ip": ip, "state": "failure", "error": sentence}
    return json.dumps(answer).encode()  # a topic of half a character is answered too


def _decoded(frame: bytes) -> dict[str, Any]:
    try:
        told = json.loads(frame)
    except CANNOT_DECODE as error:
        raise BadMessage("The request cannot be read: {error}.", error=error) from error
    if not isinstance(told, dict):
        raise BadMessage("The request is not a JSON object.")
    return told


def _text(told: dict[str, Any], key: str, default: str) -> str:
    """A text that can be sent on; whatever else is there counts as nothing."""
    value = told.get(key)
    if not isinstance(value, str):
        return default
    return value[:LONGEST_NAME].encode(errors="replace").decode()


def _role(socket: str) -> Role:
    if socket in SERVICES:
        return "service"
    return cast(Role, socket) if socket in ("publisher", "subscriber") else "unknown"


# The sockets at which programs of the original meet the gateway, and who is connected to them.

log = logging.getLogger(__name__)


class Watch:
    """Waits on many sockets and calls what belongs to the one that has something; one thread."""

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


ARRIVALS = zmq.Event.ACCEPTED | zmq.Event.CONNECTED
DEPARTURES = zmq.Event.DISCONNECTED | zmq.Event.CLOSED
AT_A_TIME = 100
"""So many frames are taken from one door before the others have their turn."""

Context = zmq.Context[zmq.Socket[bytes]]


class Door(ABC):
    """One socket; ``connections`` are the file numbers of those who are connected to it.

    ``on_change`` is called when somebody came or left.
    """

    kind: int

    def __init__(self, context: Context, watch: Watch, on_change: Callable[[], None]) -> None:
        self.connections: set[int] = set()
        self._on_change = on_change
        self._watch = watch
        self._socket = context.socket(self.kind)
        self._socket.linger = 0
        self._socket.reconnect_ivl_max = 1000
        self._monitor = self._socket.get_monitor_socket(ARRIVALS | DEPARTURES)
        watch.add(self._socket, self._receive)
        watch.add(self._monitor, self._note)

    def bind(self, endpoint: str) -> None:
        """Let programs connect; raises PortTaken."""
        bind(self._socket, endpoint, is_watched=False)

    def connect(self, endpoint: str) -> None:
        """Go to a program that binds."""
        self._socket.connect(endpoint)

    def close(self) -> None:
        """Free the port."""
        self._watch.forget(self._monitor)
        self._watch.forget(self._socket)
        self._socket.disable_monitor()
        self._monitor.close()
        self._socket.close()

    @abstractmethod
    def _receive(self) -> None:
        """Take what the socket has."""

    def _note(self) -> None:
        event = socket_event(self._monitor.recv_multipart(zmq.NOBLOCK))
        change = set.add if event.kind & ARRIVALS else set.discard
        change(self.connections, event.value)
        self._on_change()


class WayIn(Door):
    """Takes what programs publish.

    ``context`` makes its socket, which ``watch`` lets the gateway's thread look at;
    ``on_change`` is called when programs come or go, ``on_frame`` with each frame.
    """

    kind = zmq.SUB

    def __init__(
        self,
        context: Context,
        watch: Watch,
        on_change: Callable[[], None],
        on_frame: Callable[[bytes], None],
    ) -> None:
        super().__init__(context, watch, on_change)
        self._on_frame = on_frame
        self._socket.subscribe(b"")

    def _receive(self) -> None:
        for _ in range(AT_A_TIME):
            try:
                frames = self._socket.recv_multipart(zmq.NOBLOCK)
            except zmq.Again:
                return
            self._on_frame(b" ".join(frames))


MOST_WAITING, MOST_WAITING_BYTES = 1000, 64_000_000
"""So many frames, and so many bytes, wait for a program that does not read."""


class WayOut(Door):
    """Gives programs what they subscribe to; ``wanted`` are their subscriptions.

    They tell what their program reads: bare frames if it takes everything, else prefixed ones.

    ``context`` makes its socket, which ``watch`` lets the gateway's thread look at;
    ``on_change`` is called when programs come or go; ``topic`` and ``shape`` are what it gives.
    """

    kind = zmq.XPUB

    def __init__(
        self,
        context: Context,
        watch: Watch,
        on_change: Callable[[], None],
        topic: str,
        shape: Shape,
    ) -> None:
        super().__init__(context, watch, on_change)
        self.wanted: set[bytes] = set()
        self._most = 0
        self.shape = shape
        self._topic = topic

    def send(self, value: object) -> None:
        """Give all who are here a value; raises BadMessage."""
        self._give(write(value, self._topic, self.shape.kind, self._prefixed))

    def takes(self, frame: bytes, shape: Shape) -> bool:
        """Send on, as it is, a frame that the programs here read; else False."""
        is_read = shape == self.shape
        if is_read and shape.kind == "json":  # 0.5.4.6 asks like later ones, but has prefixes
            is_read = frame.startswith(self._topic.encode() + b" ") == self._prefixed
        if is_read:
            self._give(frame)
        return is_read

    def _give(self, frame: bytes) -> None:
        # ZeroMQ counts frames: the larger they are, the fewer may wait
        most = max(1, min(MOST_WAITING, MOST_WAITING_BYTES // max(1, len(frame))))
        if most != self._most:
            self._socket.sndhwm = self._most = most  # of those who are connected, too
        self._socket.send(frame)

    @property
    def _prefixed(self) -> bool:
        return b"" not in self.wanted

    def _receive(self) -> None:
        event = self._socket.recv(zmq.NOBLOCK)
        if event[:1] in (b"\0", b"\1"):
            (set.add if event[0] else set.discard)(self.wanted, event[1:])
            self._on_change()


WARN_S = 1.0


class Warner:
    """Warns at most once a second, so that a flood of faults is no flood of words; any thread."""

    def __init__(self) -> None:
        self._next_s = 0.0

    def __call__(self, sentence: str) -> None:
        """Warn, unless it is too soon."""
        if time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + WARN_S
            log.warning("%s", sentence)
