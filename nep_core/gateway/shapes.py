"""How programs of the original put messages into frames, and how our values become such frames.

A frame is the payload alone ("bare"), or the topic, a space and the payload ("prefixed").
"""

from __future__ import annotations

import base64
import binascii
import contextlib
import json
from dataclasses import dataclass
from typing import Any, Literal

import msgspec

from nep_core.errors import BadMessage
from nep_core.frames import CANNOT_ENCODE, to_json

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
        raise BadMessage(f"A message on {topic} is not {kind}: {error}.") from error


def write(value: Any, topic: str, kind: Kind, prefixed: bool) -> bytes:
    """A frame that holds ``value``; raises BadMessage when such a frame cannot hold it."""
    try:
        payload = _payload(value, kind)
    except (*CANNOT_ENCODE, binascii.Error) as error:
        raise BadMessage(f"A message on {topic} cannot be sent as {kind}: {error}.") from error
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
