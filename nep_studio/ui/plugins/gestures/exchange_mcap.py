"""Takes as an MCAP file: batches of ``/imu`` and one message for each take, both as JSON.

Each recording is a channel of its own of ``/imu``; what is known of it is the channel's metadata.
A file that ends in the middle gives what is before its end.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import IO, Any

import msgspec
import numpy as np

from faults import reason_of, text_of
from nep_core.errors import RecordingError
from nep_core.places import whole_file
from nep_core.wire.messages import IMU, Imu
from nep_studio.blocks.own_gestures import WRISTS, OwnGesture, OwnRecording, Wrist
from nodes.recordings import writing

from .exchange import Imported, ImportedTake
from .live import Samples
from .packed_arrays import packed, thinned, unpacked

TAKES = "/gesture_takes"
LARGEST_BYTES = 300_000_000
_LARGEST_RECORD = 64_000_000
_BATCH = 50
_CHUNK_BYTES = 64_000
"""Small chunks: of a file that was cut, little is lost."""
_IS_MCAP = (
    "Is it a file that ends with .mcap?",
    "If it was sent or downloaded, get it once more: it may not be whole.",
)


class TakeMark(msgspec.Struct, omit_defaults=True):
    """A take as a message; ``recording`` is that of the channel's metadata."""

    recording: str
    gesture: str
    title: str
    start_s: float
    end_s: float
    left_out: bool = False


def write_mcap(
    path: Path, gestures: Mapping[str, OwnGesture], recordings: Mapping[str, OwnRecording]
) -> None:
    """Write all recordings and takes; the file is whole or as it was. Raises RecordingError."""
    with writing(path), whole_file(path) as file:
        _write(file, gestures, recordings)


def _write(
    file: IO[bytes], gestures: Mapping[str, OwnGesture], recordings: Mapping[str, OwnRecording]
) -> None:
    from mcap.writer import Writer

    writer = Writer(file, chunk_size=_CHUNK_BYTES)
    writer.start(profile="", library="nep-studio")
    imu = writer.register_schema("nep.Imu", "jsonschema", _schema(Imu))
    take = writer.register_schema("nep.GestureTake", "jsonschema", _schema(TakeMark))
    takes = writer.register_channel(TAKES, "json", take)
    for key, recording in recordings.items():
        begin_ns = _nanoseconds(recording.recorded)
        channel = writer.register_channel(IMU, "json", imu, _metadata(key, recording))
        for batch in _batches(recording):
            at = begin_ns + round(batch.t[0] * 1e9)
            writer.add_message(channel, at, msgspec.json.encode(batch), at)
        for mark in _marks(key, gestures):
            at = begin_ns + round(mark.end_s * 1e9)
            writer.add_message(takes, at, msgspec.json.encode(mark), at)
    writer.finish()  # type: ignore[no-untyped-call]


def _schema(kind: type[msgspec.Struct]) -> bytes:
    return msgspec.json.encode(msgspec.json.schema(kind))


def _nanoseconds(recorded: str) -> int:
    try:
        return max(0, round(datetime.fromisoformat(recorded).timestamp() * 1e9))
    except (ValueError, OverflowError, OSError):
        return 0


def _metadata(key: str, recording: OwnRecording) -> dict[str, str]:
    return {
        "recording": key,
        "person": recording.person,
        "wrist": recording.wrist,
        "source": recording.source,
        "recorded": recording.recorded,
        "everyday": "yes" if recording.everyday else "no",
        "forgotten": msgspec.json.encode(recording.forgotten).decode(),
    }


def _batches(recording: OwnRecording) -> Iterator[Imu]:
    samples = unpacked(recording)
    for at in range(0, len(samples), _BATCH):
        part = slice(at, at + _BATCH)
        yield Imu(
            source=recording.source,
            rate_hz=recording.rate_hz,
            t=samples.t[part].tolist(),
            acc=samples.acc[part].tolist(),
            gyr=None if samples.gyr is None else samples.gyr[part].tolist(),
            gravity_included=recording.gravity_included,
            simulated=recording.simulated,
            wrist=recording.wrist,
        )


def _marks(key: str, gestures: Mapping[str, OwnGesture]) -> Iterator[TakeMark]:
    for name, gesture in gestures.items():
        for take in gesture.takes:
            if take.recording == key:
                yield TakeMark(key, name, gesture.title, take.start_s, take.end_s, take.left_out)


@dataclass
class _Channel:
    """What was read of one channel of /imu."""

    about: Mapping[str, str]
    batches: list[Imu] = field(default_factory=list)


