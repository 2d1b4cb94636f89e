"""Messages as ZeroMQ frames: ``topic NUL header NUL payload [NUL payload ...]``.

The header is a JSON array ``[node, number of the first payload, time in ns, encoding, run]``;
``run`` is text that differs each time that a publisher's program starts: its numbers begin at 1
again. The NUL behind the topic matters: ZeroMQ matches subscriptions by prefix, and ``/gesture``
must not receive ``/gesture_debug``. Only JSON payloads, which hold no NUL, may share a frame.
Frames whose first byte is 0xFF are private: see outbox.py. What they bring is a *notice*: its
header has a sixth value, how many messages were sent so far; without a payload it is a *mark*.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Callable
from typing import Annotated, Any, Literal

import msgspec

from nep_core.errors import BadMessage, NetworkError

Encoding = Literal["json", "text", "msgpack", "bytes"]
Sendable = msgspec.Struct | dict[str, Any] | list[Any] | str | bytes

NUL = b"\0"
RUN_CHARACTERS = 8
MOST = 2**63 - 1
"""The largest number in a header: files and other languages count with 64 bits."""
MOST_TOGETHER = 20_000
"""So many messages share a frame at most, of which ours have 16 KB: a stranger's 50 MB of nothing
but ends would keep who reads them busy for minutes."""
JSON_HEAD = slice(-18, -10)
JSON_MARK = b'"json","'
"""head[JSON_HEAD] == JSON_MARK in a frame of JSON: what is frequent is found without decoding."""


class Header(msgspec.Struct, array_like=True):
    """Who sent a message: node, number in its topic's sequence, time in ns since 1970, encoding.

    ``run`` is the first characters of the sending network's instance ("": not told). ``sent`` is
    None but in notices.
    """

    node: str
    sequence: Annotated[int, msgspec.Meta(ge=0, le=MOST)]
    time_ns: Annotated[int, msgspec.Meta(ge=0, le=MOST)]
    encoding: Encoding = "json"
    run: str = ""
    sent: Annotated[int, msgspec.Meta(ge=0, le=MOST)] | None = None


to_json = msgspec.json.Encoder().encode
_encode_msgpack = msgspec.msgpack.Encoder().encode
CANNOT_ENCODE = (TypeError, ValueError, OverflowError, RecursionError, msgspec.MsgspecError)
CANNOT_DECODE = (ValueError, TypeError, RecursionError, OverflowError, MemoryError)
"""All that decoding what others sent can raise: msgspec's own errors are ValueErrors, as is text
that is not UTF-8; and what is nested a thousand deep is a RecursionError."""
_decode_header = msgspec.json.Decoder(Header).decode


def check_topic(topic: str) -> None:
    """Raise NetworkError unless ``topic`` can travel: not empty, and no control characters."""
    if not topic or has_controls(topic):
        raise NetworkError(
            "{topic} cannot be a topic: a topic has at least one character, and no control "
            "characters.",
            checklist=('Use a name such as "/human_behavior".',),
            topic=repr(topic),
        )


_CONTROLS = frozenset(("Cc", "Cs", "Zl", "Zp"))
"""NUL and all else that a terminal obeys, halves of letters (not within UTF-8), ends of lines."""


def has_controls(name: str) -> bool:
    """Whether there is something in a name that a terminal obeys, or that forges a line."""
    return any(unicodedata.category(letter) in _CONTROLS for letter in name)


def subscription(topic: str) -> bytes:
    """The ZeroMQ subscription that gets ``topic`` and no other."""
    return topic.encode() + NUL


def join(
    start: bytes,
    node: str,
    sequence: int,
    time_ns: int,
    encoding: Encoding,
    payload: bytes,
    run: str = "",
) -> bytes:
    """A frame from its start (the subscription to its topic), header values and payload(s).

    ``node`` is the sender and ``run`` its run, ``sequence`` the number of the (first) message,
    ``time_ns`` when it was sent (Unix), ``encoding`` how ``payload`` is written.
    """
    return start + to_json((node, sequence, time_ns, encoding, run)) + NUL + payload


def mark(topic: str, node: str, run: str, sent: int) -> bytes:
    """A notice that only tells how many messages were sent on ``topic`` so far.

    ``node`` is the sender, ``run`` its run.
    """
    return subscription(topic) + to_json((node, sent, 0, "json", run, sent))


def notice(frame: bytes, sent: int) -> bytes:
    """``frame``, which was sent before, as a notice."""
    topic, head, payload = frame.split(NUL, 2)
    return b"%b\0%b,%d]\0%b" % (topic, head[:-1], sent, payload)


def read_header(head: bytes) -> Header:
    """The header of a frame; raises BadMessage."""
    try:
        return _decode_header(head)
    except CANNOT_DECODE as error:
        raise BadMessage(
            "A frame has an unreadable header: {error}.",
            checklist=("Use the same version of NEP Studio on all computers.",),
            error=error,
        ) from error


def holds_too_many(payloads: bytes) -> bool:
    """Whether more JSON messages are together here than may share a frame."""
    return len(payloads) > MOST_TOGETHER and payloads.count(NUL) >= MOST_TOGETHER


def natural_encoding(message: Sendable) -> Encoding:
    """Text as text, bytes as bytes, all else as JSON."""
    if isinstance(message, str):
        return "text"
    return "bytes" if isinstance(message, bytes) else "json"


def encode(message: Sendable, encoding: Encoding) -> bytes:
    """The payload of ``message``; raises BadMessage when it cannot be encoded so."""
    try:
        if encoding == "json":
            return to_json(message)
        if encoding == "text" and isinstance(message, str):
            return message.encode()
        if encoding == "bytes" and isinstance(message, bytes):
            return message
        if encoding == "msgpack":
            return _encode_msgpack(message)
    except CANNOT_ENCODE as error:
        raise not_encodable(encoding, error) from error
    raise BadMessage(
        "A {name} cannot be sent as {encoding}.",
        checklist=("Send a dictionary of text, numbers, yes/no values and lists.",),
        name=type(message).__name__,
        encoding=encoding,
    )


def not_encodable(encoding: Encoding, error: Exception) -> BadMessage:
    """The error to raise for a message that cannot be encoded."""
    return BadMessage(
        "A message cannot be sent as {encoding}: {error}.",
        checklist=("Send a dictionary of text, numbers, yes/no values and lists.",),
        encoding=encoding,
        error=error,
    )


Decode = Callable[[bytes], Any]


def decoders(kind: type[Any] | None) -> dict[Encoding, Decode]:
    """How to decode payloads of each encoding into ``kind`` (None: whatever is there).

    They raise one of CANNOT_DECODE, which names the key that is missing or wrong.
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
