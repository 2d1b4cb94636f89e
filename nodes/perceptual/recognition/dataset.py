"""What gestures are learned from: a folder of recordings, made fit for each other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from faults import Fault, fault_of
from nep_core.errors import RecordingError
from nep_core.wire.messages import Wrist
from nodes.recordings import Recording, read_recordings
from nodes.sensory.arm.people import simulate_everyday

from .model import Model, Sensor
from .streams import MAX_GAP_S, UNKNOWN, takes_of, usual_wrist, worn_at
from .training import train

# Movement without gestures, by simulated people, so that a model knows what to ignore.

_PEOPLE = 6
_SECONDS = 60.0


def simulated_everyday(first_person: int = 0) -> list[Recording]:
    """Six simulated people, a minute each."""
    people = range(first_person, first_person + _PEOPLE)
    return [simulate_everyday(person, _SECONDS) for person in people]


EVERYDAY = "everyday"
"""The folder, in a folder of recordings, for those of movement without gestures."""
LEAST_TAKES = 3
FEW_TAKES = "few_takes"
"""The code of the remark that a gesture has fewer."""
_MOST_SENSORS = 20
_LEAST_NOTHING_S = 3.0


@dataclass(frozen=True)
class Material:
    """Recordings of gestures and of everyday movement; ``remarks`` tell what is amiss with them.

    ``wrist`` is where the sensors were worn, "" when nobody said.
    """

    recordings: tuple[Recording, ...]
    everyday: tuple[Recording, ...]
    wrist: Wrist
    remarks: tuple[Fault, ...]

    @property
    def has_rotation(self) -> bool:
        """Whether it is learned from the gyroscope too."""
        return all(one.gyr is not None for one in self.recordings)

    def with_everyday(self, more: Sequence[Recording]) -> Material:
        """The same with more everyday movement."""
        return replace(self, everyday=(*self.everyday, *more))


def read_material(folder: Path, everyday: Path | None = None) -> Material:
    """Read the recordings of a folder; RecordingError says which cannot be used.

    Everyday movement is in the folder ``everyday`` within, or in another one.
    """
    own = everyday or folder / EVERYDAY
    has_own = everyday is not None or (own.is_dir() and any(own.glob("*.[cC][sS][vV]")))
    found = read_recordings(folder)
    idle = [_without_gestures(one) for one in read_recordings(own)] if has_own else []
    wrist = usual_wrist(found)
    used = [one for one in idle if _is_as_good(one, found)]
    remarks = (*_remarks(found, wrist), *_about_left_out(len(idle) - len(used), len(idle)))
    return Material(
        tuple(worn_at(one, wrist) for one in found),
        tuple(worn_at(one, wrist) for one in used),
        wrist,
        remarks,
    )


@cache
def everybodys_movement() -> tuple[Recording, ...]:
    """Everyday movement of simulated people; made once, as it takes a while."""
    return tuple(simulated_everyday())


def learn(
    material: Material, methods: Sequence[str], tell: Callable[[str], None] = lambda progress: None
) -> Model:
    """The model of the gestures in the material; RecordingError says why there can be none."""
    every = (*material.recordings, *material.everyday)
    if sum(_nothing_s(one) for one in every) < _LEAST_NOTHING_S:
        raise RecordingError(
            "There is hardly anything but gestures in the recordings: to know a gesture is to know"
            " what is none, too.",
            checklist=(
                "Keep a second of rest before and after each gesture in the recording.",
                "Or put recordings of everyday movement into the folder {everyday}.",
            ),
            everyday=EVERYDAY,
        )
    model = train(material.recordings, material.everyday, methods, tell=tell)
    return replace(model, wrist=material.wrist, sensors=_sensors(material.recordings))


def _nothing_s(recording: Recording) -> float:
    """For how long a recording has no gesture in it, in s."""
    steps_s = np.minimum(np.diff(recording.t), MAX_GAP_S)
    if recording.labels is None:
        return float(steps_s.sum())
    is_nothing = np.array([not label for label in recording.labels])
    return float(steps_s[is_nothing[1:]].sum())


def _without_gestures(recording: Recording) -> Recording:
    """Everyday recordings may name activities (sitting, walking), which are no gestures."""
    if recording.labels is None or UNKNOWN not in recording.labels:
        return replace(recording, labels=None)
    labels = [UNKNOWN if label == UNKNOWN else "" for label in recording.labels]
    return replace(recording, labels=labels)


def _is_as_good(idle: Recording, recordings: Sequence[Recording]) -> bool:
    """Whether everyday movement has all that the gestures have: else they would lose it too."""
    gyroscope = all(one.gyr is not None for one in recordings)
    gravity = all(one.gravity_included for one in recordings)
    return (idle.gyr is not None or not gyroscope) and (idle.gravity_included or not gravity)


def _about_left_out(left_out: int, count: int) -> list[Fault]:
    if not left_out:
        return []
    return [
        fault_of(
            "{left_out} of {count} recordings of everyday movement are not used: their sensor "
            "tells less than that of the gestures.",
            code="everyday_left_out",
            left_out=left_out,
            count=count,
        )
    ]


def _remarks(recordings: Sequence[Recording], wrist: Wrist) -> list[Fault]:
    """What of the recordings makes the model worse than it could be."""
    count = len(recordings)
    silent = sum(one.gyr is None for one in recordings)
    weightless = sum(not one.gravity_included for one in recordings)
    others = sum(one.wrist not in ("", wrist) for one in recordings)
    remarks = _few_takes(recordings)
    if 0 < silent < count:
        remarks.append(
            fault_of(
                "{silent} of {count} recordings have no rotation (gyroscope), so the gestures are "
                "learned without it. They are told apart better when all recordings have it.",
                code="no_rotation",
                silent=silent,
                count=count,
            )
        )
    if 0 < weightless < count:
        remarks.append(
            fault_of(
                "{weightless} of {count} recordings have no gravity in their acceleration, so the "
                "gestures are learned without it. Record all of them with the same sensor.",
                code="no_gravity",
                weightless=weightless,
                count=count,
            )
        )
    if others:
        remarks.append(
            fault_of(
                "{others} of {count} recordings were made on another wrist than most, or in the "
                "hand.",
                code="other_wrist",
                others=others,
                count=count,
            )
        )
    return remarks


def _few_takes(recordings: Sequence[Recording]) -> list[Fault]:
    takes = Counter(take.gesture for one in recordings for take in takes_of(one))
    few = {name: count for name, count in sorted(takes.items()) if count < LEAST_TAKES}
    only = {
        1: "{name} was recorded only once: record it 3 times at least, better 5.",
        2: "{name} was recorded only twice: record it 3 times at least, better 5.",
    }
    return [fault_of(only[count], code=FEW_TAKES, name=name) for name, count in few.items()]


def _sensors(recordings: Sequence[Recording]) -> tuple[Sensor, ...]:
    """The different sensors that the recordings were made with."""
    found = dict.fromkeys(
        Sensor(one.device, float(f"{one.rate_hz:.2g}"), one.gravity_included, one.gyr is not None)
        for one in recordings
    )
    return tuple(found)[:_MOST_SENSORS]