def read_mcap(path: Path) -> tuple[list[Imported], bool]:
    """Read recordings and takes; and whether the file is whole. Raises RecordingError."""
    channels: dict[int, _Channel] = {}
    marks: list[TakeMark] = []
    try:
        if path.stat().st_size > LARGEST_BYTES:
            raise _unusable(path, "is too large to be read", ("Export a part of it only.",))
        with path.open("rb") as file:
            is_whole = _read(file, channels, marks)
    except OSError as error:
        sentence = text_of("{path} cannot be read: {reason}.", path=path, reason=reason_of(error))
        raise RecordingError(sentence, checklist=_IS_MCAP, details=str(error)) from error
    found = [_imported(channel, marks) for channel in channels.values()]
    imported = [one for one in found if one is not None]
    if not imported:
        told = (
            "has no recordings of a watch or phone in it"
            if is_whole
            else "is not a whole MCAP file"
        )
        raise _unusable(path, told, _IS_MCAP)
    return imported, is_whole


def _read(file: IO[bytes], channels: dict[int, _Channel], marks: list[TakeMark]) -> bool:
    """Read as far as the file can be read; gives whether that was to its end."""
    from mcap.exceptions import McapError
    from mcap.records import Channel, Message
    from mcap.stream_reader import StreamReader

    topics: dict[int, str] = {}
    reader = StreamReader(file, validate_crcs=True, record_size_limit=_LARGEST_RECORD)
    try:
        for record in reader.records:
            if isinstance(record, Channel) and record.message_encoding == "json":
                topics[record.id] = record.topic
                if record.topic == IMU:
                    channels.setdefault(record.id, _Channel(dict(record.metadata)))
            elif isinstance(record, Message):
                _take_in(
                    record.data, topics.get(record.channel_id), channels, record.channel_id, marks
                )
    except (McapError, ValueError, EOFError, KeyError, IndexError, MemoryError, RuntimeError):
        return False
    except Exception as error:  # those of the libraries that unpack have no common name
        if type(error).__module__.partition(".")[0] not in (
            "zstandard",
            "lz4",
            "struct",
            "_struct",
        ):
            raise
        return False
    return True


def _take_in(
    data: bytes,
    topic: str | None,
    channels: dict[int, _Channel],
    channel: int,
    marks: list[TakeMark],
) -> None:
    """Understand one message; those of other programs that say something else are left out."""
    with contextlib.suppress(msgspec.DecodeError):
        if topic == IMU:
            channels[channel].batches.append(msgspec.json.decode(data, type=Imu))
        elif topic == TAKES:
            marks.append(msgspec.json.decode(data, type=TakeMark))


def _imported(channel: _Channel, marks: list[TakeMark]) -> Imported | None:
    samples = _joined(channel.batches)
    if len(samples) < 2:
        return None
    about, first = channel.about, channel.batches[0]
    begin = float(samples.t[0])
    kept = thinned(samples)
    takes = tuple(
        ImportedTake(one.gesture, one.title, one.start_s - begin, one.end_s - begin, one.left_out)
        for one in marks
        if one.recording == about.get("recording")
        and begin <= one.start_s < one.end_s <= begin + kept.seconds + 0.1
    )
    wrist = about.get("wrist", first.wrist)
    found: Wrist = next((one for one in WRISTS if one == wrist), "right")
    own = OwnRecording(
        seconds=round(kept.seconds, 4),
        rate_hz=round(kept.rate_hz, 2),
        samples=packed(kept),
        person=about.get("person", ""),
        wrist=found,
        source=about.get("source", first.source),
        gravity_included=first.gravity_included,
        has_rotation=kept.gyr is not None,
        simulated=first.simulated,
        everyday=about.get("everyday") == "yes" or not takes,
        recorded=about.get("recorded", ""),
        forgotten=_forgotten(about.get("forgotten", "[]")),
    )
    return Imported(own, takes)


def _forgotten(text: str) -> tuple[tuple[float, float], ...]:
    try:
        return msgspec.json.decode(text, type=tuple[tuple[float, float], ...])
    except msgspec.DecodeError:
        return ()


def _joined(batches: list[Imu]) -> Samples:
    """All samples that are whole and later than those before."""
    whole = [one for one in batches if len(one.acc) == len(one.t) and _fits(one)]
    if not whole:
        return Samples.none()
    t = np.concatenate([np.asarray(one.t, dtype=float) for one in whole])
    acc = np.concatenate([np.asarray(one.acc, dtype=float).reshape(-1, 3) for one in whole])
    has_rotation = all(one.gyr is not None for one in whole)
    gyr: Any = None
    if has_rotation:
        gyr = np.concatenate([np.asarray(one.gyr, dtype=float).reshape(-1, 3) for one in whole])
    latest = np.concatenate([[-np.inf], np.maximum.accumulate(t)[:-1]])
    kept = (t > latest) & np.isfinite(t) & np.isfinite(acc).all(axis=1)
    return Samples(t[kept], acc[kept], None if gyr is None else gyr[kept])


def _fits(batch: Imu) -> bool:
    return bool(batch.t) and (batch.gyr is None or len(batch.gyr) == len(batch.t))


def _unusable(path: Path, told: str, checklist: tuple[str, ...]) -> RecordingError:
    return RecordingError("{name} {told}.", checklist=checklist, name=path.name, told=told)
