"""Messages as ZeroMQ frames: ``topic NUL header NUL payload [NUL payload ...]``.

The header is a JSON array ``[node, sequence number of the first payload, time, encoding]``. The
NUL behind the topic matters: ZeroMQ matches subscriptions by prefix, and ``/gesture`` must not
receive ``/gesture_debug``. Only JSON payloads, which hold no NUL, may share a frame. Frames
whose first byte is NUL are private: see handshake.py.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, NamedTuple

import msgspec

from nep_core.errors import BadMessage, NetworkError

Encoding = Literal["json", "text", "msgpack", "bytes"]
Sendable = msgspec.Struct | dict[str, Any] | list[Any] | str | bytes

NUL = b"\0"


class Header(msgspec.Struct, array_like=True):
    """Who sent a message: node, number in the sequence of its topic, time in s, encoding."""

    node: str
    sequence: int
    time: float
    encoding: Encoding = "json"


class Frame(NamedTuple):
    """A frame taken apart; the payloads are still encoded."""

    header: Header
    payloads: list[bytes]


_to_json = msgspec.json.Encoder().encode
_encode_msgpack = msgspec.msgpack.Encoder().encode
_CANNOT_ENCODE = (TypeError, ValueError, OverflowError, RecursionError, msgspec.MsgspecError)
_decode_header = msgspec.json.Decoder(Header).decode


def check_topic(topic: str) -> None:
    """Raise NetworkError unless ``topic`` can travel: not empty, no NUL, within UTF-8."""
    try:
        usable = bool(topic) and b"\0" not in topic.encode()
    except UnicodeEncodeError:
        usable = False
    if not usable:
        raise NetworkError(
            f"{topic!r} cannot be a topic: a topic has at least one character and no NUL.",
            checklist=('Use a name such as "/human_behavior".',),
        )


def subscription(topic: str) -> bytes:
    """The ZeroMQ subscription that gets ``topic`` and no other."""
    return topic.encode() + NUL


def frame_start(topic: str, node: str) -> bytes:
    """The part of a publisher's frames that stays the same: topic, NUL, ``[node,``."""
    return subscription(topic) + b"[" + _to_json(node) + b","


def join(
    start: bytes, sequence: int, time_s: float, encoding: bytes, payloads: list[bytes]
) -> bytes:
    """A frame from its start (see frame_start), header values and payloads."""
    head = b'%b%d,%.6f,"%b"]' % (start, sequence, time_s, encoding)
    return NUL.join([head, *payloads])


def split(frame: bytes) -> Frame:
    """Take a frame apart; raises BadMessage when it is not one of ours."""
    parts = frame.split(NUL)
    if len(parts) < 3:
        raise BadMessage("A frame has no header: its sender does not speak NEP.")
    try:
        header = _decode_header(parts[1])
    except msgspec.MsgspecError as error:
        raise BadMessage(f"A frame has an unreadable header: {error}.") from error
    return Frame(header, parts[2:] if header.encoding == "json" else [NUL.join(parts[2:])])


def natural_encoding(message: Sendable) -> Encoding:
    """Text as text, bytes as bytes, all else as JSON."""
    if isinstance(message, str):
        return "text"
    return "bytes" if isinstance(message, bytes) else "json"


def encode_json(message: Sendable) -> bytes:
    """``message`` as JSON; raises BadMessage when it cannot be."""
    try:
        return _to_json(message)
    except _CANNOT_ENCODE as error:
        raise _not_encodable("json", error) from error


def encode(message: Sendable, encoding: Encoding) -> bytes:
    """The payload of ``message``; raises BadMessage when it cannot be encoded so."""
    try:
        if encoding == "text" and isinstance(message, str):
            return message.encode()
        if encoding == "bytes" and isinstance(message, bytes):
            return message
        if encoding == "msgpack":
            return _encode_msgpack(message)
    except _CANNOT_ENCODE as error:
        raise _not_encodable(encoding, error) from error
    if encoding == "json":
        return encode_json(message)
    raise BadMessage(f"A {type(message).__name__} cannot be sent as {encoding}.")


def _not_encodable(encoding: Encoding, error: Exception) -> BadMessage:
    return BadMessage(
        f"A message cannot be sent as {encoding}: {error}.",
        checklist=("Send a dictionary of text, numbers, yes/no values and lists.",),
    )


Decode = Callable[[bytes], Any]


def decoders(kind: type[Any] | None) -> dict[Encoding, Decode]:
    """How to decode payloads of each encoding into ``kind`` (None: whatever is there).

    They raise msgspec.MsgspecError or UnicodeDecodeError, naming the key that is missing or wrong.
    """
    wanted = Any if kind is None else kind
    ways: dict[Encoding, Decode] = {
        "json": msgspec.json.Decoder(wanted).decode,
        "msgpack": msgspec.msgpack.Decoder(wanted).decode,
    }
    if kind is None:
        ways["text"] = bytes.decode
        ways["bytes"] = bytes
    return ways
