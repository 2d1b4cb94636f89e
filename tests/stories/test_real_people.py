"""Real people: a model of their first five repetitions, and rules that fire on the rest.

The same pipeline as for everybody: ``nep-studio train``, the replay node, the gesture node, and a
program of blocks, one rule a gesture.
"""

from __future__ import annotations

import itertools
import json
import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nep_studio.__main__ import main
from nodes.recordings import Recording, read_recording, write_recording
from tests.stories.playing import Play, playing

pytestmark = [pytest.mark.real_data, pytest.mark.long]

GESTURES = [
    "left",
    "right",
    "forward",
    "backward",
    "bounce_up",
    "bounce_down",
    "turn_left",
    "turn_right",
    "shake_lr",
    "shake_ud",
]
REPETITIONS = 7 if os.environ.get("CI") else 10
"""So many of each gesture are used: five to learn from, and those that are played."""
SPEED = 6.0
EVERYDAY_SPEED = 25.0
"""Faster, for it is only counted what fires, and not when."""
TRUST = ("--trust",)
"""The project names its model by a whole path, which nobody has approved in the window."""
PAUSE_S = 1.0
"""Between the parts of the session that are played."""
SECONDS_LATE = PAUSE_S + 0.8
"""A rule may fire so long after a gesture's end, in the recording's time: the last gesture before
a pause is sure when the pause is over."""


@dataclass(frozen=True)
class Made:
    """A gesture that was made, between two times of its recording."""

    gesture: str
    begin_s: float
    end_s: float


def runs(recording: Recording) -> list[tuple[int, int]]:
    """Where a gesture is made: first sample and the one behind the last."""
    labels = recording.labels or []
    edges = [i for i in range(1, len(labels)) if labels[i] != labels[i - 1]]
    bounds = [0, *edges, len(labels)]
    return [(a, b) for a, b in itertools.pairwise(bounds) if labels[a]]


def part(recording: Recording, begin: int, end: int) -> Recording:
    """Some samples of a recording, from second 0 on."""
    assert recording.labels is not None and recording.gyr is not None
    return replace(
        recording,
        t=recording.t[begin:end] - recording.t[begin],
        acc=recording.acc[begin:end],
        gyr=recording.gyr[begin:end],
        labels=recording.labels[begin:end],
    )


def joined(parts: list[Recording]) -> Recording:
    """One session of several recordings, with pauses between them."""
    starts_s = np.cumsum([0.0, *(one.t[-1] + PAUSE_S for one in parts[:-1])])
    return replace(
        parts[0],
        t=np.concatenate([one.t + start_s for one, start_s in zip(parts, starts_s, strict=True)]),
        acc=np.concatenate([one.acc for one in parts]),
        gyr=np.concatenate([one.gyr for one in parts]),
        labels=[label for one in parts for label in one.labels or []],
    )


def split(source: Path, person: str, folder: Path) -> list[Made]:
    """Five repetitions as ``train/*.csv``, later ones as ``rest.csv``; what is to come."""
    (folder / "train").mkdir()
    rest = []
    for gesture in GESTURES:
        recording = read_recording(source / f"{person}_{gesture}.csv")
        made = runs(recording)
        middle = (made[4][1] + made[5][0]) // 2
        end = made[REPETITIONS][0] if len(made) > REPETITIONS else len(recording.t)
        write_recording(folder / "train" / f"{person}_{gesture}.csv", part(recording, 0, middle))
        rest.append(part(recording, middle, end))
    session = joined(rest)
    write_recording(folder / "rest.csv", session)
    labels = session.labels or []
    return [Made(labels[a], session.t[a], session.t[b - 1]) for a, b in runs(session)]


def project(folder: Path, model: Path) -> Path:
    """A program with a rule for each gesture, which counts it."""
    blocks: list[dict[str, Any]] = []
    stacks = []
    for number, gesture in enumerate(GESTURES):
        hat, count = f"b{2 * number + 1}", f"b{2 * number + 2}"
        again = {"gesture": gesture, "again": "queue"}
        blocks.append({"id": hat, "type": "event.gesture", "fields": again})
        fields = {"variable": "v1", "amount": 1}
        blocks.append({"id": count, "type": "variable.change", "fields": fields})
        stacks.append({"id": f"s{number}", "x": 0, "y": 100 * number, "body": [hat, count]})
    settings = {"model": str(model)}
    fields = {"node": "perceptual/gesture", "name": "gestures", "parameters": settings}
    blocks.append({"id": "b100", "type": "nodes.launch", "fields": fields})
    nodes = [{"id": "s100", "x": 0, "y": 0, "body": ["b100"]}]
    file = folder / "count.nep"
    whole = {
        "format": "nep-studio-project",
        "version": 2,
        "name": "Count",
        "variables": [{"id": "v1", "name": "made"}],
        "blocks": blocks,
        "pages": {"behaviour": stacks, "robots": [], "nodes": nodes},
    }
    file.write_text(json.dumps(whole), encoding="utf-8")
    return file


def fired(play: Play) -> list[tuple[str, float]]:
    """The rules that fired: the gesture, and the second of the recording."""
    began_s, firings = 0.0, []
    for event in play.events:
        if event["topic"] == "/node_state" and event["description"].startswith("plays "):
            began_s = event["time"]
        elif event.get("event") == "rule_started":
            gesture = event["rule"].removeprefix("gesture_")
            firings.append((gesture, (event["time"] - began_s) * SPEED))
    return firings


def caught(made: list[Made], firings: list[tuple[str, float]]) -> list[Made]:
    """The gestures for which the right rule fired, each firing counted for one gesture only."""
    found: list[Made] = []
    for gesture, second in firings:
        fitting = [
            one
            for one in made
            if one.gesture == gesture
            and one.begin_s <= second <= one.end_s + SECONDS_LATE
            and one not in found
        ]
        found += fitting[-1:]
    return found


@pytest.fixture(params=["l"] if os.environ.get("CI") else ["j", "l", "na"])
def trained(request: pytest.FixtureRequest, shared_data: Path, tmp_path: Path) -> Any:
    """A person's project, what is to come, and the folder."""
    to_come = split(shared_data / "uhh_gestures", request.param, tmp_path)
    model = tmp_path / "mine.gestures"
    words = ["train", str(tmp_path / "train"), "-o", str(model), "--method", "trees"]
    assert main(words) == 0  # by the method that the gesture node uses
    return project(tmp_path, model), to_come, tmp_path


@pytest.mark.timeout(300)
def test_the_right_rule_fires_for_most_gestures_and_hardly_any_in_daily_life(
    trained: Any, shared_data: Path
) -> None:
    file, to_come, folder = trained

    with playing(file, "--recording", folder / "rest.csv", "--speed", SPEED, *TRUST) as play:
        assert play.finish(200) == 0, play.errors()
    right = caught(to_come, fired(play))
    missed = [one for one in to_come if one not in right]
    assert len(right) >= 0.85 * len(to_come), f"missed: {missed}"

    everyday = shared_data / "everyday_watch"
    with playing(file, "--recording", everyday, "--speed", EVERYDAY_SPEED, *TRUST) as play:
        assert play.finish(200) == 0, play.errors()
    minutes = sum(read_recording(path).t[-1] for path in everyday.glob("*.csv")) / 60
    assert len(fired(play)) < minutes
