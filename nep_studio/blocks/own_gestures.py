"""The gestures of a project: recordings of movement, the takes marked in them, what was learned.

Each gesture, each recording and the recogniser is kept in the project's file under a key of its
own, so that each has a line there and a step of undo. Movement that no take marks is *nothing*:
the pauses teach a recogniser what to ignore. What was learned is a gesture model as its nodes read
it (docs/gesture_models.md); nothing in here looks into it.
"""

from __future__ import annotations

import binascii
import math
import re
import sys
import zlib
from array import array
from base64 import b64decode, b64encode
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain, pairwise
from typing import Any, Literal, get_args
from weakref import WeakKeyDictionary

import msgspec

from faults import Text, text_of

from .edits.content import GESTURE, RECOGNISER, RECORDING, SetExtra
from .file_text import in_words
from .own_animations import KEPT_NAME, free_kept_name, kept
from .program import Project
from .slots import why_not_name, why_not_text

# Samples of a sensor as text: rows of little-endian 32-bit floats, deflated, in base64.
#
# A row is a time in s, three accelerations in m/s² and, where there is a gyroscope, three rotation
# rates in rad/s.

LARGEST_BYTES = 12_000_000
"""Of the floats: an hour at 100 samples a second with rotation is ten million."""
LARGEST_TEXT = 12_000_000


def packed_samples(rows: bytes) -> str:
    """The text for the bytes of 32-bit floats, row by row."""
    return b64encode(zlib.compress(rows, 6)).decode("ascii")


def unpacked_samples(text: str) -> bytes:
    """The bytes of 32-bit floats; ValueError when the text is no such thing, or too much."""
    unpacking = zlib.decompressobj()
    try:
        rows = unpacking.decompress(b64decode(text, validate=True), LARGEST_BYTES + 1)
    except (binascii.Error, zlib.error, ValueError) as error:
        raise ValueError("The samples cannot be unpacked.") from error
    if len(rows) > LARGEST_BYTES:
        raise ValueError("There are too many samples.")
    if not unpacking.eof or unpacking.unused_data or len(rows) % 4:
        raise ValueError("The samples end in the middle.")
    return rows


def floats_of(rows: bytes) -> array[float]:
    """The numbers, one row after the other."""
    numbers = array("f")
    numbers.frombytes(rows)
    if sys.byteorder == "big":
        numbers.byteswap()
    return numbers


def why_not_samples(text: str, columns: int) -> Text | None:
    """Why this text is not samples with so many columns, as a sentence; None when it is."""
    if len(text) > LARGEST_TEXT:
        return Text("it has too many samples.")
    try:
        numbers = floats_of(unpacked_samples(text))
    except ValueError as error:
        return Text(str(error))
    if not numbers or len(numbers) % columns:
        return Text("its samples are not whole rows.")
    if not math.isfinite(sum(numbers)):  # one number that is none spoils the sum
        return Text("each of its samples must be a finite number.")
    times = numbers[::columns]
    if times[0] < 0 or any(b < a for a, b in pairwise(times)):
        return Text("the times of its samples must rise.")
    return None


Wrist = Literal["left", "right", "hand"]
WRISTS = get_args(Wrist)
"""Where the sensor was: on one of the wrists, or held in the hand."""

TRIGGER = 0.75
"""How certain a recogniser must be of a gesture, unless somebody sets it otherwise."""
MOST_TAKES = 500
LONGEST_S = 3600.0
LARGEST_RECOGNISER_TEXT = 7_000_000
_ID = re.compile(r"[A-Za-z0-9_]{1,40}")
_DIGESTS: WeakKeyDictionary[Project, tuple[int, str]] = WeakKeyDictionary()
_NO_GESTURE = frozenset(("none", "nothing"))
"""In a recording these words stand for no gesture, so none can have them as its name."""


