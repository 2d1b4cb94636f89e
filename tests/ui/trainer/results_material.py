"""Gestures of simulated people in a project, and reports of trainings, for the tests of results."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from nep_studio.blocks.own_gestures import (
    OwnGesture,
    OwnRecogniser,
    OwnRecording,
    OwnTake,
    keep_gesture,
    keep_recogniser,
    keep_recording,
)
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.live import Samples, packed
from nodes.perceptual.recognition.validation import CERTAINTIES
from nodes.recordings import Recording
from nodes.sensory.arm.people import simulate_session


def session(gestures: list[str], takes: int, person: int = 0, seed: int = 0) -> Recording:
    """A stream in which a simulated person makes each gesture so many times."""
    return simulate_session(person, gestures, takes, seed=seed)


def samples_of(recording: Recording) -> Samples:
    return Samples(recording.t, recording.acc, recording.gyr)


def spans_of(recording: Recording) -> list[tuple[str, float, float]]:
    """Each gesture that is labelled: its name, its start and its end."""
    labels = ["", *(recording.labels or []), ""]
    edges = [at for at, (a, b) in enumerate(pairwise(labels)) if a != b]
    return [
        (labels[first + 1], float(recording.t[first]), float(recording.t[end - 1]))
        for first, end in pairwise(edges)
        if labels[first + 1]
    ]


def put_session(
    desk: GestureController, recording: Recording, key: str = "s1", *, has_rotation: bool = True
) -> None:
    """Let the project have a recorded session, with a take for each label."""
    measured = Samples(recording.t, recording.acc, recording.gyr if has_rotation else None)
    own = OwnRecording(
        seconds=measured.seconds,
        rate_hz=measured.rate_hz,
        samples=packed(measured),
        has_rotation=has_rotation,
        person="Ann Lee",
        simulated=True,
    )
    takes: dict[str, list[OwnTake]] = {}
    for number, (name, start_s, end_s) in enumerate(spans_of(recording)):
        takes.setdefault(name, []).append(OwnTake(f"{key}_{number}", key, start_s, end_s))
    edits = [keep_recording(key, own)]
    for number, name in enumerate(sorted(takes)):
        gesture = OwnGesture(name.capitalize(), number, takes=tuple(takes[name]))
        edits.append(keep_gesture(name, gesture))
    desk.change("record takes", edits)


def put_gestures(desk: GestureController, report: dict[str, Any], titles: dict[str, str]) -> None:
    """Let the project have gestures without recordings, and a recogniser with this report."""
    edits = [
        keep_gesture(name, OwnGesture(title, number, takes=takes_of(name, 10)))
        for number, (name, title) in enumerate(titles.items())
    ]
    edits.append(keep_recogniser(OwnRecogniser("then", tuple(titles), "", report)))
    desk.change("record takes", edits)


def takes_of(name: str, count: int) -> tuple[OwnTake, ...]:
    return tuple(OwnTake(f"{name}_{at}", "r1", at * 3.0, at * 3.0 + 1) for at in range(count))


def curve(shift: float = 0.0, rate: float = 12.0) -> list[dict[str, float]]:
    """A curve as a training reports it: the higher the point, the less is caught."""
    return [
        {
            "certainty": c,
            "caught": float(np.clip(1.25 - c + shift, 0, 1)) if c > 0.5 else 1.0,
            "false_everyday_per_hour": max(0.0, rate * (0.9 - c)),
            "false_in_others": int(8 * max(0.0, 0.7 - c)),
        }
        for c in CERTAINTIES
    ]


def report(
    confusion: list[tuple[str, str, int]],
    takes: dict[str, int],
    left_out: list[tuple[str, int, float, str]] = (),
    people: dict[str, tuple[int, int]] | None = None,
    rate: float = 0.0,
    everyday_s: float = 600.0,
) -> dict[str, Any]:
    """The report of one method; ``left_out`` are gesture, number of the take, certainty, found."""
    return {
        "takes": takes,
        "confusion": [list(one) for one in confusion],
        "recall": 0.9,
        "precision": 0.9,
        "f1": 0.9,
        "everyday_triggers": 1,
        "everyday_s": everyday_s,
        "curves": {name: curve(rate=rate) for name in takes},
        "left_out": [
            {
                "gesture": name,
                "source": "r1",
                "start_s": at * 3.0 + 0.02,
                "certainty": certainty,
                "recognised": found,
            }
            for name, at, certainty, found in left_out
        ],
        "people": {
            name: {"made": made, "right": right, "fired": made, "f1": 0.5}
            for name, (made, right) in (people or {}).items()
        },
    }
