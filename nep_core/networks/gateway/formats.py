"""What programs of the original say: the requests to their master, and messages in their frames."""

from __future__ import annotations

import base64
import binascii
import contextlib
import json
from dataclasses import dataclass
from typing import Any, Literal, cast

import msgspec

from nep_core.errors import BadMessage, NetworkError
from nep_core.wire.frames import CANNOT_ENCODE, check_topic, to_json

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

CANNOT_DECODE = (ValueError, TypeError, RecursionError, msgspec.MsgspecError)


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
        return _read_json(payload)
    except CANNOT_DECODE as error:
        raise BadMessage(
            "A message on {topic} is not {kind}: {error}.", topic=topic, kind=kind, error=error
        ) from error


def write(value: Any, topic: str, kind: Kind, prefixed: bool) -> bytes:
    """A frame that holds ``value``; raises BadMessage when such a frame cannot hold it."""
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


def _read_json(payload: bytes | str) -> Any:
    value = _json(payload)
    if isinstance(value, str) and value[:1] in ("{", "["):  # 0.5.4.7 encodes twice
        with contextlib.suppress(*CANNOT_DECODE):
            return _json(value)
    return value


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
    told = _told(frame)
    topic = told.get("topic")
    if not isinstance(topic, str):
        raise BadMessage('The request has no "topic".')
    try:
        check_topic(topic)
    except NetworkError as error:
        raise BadMessage(error.sentence) from error
    paper = "node_name" in told and "node" not in told
    mode = _text(told, "mode", "one2many" if paper else "many2many")
    if mode not in MODES:
        raise BadMessage(
            "There is no mode {mode}: use one of {modes}.", mode=repr(mode), modes=", ".join(MODES)
        )
    socket = _text(told, "socket", "unknown")
    msg_type = _text(told, "msg_type", "json")
    return Request(
        node=_text(told, "node_name" if paper else "node", "default"),
        topic=topic,
        role=_role(socket),
        mode=cast(Mode, mode),
        socket=socket,
        msg_type=msg_type,
        shape=shape_of(msg_type, old),
        pid=_pid(told.get("pid")),
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
        topic = _told(frame).get("topic", "")
    except BadMessage:
        topic = ""
    answer = {"topic": topic, "port": 0, "ip": ip, "state": "failure", "error": sentence}
    return json.dumps(answer).encode()  # a topic of half a character is answered too


def _told(frame: bytes) -> dict[str, Any]:
    try:
        told = json.loads(frame)
    except (ValueError, RecursionError) as error:
        raise BadMessage("The request cannot be read: {error}.", error=error) from error
    if not isinstance(told, dict):
        raise BadMessage("The request is not a JSON object.")
    return told


def _text(told: dict[str, Any], key: str, default: str) -> str:
    """A text that can be sent on; whatever else is there counts as nothing."""
    value = told.get(key)
    if not isinstance(value, str):
        return default
    return value.encode(errors="replace").decode()


def _role(socket: str) -> Role:
    if socket in SERVICES:
        return "service"
    return cast(Role, socket) if socket in ("publisher", "subscriber") else "unknown"


def _pid(told: object) -> int:
    is_number = isinstance(told, int) and not isinstance(told, bool)
    return cast(int, told) if is_number and 0 < cast(int, told) <= MAX_PID else 0
