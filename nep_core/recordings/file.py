"""Reading a recording: its messages as they were sent, up to where the file is whole."""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import msgspec

from faults import reason_of
from nep_core.errors import RecordingError
from nep_core.wire.frames import CANNOT_DECODE, Encoding
from nep_core.wire.messages import BY_TOPIC

from .raw import RawMessage

if TYPE_CHECKING:
    from mcap.records import Chunk, McapRecord


# How a message lies in an MCAP file, so that Foxglove shows it and play gives back its bytes.
#
# | encoding | in the file | schema |
# |---|---|---|
# | json | as it was sent | of its topic's struct, else "any object" |
# | text | {"text": ...} | nep.Text |
# | msgpack, bytes | as it was sent | none |
#
# A channel is one topic of one node in one encoding; its metadata says node and encoding.

Json = dict[str, Any]
_ENCODINGS: dict[str, Encoding] = {"json": "json", "msgpack": "msgpack"}
"""Of channels that another program wrote, by MCAP's name."""
_BYTES = "x-nep-bytes"


class Text(msgspec.Struct):
    """A text message as Foxglove shows it."""

    text: str


@dataclass(frozen=True)
class Channel:
    """What all messages of one channel have in common."""

    topic: str
    node: str
    encoding: Encoding
    is_text: bool = False

    @property
    def message_encoding(self) -> str:
        """The encoding by its name in MCAP."""
        if self.encoding == "json" or self.is_text:
            return "json"
        return "msgpack" if self.encoding == "msgpack" else _BYTES

    @property
    def metadata(self) -> dict[str, str]:
        """What only play needs to know."""
        return {"nep.node": self.node, "nep.encoding": self.encoding}

    @property
    def schema(self) -> tuple[str, bytes]:
        """The name of its JSON schema, which is simple enough for Foxglove; "" for none."""
        if self.encoding != "json" and not self.is_text:
            return "", b""
        kind = Text if self.is_text else BY_TOPIC.get(self.topic)
        if kind is None:
            return "nep.Any", b'{"type":"object","properties":{}}'
        return f"nep.{kind.__name__}", plain_schema(kind)


def channel_of(message: RawMessage) -> tuple[Channel, bytes]:
    """The channel that a message belongs to, and its data there."""
    if message.encoding == "text":
        try:
            text = Text(message.payload.decode())
        except UnicodeDecodeError:  # not a text after all: it is kept as the bytes that it is
            return Channel(message.topic, message.node, "text"), message.payload
        return Channel(message.topic, message.node, "text", True), msgspec.json.encode(text)
    return Channel(message.topic, message.node, message.encoding), message.payload


def read_channel(topic: str, message_encoding: str, metadata: dict[str, str]) -> Channel | None:
    """The channel as the file tells it; None when NEP has no such encoding."""
    told = metadata.get("nep.encoding", "")
    node = metadata.get("nep.node", "")
    if told == "text":
        return Channel(topic, node, "text", message_encoding == "json")
    if told == "bytes":
        return Channel(topic, node, "bytes")
    encoding = _ENCODINGS.get(message_encoding)
    return None if encoding is None else Channel(topic, node, encoding)


def plain_schema(kind: type[Any]) -> bytes:
    """The schema of a struct without what Foxglove does not know.

    It wants an object at the top, a plain type for each field, and no lists of lists; a field
    that cannot be said so is left out (its values stay in the messages).
    """
    schema = msgspec.json.schema(kind)
    definitions: Json = schema.get("$defs", {})
    return msgspec.json.encode(_plain(schema, definitions))


def _plain(schema: Json, definitions: Json) -> Json | None:
    """One schema in plain types; None when there is no plain way to say it."""
    schema = _one_way(schema, definitions)
    is_choice = all(isinstance(value, str) for value in schema.get("enum", [0]))
    kind = schema.get("type") or ("string" if is_choice else None)
    about = {"description": schema["description"]} if "description" in schema else {}
    if kind == "object":
        fields = {
            name: plain
            for name, field in schema.get("properties", {}).items()
            if (plain := _plain(field, definitions)) is not None
        }
        named = {"title": schema["title"]} if "title" in schema else {}
        return {"type": "object", **named, **about, "properties": fields}
    if kind == "array":
        items = _plain((schema.get("prefixItems") or [schema.get("items")])[0], definitions)
        usable = items is not None and items["type"] != "array"
        return {"type": "array", "items": items} if usable else None
    if kind == "string" and "contentEncoding" in schema:
        return {"type": "string", "contentEncoding": schema["contentEncoding"]}
    return {"type": kind} if kind in ("string", "number", "integer", "boolean") else None


