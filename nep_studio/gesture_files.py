"""A project's gestures as files: what was learned, and the takes, as nodes read them."""

from __future__ import annotations

import binascii
import hashlib
import os
import shutil
from array import array
from base64 import b64decode
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from nep_core.places import cache_folder
from nep_studio.blocks.own_gestures import (
    OwnGesture,
    OwnRecogniser,
    OwnRecording,
    own_gestures,
    own_recogniser,
    own_recordings,
    training_digest,
)
from nep_studio.blocks.packed_samples import floats_of, unpacked_samples
from nep_studio.blocks.program import Project

FOLDER = "gestures"
EVERYDAY = "everyday"
NEITHER = "?"
"""The label of movement that is neither a gesture nor nothing: a take that was left out."""
MOST_KEPT = 20
_HEADER = ("t", "ax", "ay", "az", "gx", "gy", "gz")


@dataclass(frozen=True)
class RecogniserFile:
    """A gesture model in a folder that no other model is in; ``text`` is the model in base64."""

    folder: Path
    text: str

    @property
    def path(self) -> Path:
        """The model."""
        return self.folder / "recogniser.gestures"

    def moved(self, folder: Path) -> RecogniserFile:
        """The same in another folder."""
        return replace(self, folder=folder)

    def write(self) -> None:
        """Write it if it is not there. Raises OSError."""
        if self.path.is_file():
            return
        try:
            data = b64decode(self.text, validate=True)
        except (binascii.Error, ValueError) as error:
            raise OSError("what was learned is damaged: train the gestures again") from error
        self.folder.mkdir(parents=True, exist_ok=True)
        part = self.path.with_suffix(f".{os.getpid()}.part")
        part.write_bytes(data)
        part.replace(self.path)  # at once: another window may write the same one
        _forget_old(self.folder)


@dataclass(frozen=True)
class TakeFiles:
    """The recordings of a project as CSV files in a folder of their own."""

    folder: Path
    gestures: Mapping[str, OwnGesture]
    recordings: Mapping[str, OwnRecording]

    def moved(self, folder: Path) -> TakeFiles:
        """The same in another folder."""
        return replace(self, folder=folder)

    def write(self) -> None:
        """Write them if they are not there. Raises OSError."""
        if self.folder.is_dir():
            return
        part = self.folder.with_suffix(f".{os.getpid()}.part")
        try:
            write_recordings(part, self.gestures, self.recordings)
            with suppress(OSError):  # another window was quicker
                part.rename(self.folder)
        finally:
            shutil.rmtree(part, ignore_errors=True)
        _forget_old(self.folder)


def recogniser_file(project: Project) -> RecogniserFile | None:
    """What the project's recogniser has learned; None when it has none."""
    recogniser = own_recogniser(project)
    return None if recogniser is None else file_of(recogniser)


def file_of(recogniser: OwnRecogniser) -> RecogniserFile:
    """A recogniser as the file that its node reads."""
    digest = hashlib.sha256(recogniser.file.encode()).hexdigest()[:16]
    return RecogniserFile(cache_folder() / FOLDER / digest, recogniser.file)


def take_files(project: Project) -> TakeFiles | None:
    """The takes of the project's gestures; None when it has none."""
    gestures = {name: one for name, one in own_gestures(project).items() if one.takes}
    if not gestures:
        return None
    named = {take.recording for gesture in gestures.values() for take in gesture.takes}
    recordings = {key: one for key, one in own_recordings(project).items() if key in named}
    folder = cache_folder() / FOLDER / f"takes_{training_digest(project)[:16]}"
    return TakeFiles(folder, gestures, recordings)


def write_recordings(
    folder: Path, gestures: Mapping[str, OwnGesture], recordings: Mapping[str, OwnRecording]
) -> None:
    """Write each recording as a CSV file, everyday movement into a folder within. Raises OSError.

    The column ``gesture`` has the name of the gesture where a take is, ``?`` where one was deleted
    or left out, and nothing elsewhere.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for key, recording in recordings.items():
        place = folder / EVERYDAY if recording.everyday else folder
        place.mkdir(exist_ok=True)
        lines = _lines(key, recording, gestures)
        (place / f"{key}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def _lines(key: str, recording: OwnRecording, gestures: Mapping[str, OwnGesture]) -> Iterator[str]:
    columns = 7 if recording.has_rotation else 4
    numbers = _numbers(recording)
    spans = sorted(_spans(key, recording, gestures))
    yield f"# person: {recording.person}"
    yield f"# gravity_included: {'yes' if recording.gravity_included else 'no'}"
    yield f"# simulated: {'yes' if recording.simulated else 'no'}"
    yield f"# wrist: {recording.wrist}"
    yield ",".join((*_HEADER[:columns], "gesture"))
    for at in range(0, len(numbers) - columns + 1, columns):
        t = numbers[at]
        label = next((name for start_s, end_s, name in spans if start_s <= t <= end_s), "")
        yield ",".join((*(f"{number:.7g}" for number in numbers[at : at + columns]), label))


def _numbers(recording: OwnRecording) -> array[float]:
    try:
        return floats_of(unpacked_samples(recording.samples))
    except ValueError as error:
        raise OSError(str(error)) from error


def _spans(
    key: str, recording: OwnRecording, gestures: Mapping[str, OwnGesture]
) -> Iterator[tuple[float, float, str]]:
    for name, gesture in gestures.items():
        for take in gesture.takes:
            if take.recording == key:
                yield take.start_s, take.end_s, NEITHER if take.left_out else name
    for start_s, end_s in recording.forgotten:
        yield start_s, end_s, NEITHER


def _forget_old(newest: Path) -> None:
    """Delete all but the newest folders of the cache: they are written again when needed."""
    if newest.parent != cache_folder() / FOLDER:
        return  # somebody keeps these files for good
    with suppress(OSError):
        found = newest.parent.iterdir()
        for old in sorted(found, key=lambda path: path.stat().st_mtime)[:-MOST_KEPT]:
            shutil.rmtree(old, ignore_errors=True)
