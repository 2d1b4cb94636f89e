"""A project's gestures as files: what was learned, and the takes, as nodes read them."""

from __future__ import annotations

import binascii
import os
import re
import shutil
from array import array
from base64 import b64decode
from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import msgspec

from faults.files import make_privately, sync_folder, whole_file, write_whole
from nep_core.places import cache_folder
from nep_studio.blocks.own_animations import JointKeys, OwnAnimation, own_animations
from nep_studio.blocks.own_gestures import (
    OwnGesture,
    OwnRecogniser,
    OwnRecording,
    floats_of,
    own_gestures,
    own_recogniser,
    own_recordings,
    training_digest,
    unpacked_samples,
)
from nep_studio.blocks.program import Project

GESTURES_FOLDER = "gestures"
EVERYDAY = "everyday"
NEITHER = "?"
"""The label of movement that is neither a gesture nor nothing: a take that was left out."""
MOST_KEPT = 20
_JUST_S = 1e-6  # a sample at the very end of a take is part of it
_HEADER = ("t", "ax", "ay", "az", "gx", "gy", "gz")

Gestures = Mapping[str, OwnGesture]
Span = tuple[float, float, str]


@dataclass(frozen=True)
class RecogniserFile:
    """A gesture model in a folder that no other model is in; ``text`` is the model in base64."""

    folder: Path
    text: str

    @property
    def path(self) -> Path:
        """The model."""
        return self.folder / "recogniser.gestures"

    def write(self) -> None:
        """Write it if it is not there. Raises OSError."""
        if self.path.is_file():
            _note_use(self.folder)
            return
        try:
            data = b64decode(self.text, validate=True)
        except (binascii.Error, ValueError) as error:
            raise OSError("what was learned is damaged: train the gestures again") from error
        make_privately(self.folder)
        with whole_file(self.path) as file:  # another window may write the same one
            file.write(data)
        _forget_old(self.folder)


@dataclass(frozen=True)
class TakeFiles:
    """The recordings of a project as CSV files in a folder of their own."""

    folder: Path
    gestures: Gestures
    recordings: Mapping[str, OwnRecording]

    def write(self) -> None:
        """Write them if they are not there. Raises OSError."""
        if self.folder.is_dir():
            _note_use(self.folder)
            return
        make_privately(self.folder.parent)
        part = self.folder.with_suffix(f".{os.getpid()}.part")
        try:
            write_recordings(part, self.gestures, self.recordings)
            with suppress(OSError):  # another window was quicker
                part.rename(self.folder)
                sync_folder(self.folder.parent)
        finally:
            shutil.rmtree(part, ignore_errors=True)
        _forget_old(self.folder)


def recogniser_file(project: Project) -> RecogniserFile | None:
    """What the project's recogniser has learned; None when it has none."""
    recogniser = own_recogniser(project)
    return None if recogniser is None else file_of(recogniser)


def file_of(recogniser: OwnRecogniser) -> RecogniserFile:
    """A recogniser as the file that its node reads."""
    import hashlib  # slow to load

    digest = hashlib.sha256(recogniser.file.encode()).hexdigest()[:16]
    return RecogniserFile(cache_folder() / GESTURES_FOLDER / digest, recogniser.file)


def take_files(project: Project) -> TakeFiles | None:
    """The takes of the project's gestures; None when it has none."""
    gestures = {name: one for name, one in own_gestures(project).items() if one.takes}
    if not gestures:
        return None
    named = {take.recording for gesture in gestures.values() for take in gesture.takes}
    recordings = {key: one for key, one in own_recordings(project).items() if key in named}
    folder = cache_folder() / GESTURES_FOLDER / f"takes_{training_digest(project)[:16]}"
    return TakeFiles(folder, gestures, recordings)


