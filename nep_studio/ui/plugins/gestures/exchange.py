"""Takes as files: CSV, the same that "nep-studio train" reads, and MCAP."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import IO, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from faults import reason_of, text_of
from faults.files import whole_file
from nep_core.errors import RecordingError
from nep_core.recordings.file import Records
from nep_core.wire.frames import CANNOT_DECODE
from nep_core.wire.messages import IMU, Imu
from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.own_gestures import (
    WRISTS,
    OwnGesture,
    OwnRecording,
    OwnTake,
    free_gesture_name,
    keep_gesture,
    keep_recording,
)
from nep_studio.project.kept_files import EVERYDAY, NEITHER, spans_of
from nodes.recordings import (
    MAY_WRITE,
    Recording,
    read_recording,
    read_recordings,
    write_recording,
    writing,
)

from .gesture_controller import GestureController
from .live import Samples, as_recording, thinned, unpacked
from .project_gestures import LONGEST_TAKE_S, SHORTEST_TAKE_S, new_id
from .results.training import labelled

# Recordings that come from elsewhere, and how they become part of the project.


class TakeMark(msgspec.Struct, frozen=True, omit_defaults=True):
    """A take of a gesture, known by its name and, where it has one, its title.

    ``recording`` is that of the metadata of a channel, "" where the file has one recording.
    """

    recording: str
    gesture: str
    title: str
    start_s: float
    end_s: float
    left_out: bool = False


@dataclass(frozen=True)
class Imported:
    """A recording, and the takes in it."""

    recording: OwnRecording
    takes: tuple[TakeMark, ...]


def add_imported(controller: GestureController, imported: Sequence[Imported]) -> bool:
    """Keep all of it as one step; a gesture that is known gets more takes."""
    gestures = dict(controller.gestures)
    edits: list[SetExtra] = []
    changed: dict[str, None] = {}
    for one in imported:
        recording_id = new_id("r")
        edits.append(keep_recording(recording_id, one.recording))
        for take in one.takes:
            name = _gesture(take, gestures)
            can_be_learned = SHORTEST_TAKE_S <= take.end_s - take.start_s <= LONGEST_TAKE_S
            is_out = take.left_out or not can_be_learned
            kept = OwnTake(new_id("t"), recording_id, take.start_s, take.end_s, is_out)
            gestures[name] = replace(gestures[name], takes=(*gestures[name].takes, kept))
            changed[name] = None
    edits += [keep_gesture(name, gestures[name]) for name in changed]
    return bool(edits) and controller.change("import takes", edits)


def _gesture(take: TakeMark, gestures: dict[str, OwnGesture]) -> str:
    """The name of the gesture that a take is of; a new one if there is none yet."""
    title = take.title or take.gesture.replace("_", " ").strip()
    for name, gesture in gestures.items():
        if name == take.gesture or gesture.title.casefold() == title.casefold():
            return name
    name = free_gesture_name(take.gesture, gestures)
    number = max((one.number for one in gestures.values()), default=-1) + 1
    gestures[name] = OwnGesture(title[:60], number)
    return name


def read_csv(path: Path) -> list[Imported]:
    """Read a CSV file, or all those of a folder and of its everyday folder.

    Raises RecordingError, which says which file and what to do.
    """
    if path.is_dir():
        read = [_imported(one, is_everyday=False) for one in read_recordings(path)]
        everyday = path / EVERYDAY
        if everyday.is_dir() and any(everyday.glob("*.csv")):
            read += [_imported(one, is_everyday=True) for one in read_recordings(everyday)]
        return read
    return [_imported(read_recording(path), is_everyday=path.parent.name == EVERYDAY)]


def write_csv(
    folder: Path, gestures: dict[str, OwnGesture], recordings: dict[str, OwnRecording]
) -> list[Path]:
    """Write each recording into a folder, everyday movement into one inside; gives the files.

    Raises RecordingError.
    """
    written = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for number, (key, recording) in enumerate(recordings.items(), start=1):
            place = folder / EVERYDAY if recording.everyday else folder
            place.mkdir(exist_ok=True)
            stem = f"{_bare(recording.person)}{_made(key, gestures)}_{number}"
            made = labelled(key, recording, spans_of(key, recording, gestures))
            write_recording(place / f"{stem}.csv", made)
            written.append(place / f"{stem}.csv")
    except OSError as error:
        sentence = text_of(
            "The recordings cannot be written to {folder}: {reason}.",
            folder=folder,
            reason=reason_of(error),
        )
        raise RecordingError(sentence, checklist=MAY_WRITE, details=str(error)) from error
    return written


def _imported(recording: Recording, *, is_everyday: bool) -> Imported:
    samples = Samples(recording.t, recording.acc, recording.gyr)
    takes = list(_takes(recording)) if not is_everyday else []
    own = as_recording(
        thinned(samples),
        person=recording.person,
        wrist=recording.wrist or "right",
        source=recording.device or recording.source,
        gravity_included=recording.gravity_included,
        simulated=recording.simulated,
        everyday=is_everyday or not takes,
        forgotten=tuple((take.start_s, take.end_s) for take in takes if take.gesture == NEITHER),
    )
    return Imported(own, tuple(take for take in takes if take.gesture != NEITHER))


def _takes(recording: Recording) -> Iterator[TakeMark]:
    """The runs of samples with the same label."""
    labels = recording.labels or []
    first = 0
    for at in range(1, len(labels) + 1):
        if at < len(labels) and labels[at] == labels[first]:
            continue
        start_s, end_s = float(recording.t[first]), float(recording.t[at - 1])
        if labels[first] and end_s > start_s:
            yield TakeMark("", labels[first], "", round(start_s, 4), round(end_s, 4))
        first = at


def _bare(person: str) -> str:
    letters = "".join(letter if letter.isalnum() else "_" for letter in person.strip())
    return f"{letters[:24]}_" if letters else ""


def _made(key: str, gestures: dict[str, OwnGesture]) -> str:
    """What is made in a recording, for the name of its file."""
    made = [name for name, one in gestures.items() if any(t.recording == key for t in one.takes)]
    return made[0] if len(made) == 1 else "session" if made else EVERYDAY


# Takes as an MCAP file: batches of ``/imu`` and one message for each take, both as JSON.
#
# Each recording is a channel of its own of ``/imu``; what is known of it is the channel's
# metadata. A file that ends in the middle gives what is before its end.

TAKES = "/gesture_takes"
LARGEST_BYTES = 300_000_000
_BATCH = 50
_CHUNK_BYTES = 64_000
"""Small chunks: of a file that was cut, little is lost."""
_IS_MCAP = (
    "Is it a file that ends with .mcap?",
    "If it was sent or downloaded, get it once more: it may not be whole.",
)


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
    found = [_imported_from(channel, marks) for channel in channels.values()]
    imported = [one for one in found if one is not None]
    if not imported:
        told = "has no recordings of a watch or phone in it"
        raise _unusable(path, told if is_whole else "is not a whole MCAP file", _IS_MCAP)
    return imported, is_whole


def _read(file: IO[bytes], channels: dict[int, _Channel], marks: list[TakeMark]) -> bool:
    """Read as far as the file can be read; gives whether that was to its end."""
    from mcap.records import Channel, Message

    topics: dict[int, str] = {}
    found = Records(file)
    for record in itertools.chain.from_iterable(found):
        if isinstance(record, Channel) and record.message_encoding == "json":
            topics[record.id] = record.topic
            if record.topic == IMU:
                channels.setdefault(record.id, _Channel(dict(record.metadata)))
        elif isinstance(record, Message):
            topic = topics.get(record.channel_id)
            with contextlib.suppress(*CANNOT_DECODE):  # another program says else there
                if topic == IMU:
                    batch = msgspec.json.decode(record.data, type=Imu)
                    channels[record.channel_id].batches.append(batch)
                elif topic == TAKES:
                    marks.append(msgspec.json.decode(record.data, type=TakeMark))
    return found.is_whole


def _imported_from(channel: _Channel, marks: list[TakeMark]) -> Imported | None:
    samples = _joined(channel.batches)
    if len(samples) < 2:
        return None
    about, first = channel.about, channel.batches[0]
    begin = float(samples.t[0])
    kept = thinned(samples)
    takes = tuple(
        replace(one, start_s=one.start_s - begin, end_s=one.end_s - begin)
        for one in marks
        if one.recording == about.get("recording")
        and begin <= one.start_s < one.end_s <= begin + kept.seconds + 0.1
    )
    wrist = about.get("wrist", first.wrist)
    own = as_recording(
        kept,
        person=about.get("person", ""),
        wrist=wrist if wrist in WRISTS else "right",
        source=about.get("source", first.source),
        gravity_included=first.gravity_included,
        simulated=first.simulated,
        everyday=about.get("everyday") == "yes" or not takes,
        recorded=about.get("recorded", ""),
        forgotten=_forgotten(about.get("forgotten", "[]")),
    )
    return Imported(own, takes)


def _forgotten(text: str) -> tuple[tuple[float, float], ...]:
    try:
        return msgspec.json.decode(text, type=tuple[tuple[float, float], ...])
    except CANNOT_DECODE:
        return ()


def _joined(batches: list[Imu]) -> Samples:
    """All samples that are whole and later than those before."""
    whole = [one for one in batches if len(one.acc) == len(one.t) and _fits(one)]
    if not whole:
        return Samples.none()
    t = np.concatenate([np.asarray(one.t, dtype=float) for one in whole])
    acc = np.concatenate([np.asarray(one.acc, dtype=float).reshape(-1, 3) for one in whole])
    gyr: Any = None
    if all(one.gyr is not None for one in whole):
        gyr = np.concatenate([np.asarray(one.gyr, dtype=float).reshape(-1, 3) for one in whole])
    latest = np.concatenate([[-np.inf], np.maximum.accumulate(t)[:-1]])
    kept = (t > latest) & np.isfinite(t) & np.isfinite(acc).all(axis=1)
    return Samples(t[kept], acc[kept], None if gyr is None else gyr[kept])


def _fits(batch: Imu) -> bool:
    return bool(batch.t) and (batch.gyr is None or len(batch.gyr) == len(batch.t))


def _unusable(path: Path, told: str, checklist: tuple[str, ...]) -> RecordingError:
    return RecordingError("{name} {told}.", checklist=checklist, name=path.name, told=told)
