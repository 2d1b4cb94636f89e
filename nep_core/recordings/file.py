"""Reading a recording: its messages as they were sent, up to where the file is whole."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from nep_core.errors import RecordingError
from nep_core.recordings.format import Channel, payload_of, read_channel
from nep_core.recordings.raw import RawMessage

if TYPE_CHECKING:
    from mcap.records import McapRecord

LARGEST_RECORD = 256_000_000
_MAGIC = b"\x89MCAP0\r\n"
_UNPACKING = ("zstandard", "lz4", "struct", "_struct")
"""The libraries that unpack raise errors of their own, with no common name."""


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
                f"{self.path} cannot be read: {(error.strerror or 'unknown reason').lower()}.",
                checklist=("Is the name right?", "May you read the file?"),
                details=str(error),
            ) from error
        if start != _MAGIC:
            raise RecordingError(
                f"{self.path} is not an MCAP recording.",
                checklist=("Choose a file that `nep record` wrote; its name ends with .mcap.",),
            )

    def __iter__(self) -> Iterator[RawMessage]:
        """Each message, read as it is wanted."""
        channels: dict[int, Channel | None] = {}
        self.is_whole = True
        with self.path.open("rb") as file:
            records = self._records(file)
            for record in records:
                yield from self._sorted(record, channels)

    def _records(self, file: Any) -> Iterator[list[McapRecord]]:
        """The records of a chunk at a time, as far as they can be read."""
        from mcap.records import Chunk
        from mcap.stream_reader import StreamReader, breakup_chunk

        reader = StreamReader(
            file, emit_chunks=True, validate_crcs=True, record_size_limit=LARGEST_RECORD
        )
        records = reader.records
        while True:
            record = _next_whole(lambda: next(records, None))
            if isinstance(record, Chunk):
                found = _next_whole(partial(breakup_chunk, record, validate_crc=True))
            else:
                found = record if record in (None, _DAMAGED) else [record]
            if found is _DAMAGED:
                self.is_whole = False
            if found is None or found is _DAMAGED:
                return
            yield found

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
    from mcap.exceptions import McapError

    try:
        return read()
    except (McapError, ValueError, EOFError, KeyError, IndexError, MemoryError, RuntimeError):
        return _DAMAGED
    except Exception as error:
        if type(error).__module__.partition(".")[0] not in _UNPACKING:
            raise
        return _DAMAGED


def _message(channel: Channel, record: Any) -> RawMessage | None:
    try:
        payload = payload_of(channel, record.data)
    except msgspec.MsgspecError:
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