class OwnTake(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """One performance: from ``start_s`` to ``end_s`` of a recording.

    ``left_out``: not learned from, neither as the gesture nor as nothing.
    """

    id: str
    recording: str
    start_s: float
    end_s: float
    left_out: bool = False


class OwnGesture(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A gesture; ``number`` is its place in the list, ``certainty`` what it takes to trigger."""

    title: str
    number: int = 0
    certainty: float = TRIGGER
    takes: tuple[OwnTake, ...] = ()


class OwnRecording(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Movement as a sensor told it; ``samples`` are packed rows (t s, acc m/s², gyr rad/s).

    ``everyday`` movement has no gesture in it. ``forgotten`` are the spans (s) of takes that were
    deleted: they are neither a gesture nor nothing. ``recorded`` is when, in ISO 8601.
    """

    seconds: float
    rate_hz: float
    samples: str
    person: str = ""
    wrist: Wrist = "right"
    source: str = ""
    gravity_included: bool = True
    has_rotation: bool = False
    simulated: bool = False
    everyday: bool = False
    recorded: str = ""
    forgotten: tuple[tuple[float, float], ...] = ()


class OwnRecogniser(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """What was learned: ``file`` is a gesture model in base64, ``gestures`` those that it knows.

    ``trained_on`` is the digest of the training data, ``report`` what the training found out.
    """

    trained_on: str
    gestures: tuple[str, ...]
    file: str
    report: dict[str, Any] = {}


def own_gestures(project: Project) -> dict[str, OwnGesture]:
    """The gestures of a project by name, in their order."""
    found = kept(project, GESTURE, OwnGesture, why_not_gesture)
    return dict(sorted(found.items(), key=lambda item: (item[1].number, item[0])))


def own_recordings(project: Project) -> dict[str, OwnRecording]:
    """The recordings of a project by id."""
    return kept(project, RECORDING, OwnRecording, _shape_of_recording)


def own_recogniser(project: Project) -> OwnRecogniser | None:
    """What was learned from the recordings, None when nothing was."""
    value = project.extra.get(RECOGNISER)
    if value is None or why_not_recogniser(value) is not None:
        return None
    return msgspec.convert(value, OwnRecogniser)


def keep_gesture(name: str, gesture: OwnGesture | None) -> SetExtra:
    """The edit that keeps a gesture under a name; None takes it away."""
    return SetExtra(GESTURE + name, _plain(gesture))


def keep_recording(recording_id: str, recording: OwnRecording | None) -> SetExtra:
    """The edit that keeps a recording under an id; None takes it away."""
    return SetExtra(RECORDING + recording_id, _plain(recording))


def keep_recogniser(recogniser: OwnRecogniser | None) -> SetExtra:
    """The edit that keeps what was learned; None forgets it."""
    return SetExtra(RECOGNISER, _plain(recogniser))


def training_digest(project: Project) -> str:
    """A short text that differs when there is something else to learn from.

    It is reckoned once for each change of what the project keeps: recordings are long, and plans
    ask for it often.
    """
    revision, digest = _DIGESTS.get(project, (-1, ""))
    if revision != project.extra_revision:
        digest = _digest(project)
        _DIGESTS[project] = project.extra_revision, digest
    return digest


def _digest(project: Project) -> str:
    import hashlib  # slow to load

    gestures = {name: one.takes for name, one in own_gestures(project).items() if one.takes}
    recordings = {key: (one, one.samples) for key, one in own_recordings(project).items()}
    data = msgspec.json.encode([sorted(gestures.items()), sorted(recordings.items())])
    return hashlib.sha256(data).hexdigest()[:32]


def trained_gestures(project: Project) -> dict[str, OwnGesture]:
    """The gestures that the project's recogniser knows, and that are still there."""
    recogniser = own_recogniser(project)
    known = recogniser.gestures if recogniser is not None else ()
    return {name: one for name, one in own_gestures(project).items() if name in known}


def free_gesture_name(title: str, taken: Iterable[str]) -> str:
    """A name for a gesture with this title, which none of the others has."""
    return free_kept_name(title, "gesture", {*taken, *_NO_GESTURE})


def why_not_gesture(name: str, value: object) -> Text | None:
    """Why this cannot be a gesture of a project, as a sentence, or None when it can."""
    if not KEPT_NAME.fullmatch(name):
        return Text(
            "its name may have small letters, digits and _ in it, and begins with a letter."
        )
    try:
        gesture = msgspec.convert(value, OwnGesture)
    except msgspec.ValidationError as error:
        return in_words(error)
    return next(_reasons(gesture), None)


def _reasons(gesture: OwnGesture) -> Iterator[Text]:
    if (reason := why_not_name(gesture.title)) is not None:
        yield text_of("its title: {reason}", reason=reason)
    if not 0.0 < gesture.certainty <= 1.0:
        yield Text("the certainty that it takes must be above 0 and at most 1.")
    if len(gesture.takes) > MOST_TAKES:
        yield text_of("it can have {most_takes} takes at most.", most_takes=MOST_TAKES)
    if len({take.id for take in gesture.takes}) < len(gesture.takes):
        yield Text("two of its takes have the same id.")
    for take in gesture.takes:
        if not _ID.fullmatch(take.id) or not _ID.fullmatch(take.recording):
            yield Text(
                "the id of a take or of its recording has other signs than letters, digits and _."
            )
        if not 0.0 <= take.start_s < take.end_s <= LONGEST_S:
            yield Text("each take must end after its start, within its recording.")


def why_not_recording(recording_id: str, value: object) -> Text | None:
    """Why this cannot be a recording of a project, as a sentence, or None when it can."""
    if (reason := _shape_of_recording(recording_id, value)) is not None:
        return reason
    recording = msgspec.convert(value, OwnRecording)
    return why_not_samples(recording.samples, 7 if recording.has_rotation else 4)


def _shape_of_recording(recording_id: str, value: object) -> Text | None:
    if not _ID.fullmatch(recording_id):
        return Text("its id may have letters, digits and _ in it.")
    try:
        recording = msgspec.convert(value, OwnRecording)
    except msgspec.ValidationError as error:
        return in_words(error)
    for text in (recording.person, recording.source, recording.recorded):
        if (reason := why_not_text(text)) is not None:
            return reason
    numbers = (recording.seconds, recording.rate_hz, *chain.from_iterable(recording.forgotten))
    if not all(map(math.isfinite, numbers)) or min(numbers) < 0:
        return Text("each number must be finite, and not below 0.")
    if recording.seconds > LONGEST_S:
        return text_of("it lasts {longest_s} minutes at most.", longest_s=f"{LONGEST_S / 60:.0f}")
    return None


def why_not_recogniser(value: object) -> Text | None:
    """Why this cannot be what was learned, as a sentence, or None when it can."""
    try:
        recogniser = msgspec.convert(value, OwnRecogniser)
    except msgspec.ValidationError as error:
        return in_words(error)
    if len(recogniser.file) > LARGEST_RECOGNISER_TEXT:
        return Text("it is too large.")
    return None


def why_not_kept(key: str, value: object) -> Text | None:
    """Why the project's file cannot have this under a key of gestures; None when it can."""
    if key == RECOGNISER:
        what, reason = Text("what was learned of gestures"), why_not_recogniser(value)
    elif key.startswith(GESTURE):
        name = key.removeprefix(GESTURE)
        what = text_of("the gesture “{name}”", name=name[:40])
        reason = why_not_gesture(name, value)
    elif key.startswith(RECORDING):
        name = key.removeprefix(RECORDING)
        what = text_of("the recording “{name}”", name=name[:40])
        reason = why_not_recording(name, value)
    else:
        return None
    return None if reason is None else text_of("{what}: {reason}", what=what, reason=reason)


def gestures_with(
    choices: Mapping[str, Mapping[str, str]], project: Project
) -> dict[str, Mapping[str, str]]:
    """Tables of choices with the project's gestures before those that every project has."""
    own = {name: gesture.title for name, gesture in own_gestures(project).items()}
    if not own or "gestures" not in choices:  # an absent table means that any value passes
        return dict(choices)
    others = {name: title for name, title in choices["gestures"].items() if name not in own}
    return {**choices, "gestures": {**own, **others}}


def _plain(value: msgspec.Struct | None) -> Any:
    return None if value is None else msgspec.to_builtins(value)