def _one_way(schema: Json, definitions: Json) -> Json:
    """Follow a reference; of "this or null", take this."""
    while True:
        if "$ref" in schema:
            schema = definitions[schema["$ref"].rpartition("/")[2]]
            continue
        ways = [way for way in schema.get("anyOf", []) if way.get("type") != "null"]
        if len(ways) != 1:
            return schema
        schema = ways[0]


LARGEST_RECORD = 256_000_000
_MOST_UNPACKED, _MOST_PACKED = 2_000_000, 20
"""A chunk is unpacked to 2 MB, twice what is usual, or to 20 times its packed size. What packs
better was made to fill the memory: the sizes that such a file tells of itself may be lies too."""
_MAGIC = b"\x89MCAP0\r\n"
_LARGEST_WINDOW = 8_388_608
"""What zstd itself lets a stranger's file ask for, in bytes."""


class Records:
    """The records of an open MCAP file, those of a chunk at a time, as far as they can be read.

    ``is_whole`` is known after that: False when the file ends or is damaged in the middle.
    """

    def __init__(self, file: IO[bytes]) -> None:
        self.is_whole = True
        self._file = file

    def __iter__(self) -> Iterator[list[McapRecord]]:
        """Records, read as they are wanted."""
        from mcap.records import Chunk
        from mcap.stream_reader import StreamReader

        reader = StreamReader(
            self._file, emit_chunks=True, validate_crcs=True, record_size_limit=LARGEST_RECORD
        )
        records = reader.records
        while True:
            record = _next_whole(lambda: next(records, None))
            if isinstance(record, Chunk):
                found = _next_whole(partial(_records_in, record))
            else:
                found = record if record in (None, _DAMAGED) else [record]
            if found is _DAMAGED:
                self.is_whole = False
            if found is None or found is _DAMAGED:
                return
            yield found


