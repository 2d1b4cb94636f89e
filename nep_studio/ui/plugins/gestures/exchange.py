"""Takes as CSV files: the same that "nep-studio train" reads, one file for each recording."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from msgspec.structs import replace

from faults import reason_of, text_of
from nep_core.errors import RecordingError
from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.own_gestures import (
    OwnGesture,
    OwnRecording,
    OwnTake,
    Wrist,
    free_gesture_name,
    keep_gesture,
    keep_recording,
)
from nep_studio.project.kept_files import EVERYDAY, NEITHER, spans_of
from nodes.recordings import MAY_WRITE, Recording, read_recording, read_recordings, write_recording

from .gesture_controller import GestureController
from .live import Samples
from .packed_arrays import packed, thinned
from .project_gestures import LONGEST_TAKE_S, SHORTEST_TAKE_S, new_id
from .results.training import labelled

# Recordings that come from elsewhere, and how they become part of the project.


@dataclass(frozen=True)
class ImportedTake:
    """A take of a gesture, known by its name and, where it has one, its title."""

    gesture: str
    title: str
    start_s: float
    end_s: float
    left_out: bool = False


@dataclass(frozen=True)
class Imported:
    """A recording, and the takes in it."""

    recording: OwnRecording
    takes: tuple[ImportedTake, ...]


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


def _gesture(take: ImportedTake, gestures: dict[str, OwnGesture]) -> str:
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
    wrist: Wrist = recording.wrist or "right"
    kept = thinned(samples)
    own = OwnRecording(
        seconds=round(kept.seconds, 4),
        rate_hz=round(kept.rate_hz, 2),
        samples=packed(kept),
        person=recording.person,
        wrist=wrist,
        source=recording.device or recording.source,
        gravity_included=recording.gravity_included,
        has_rotation=kept.gyr is not None,
        simulated=recording.simulated,
        everyday=is_everyday or not takes,
        forgotten=tuple((take.start_s, take.end_s) for take in takes if take.gesture == NEITHER),
    )
    return Imported(own, tuple(take for take in takes if take.gesture != NEITHER))


def _takes(recording: Recording) -> Iterator[ImportedTake]:
    """The runs of samples with the same label."""
    labels = recording.labels or []
    first = 0
    for at in range(1, len(labels) + 1):
        if at < len(labels) and labels[at] == labels[first]:
            continue
        start_s, end_s = float(recording.t[first]), float(recording.t[at - 1])
        if labels[first] and end_s > start_s:
            yield ImportedTake(labels[first], "", round(start_s, 4), round(end_s, 4))
        first = at


def _bare(person: str) -> str:
    letters = "".join(letter if letter.isalnum() else "_" for letter in person.strip())
    return f"{letters[:24]}_" if letters else ""


def _made(key: str, gestures: dict[str, OwnGesture]) -> str:
    """What is made in a recording, for the name of its file."""
    made = [name for name, one in gestures.items() if any(t.recording == key for t in one.takes)]
    return made[0] if len(made) == 1 else "session" if made else EVERYDAY