def write_recordings(
    folder: Path, gestures: Gestures, recordings: Mapping[str, OwnRecording]
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
        write_whole(place / f"{key}.csv", "\n".join(lines) + "\n")


def _lines(key: str, recording: OwnRecording, gestures: Gestures) -> Iterator[str]:
    columns = 7 if recording.has_rotation else 4
    numbers = _numbers(recording)
    labels = labels_of(numbers[::columns], spans_of(key, recording, gestures))
    yield f"# person: {_one_word(recording.person)}"
    yield f"# gravity_included: {'yes' if recording.gravity_included else 'no'}"
    yield f"# simulated: {'yes' if recording.simulated else 'no'}"
    yield f"# wrist: {recording.wrist}"
    yield ",".join((*_HEADER[:columns], "gesture"))
    row = ",".join(["%.7g"] * columns)
    for at, label in enumerate(labels[: len(numbers) // columns]):
        yield f"{row % tuple(numbers[at * columns : (at + 1) * columns])},{label}"


def spans_of(key: str, recording: OwnRecording, gestures: Gestures) -> tuple[Span, ...]:
    """From when to when something else than nothing is made; what counts more comes later."""
    takes = [
        (take.start_s, take.end_s, NEITHER if take.left_out else name)
        for name, gesture in gestures.items()
        for take in gesture.takes
        if take.recording == key
    ]
    unknown = [(start_s, end_s, NEITHER) for start_s, end_s in recording.forgotten]
    return (*unknown, *sorted(takes, key=lambda span: (span[2] != NEITHER, span)))


def labels_of(times: Sequence[float], spans: Sequence[Span]) -> list[str]:
    """What is made at each of these times, which rise."""
    labels = [""] * len(times)
    for start_s, end_s, name in spans:
        first = bisect_left(times, start_s - _JUST_S)
        last = bisect_left(times, end_s + _JUST_S)
        labels[first:last] = [name] * (last - first)
        if first and labels[first - 1] == name != NEITHER:
            labels[first - 1] = ""  # two takes of a gesture that touch stay two
    return labels


def _one_word(text: str) -> str:
    """A text as a line of the file can have it."""
    return re.sub(r'[\s,;"]+', "_", text)


def _numbers(recording: OwnRecording) -> array[float]:
    try:
        return floats_of(unpacked_samples(recording.samples))
    except ValueError as error:
        raise OSError(str(error)) from error


def _note_use(folder: Path) -> None:
    """What is used stays in the cache longer than what is not."""
    with suppress(OSError):
        os.utime(folder)


def _forget_old(newest: Path) -> None:
    """Delete all but the newest folders of the cache: they are written again when needed."""
    if newest.parent != cache_folder() / GESTURES_FOLDER:
        return  # somebody keeps these files for good
    with suppress(OSError):
        found = newest.parent.iterdir()
        for old in sorted(found, key=lambda path: path.stat().st_mtime)[:-MOST_KEPT]:
            shutil.rmtree(old, ignore_errors=True)


# A project's animations as files, which the nodes of its robots read.

ANIMATIONS_FOLDER = "animations"


@dataclass(frozen=True)
class AnimationFiles:
    """A folder and the text of each file that must be in it, by file name.

    The same animations are always in the same folder, so that a robot that has them need not be
    started again; other ones are in another folder.
    """

    folder: Path
    texts: Mapping[str, str] = field(default_factory=dict)

    def write(self) -> None:
        """Write those files that are not there. Raises OSError."""
        make_privately(self.folder)
        for name, text in self.texts.items():
            path = self.folder / name
            if not path.is_file():
                with whole_file(path) as file:  # another window may write the same one
                    file.write(text.encode())


def animation_files(project: Project) -> AnimationFiles | None:
    """The files of a project's animations; None when it has none."""
    import hashlib  # slow to load

    texts = {f"{name}.toml": to_toml(one) for name, one in own_animations(project).items()}
    if not texts:
        return None
    digest = hashlib.sha256(msgspec.json.encode(sorted(texts.items()))).hexdigest()[:16]
    return AnimationFiles(cache_folder() / ANIMATIONS_FOLDER / digest, texts)


def to_toml(animation: OwnAnimation) -> str:
    """An animation as the text of a file such as those of the shipped animations."""
    texts = ("title", "description", "kind", "starts_from", "says")
    required = ("title", "description", "kind")
    head = [
        f"{name} = {_text(getattr(animation, name))}"
        for name in texts
        if getattr(animation, name) or name in required
    ]
    joints = [_joint(name, joint) for name, joint in animation.joints.items()]
    return "\n".join([*head, *joints])


def _joint(name: str, joint: JointKeys) -> str:
    bare = name if name.isascii() and name.isidentifier() else _text(name)
    lines = ["", f"[joints.{bare}]", f"times = {_row(joint.times)}", f"keys = {_row(joint.keys)}"]
    if joint.handles is not None:
        lines.append(f"handles = [{', '.join(map(_row, joint.handles))}]")
    return "\n".join([*lines, ""])


def _row(numbers: tuple[float, ...]) -> str:
    return f"[{', '.join(repr(round(float(number), 5)) for number in numbers)}]"


def _text(text: str) -> str:
    # JSON's texts are TOML's too, but for a control character that TOML wants to be escaped
    return msgspec.json.encode(text).decode().replace("\x7f", "\\u007f")