class Recording:
    """An MCAP file; raises RecordingError when it is none, or cannot be read.

    Iterating gives its messages in the order of their arrival. ``is_whole`` is known after that:
    False when the file ends or is damaged in the middle. ``skipped`` are the topics in encodings
    that NEP does not have, of files of other programs.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self.is_whole = True
        self.skipped: set[str] = set()
        try:
            with self.path.open("rb") as file:
                start = file.read(len(_MAGIC))
        except OSError as error:
            raise RecordingError(
                "{path} cannot be read: {reason}.",
                checklist=("Is the name right?", "May you read the file?"),
                details=str(error),
                path=self.path,
                reason=reason_of(error),
            ) from error
        if start != _MAGIC:
            raise RecordingError(
                "{path} is not an MCAP recording.",
                checklist=("Choose a file that `nep record` wrote; its name ends with .mcap.",),
                path=self.path,
            )

    def __iter__(self) -> Iterator[RawMessage]:
        """Each message, read as it is wanted."""
        channels: dict[int, Channel | None] = {}
        self.is_whole = True
        with self.path.open("rb") as file:
            found = Records(file)
            for records in found:
                yield from self._sorted(records, channels)
            self.is_whole = found.is_whole

    def _sorted(
        self, records: list[McapRecord], channels: dict[int, Channel | None]
    ) -> list[RawMessage]:
        from mcap.records import Channel as ChannelRecord
        from mcap.records import Message

        messages = []
        for record in records:
            if isinstance(record, ChannelRecord):
                channels[record.id] = channel = read_channel(
                    record.topic, record.message_encoding, record.metadata
                )
                if channel is None:
                    self.skipped.add(record.topic)
            elif isinstance(record, Message) and (channel := channels.get(record.channel_id)):
                message = _message(channel, record)
                if message is not None:
                    messages.append(message)
        return sorted(messages, key=lambda message: message.arrived_ns)


def read_recording(path: str | os.PathLike[str]) -> Iterator[RawMessage]:
    """The messages of a recording: topic, times, node, encoding, payload. RecordingError."""
    return iter(Recording(path))


@dataclass
class TopicTotal:
    """What a recording holds of one topic."""

    messages: int = 0
    payload_bytes: int = 0
    encodings: set[str] = field(default_factory=set)
    nodes: set[str] = field(default_factory=set)


@dataclass
class Overview:
    """What is in a recording; its times are ns since 1970, 0 when it is empty."""

    is_whole: bool = True
    skipped: set[str] = field(default_factory=set)
    start_ns: int = 0
    end_ns: int = 0
    topics: dict[str, TopicTotal] = field(default_factory=dict)

    @property
    def seconds(self) -> float:
        """From the first message to the last."""
        return (self.end_ns - self.start_ns) / 1e9

    @property
    def messages(self) -> int:
        """How many messages there are."""
        return sum(total.messages for total in self.topics.values())


def overview(path: str | os.PathLike[str]) -> Overview:
    """Read a whole recording once and tell what is in it; raises RecordingError."""
    recording, told = Recording(path), Overview()
    for message in recording:
        total = told.topics.setdefault(message.topic, TopicTotal())
        total.messages += 1
        total.payload_bytes += len(message.payload)
        total.encodings.add(message.encoding)
        total.nodes.add(message.node)
        told.start_ns = min(told.start_ns or message.arrived_ns, message.arrived_ns)
        told.end_ns = max(told.end_ns, message.arrived_ns)
    told.is_whole, told.skipped = recording.is_whole, recording.skipped
    return told


_DAMAGED: Any = object()


def _next_whole(read: Callable[[], Any]) -> Any:
    """What ``read`` gives, or _DAMAGED when the file ends or is damaged there."""
    try:
        return read()
    except OSError:  # of the disk: nothing is known of the file
        raise
    except Exception:  # the library, and those that unpack for it, raise whatever comes to them
        return _DAMAGED


def _records_in(chunk: Chunk) -> list[McapRecord]:
    """The records of a chunk; ValueError when they are more than is bearable."""
    from mcap.records import Chunk as ChunkRecord
    from mcap.stream_reader import breakup_chunk

    room = min(LARGEST_RECORD, max(_MOST_UNPACKED, _MOST_PACKED * len(chunk.data)))
    if chunk.uncompressed_size > room:
        raise ValueError("the chunk is far larger than its file")
    data = _unpack(chunk.compression, chunk.data, int(chunk.uncompressed_size))
    unpacked = ChunkRecord(
        compression="",
        data=data,
        message_end_time=chunk.message_end_time,
        message_start_time=chunk.message_start_time,
        uncompressed_crc=chunk.uncompressed_crc,
        uncompressed_size=len(data),
    )
    return breakup_chunk(unpacked, validate_crc=True)


def _unpack(compression: str, packed: bytes, size: int) -> bytes:
    """The ``size`` bytes that are packed; ValueError when there are not so many."""
    if compression == "lz4":
        import lz4.frame

        with lz4.frame.open(io.BytesIO(packed)) as frame:
            data = bytes(frame.read(size + 1))
    elif compression == "zstd":
        import zstandard

        reader = zstandard.ZstdDecompressor(max_window_size=max(_LARGEST_WINDOW, size))
        with reader.stream_reader(packed) as unpacking:
            data = unpacking.read(size + 1)
    else:
        data = packed
    if len(data) != size:
        raise ValueError("the chunk is not as large as it says")
    return data


def _message(channel: Channel, record: Any) -> RawMessage | None:
    payload = record.data
    if channel.is_text:
        try:
            payload = msgspec.json.decode(payload, type=Text).text.encode()
        except CANNOT_DECODE:
            return None
    return RawMessage(
        channel.topic,
        channel.node,
        record.sequence,
        record.publish_time,
        record.log_time,
        channel.encoding,
        payload,
    )
