"""The gestures of a project: recordings of movement, the takes marked in them, what was learned.

Each gesture, each recording and the recogniser is kept in the project's file under a key of its
own, so that each has a line there and a step of undo. Movement that no take marks is *nothing*:
the pauses teach a recogniser what to ignore. What was learned is a gesture model as its nodes read
it (docs/gesture_models.md); nothing in here looks into it.
"""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Container, Iterable, Iterator, Mapping
from itertools import chain
from typing import Any, Literal, get_args
from weakref import WeakKeyDictionary

import msgspec

from .edits import SetExtra
from .edits.kept import GESTURE, RECOGNISER, RECORDING
from .file_text import in_words
from .kept_names import KEPT_NAME, free_kept_name
from .packed_samples import why_not_samples
from .program import Project
from .values import why_not_name, why_not_text

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
    found = {
        key.removeprefix(GESTURE): msgspec.convert(value, OwnGesture)
        for key, value in project.extra.items()
        if key.startswith(GESTURE) and why_not_gesture(key.removeprefix(GESTURE), value) is None
    }
    return dict(sorted(found.items(), key=lambda item: (item[1].number, item[0])))


def own_recordings(project: Project) -> dict[str, OwnRecording]:
    """The recordings of a project by id."""
    return {
        key.removeprefix(RECORDING): msgspec.convert(value, OwnRecording)
        for key, value in project.extra.items()
        if key.startswith(RECORDING)
        and _shape_of_recording(key.removeprefix(RECORDING), value) is None
    }


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


def why_not_gesture(name: str, value: object) -> str | None:
    """Why this cannot be a gesture of a project, as a sentence, or None when it can."""
    if not KEPT_NAME.fullmatch(name):
        return "its name may have small letters, digits and _ in it, and begins with a letter."
    try:
        gesture = msgspec.convert(value, OwnGesture)
    except msgspec.ValidationError as error:
        return f"{in_words(error)}."
    return next(_reasons(gesture), None)


def _reasons(gesture: OwnGesture) -> Iterator[str]:
    if (reason := why_not_name(gesture.title)) is not None:
        yield f"its title: {reason}"
    if not 0.0 < gesture.certainty <= 1.0:
        yield "the certainty that it takes must be above 0 and at most 1."
    if len(gesture.takes) > MOST_TAKES:
        yield f"it can have {MOST_TAKES} takes at most."
    if len({take.id for take in gesture.takes}) < len(gesture.takes):
        yield "two of its takes have the same id."
    for take in gesture.takes:
        if not _ID.fullmatch(take.id) or not _ID.fullmatch(take.recording):
            yield "the id of a take or of its recording has other signs than letters, digits and _."
        if not 0.0 <= take.start_s < take.end_s <= LONGEST_S:
            yield "each take must end after its start, within its recording."


def why_not_recording(recording_id: str, value: object) -> str | None:
    """Why this cannot be a recording of a project, as a sentence, or None when it can."""
    if (reason := _shape_of_recording(recording_id, value)) is not None:
        return reason
    recording = msgspec.convert(value, OwnRecording)
    return why_not_samples(recording.samples, 7 if recording.has_rotation else 4)


def _shape_of_recording(recording_id: str, value: object) -> str | None:
    if not _ID.fullmatch(recording_id):
        return "its id may have letters, digits and _ in it."
    try:
        recording = msgspec.convert(value, OwnRecording)
    except msgspec.ValidationError as error:
        return f"{in_words(error)}."
    for text in (recording.person, recording.source, recording.recorded):
        if (reason := why_not_text(text)) is not None:
            return reason
    numbers = (recording.seconds, recording.rate_hz, *chain.from_iterable(recording.forgotten))
    if not all(map(math.isfinite, numbers)) or min(numbers) < 0:
        return "each number must be finite, and not below 0."
    if recording.seconds > LONGEST_S:
        return f"it lasts {LONGEST_S / 60:.0f} minutes at most."
    return None


def why_not_recogniser(value: object) -> str | None:
    """Why this cannot be what was learned, as a sentence, or None when it can."""
    try:
        recogniser = msgspec.convert(value, OwnRecogniser)
    except msgspec.ValidationError as error:
        return f"{in_words(error)}."
    if len(recogniser.file) > LARGEST_RECOGNISER_TEXT:
        return "it is too large."
    return None


def why_not_kept(key: str, value: object) -> str | None:
    """Why the project's file cannot have this under a key of gestures; None when it can."""
    if key == RECOGNISER:
        what, reason = "what was learned of gestures", why_not_recogniser(value)
    elif key.startswith(GESTURE):
        name = key.removeprefix(GESTURE)
        what, reason = f"the gesture “{name[:40]}”", why_not_gesture(name, value)
    elif key.startswith(RECORDING):
        name = key.removeprefix(RECORDING)
        what, reason = f"the recording “{name[:40]}”", why_not_recording(name, value)
    else:
        return None
    return None if reason is None else f"{what}: {reason}"


def gestures_with(
    choices: Mapping[str, Mapping[str, str]], project: Project
) -> dict[str, Mapping[str, str]]:
    """Tables of choices with the project's gestures before those that every project has."""
    own = {name: gesture.title for name, gesture in own_gestures(project).items()}
    if not own or "gestures" not in choices:  # an absent table means that any value passes
        return dict(choices)
    return {**choices, "gestures": {**own, **_others(choices["gestures"], own)}}


def _others(shipped: Mapping[str, str], own: Container[str]) -> dict[str, str]:
    return {name: title for name, title in shipped.items() if name not in own}


def _plain(value: msgspec.Struct | None) -> Any:
    return None if value is None else msgspec.to_builtins(value)
