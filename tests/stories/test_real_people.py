"""Real people: a model of their first five repetitions, and rules that fire on the rest.

The same pipeline as for everybody: ``nep-studio train``, the replay node, the gesture node, and a
program of blocks, one rule a gesture.
"""

from __future__ import annotations

import itertools
import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest

from nep_studio.__main__ import main
from nodes.recordings import Recording, read_recording, write_recording
from tests.stories.playing import Play, playing

pytestmark = pytest.mark.real_data

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
SPEED = 6.0
SECONDS_LATE = 1.2
"""A rule may fire so long after a gesture's end, in the recording's time."""


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


def split(source: Path, person: str, folder: Path) -> dict[str, list[Made]]:
    """Put the first five repetitions into ``train``, the others into ``play``; what is to come."""
    to_come = {}
    for name in ("train", "play"):
        (folder / name).mkdir()
    for gesture in GESTURES:
        recording = read_recording(source / f"{person}_{gesture}.csv")
        made = runs(recording)
        middle = (made[4][1] + made[5][0]) // 2
        write_recording(folder / "train" / f"{person}_{gesture}.csv", part(recording, 0, middle))
        rest = part(recording, middle, len(recording.t))
        write_recording(folder / "play" / f"{gesture}.csv", rest)
        to_come[gesture] = [Made(gesture, rest.t[a], rest.t[b - 1]) for a, b in runs(rest)]
    return to_come


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
        "version": 1,
        "name": "Count",
        "variables": [{"id": "v1", "name": "made"}],
        "blocks": blocks,
        "pages": {"behaviour": stacks, "robots": [], "nodes": nodes},
    }
    file.write_text(json.dumps(whole), encoding="utf-8")
    return file


def fired(play: Play) -> Iterator[tuple[str, str, float]]:
    """The rules that fired: the recording that was playing, the gesture, its second."""
    source, began_s = "", 0.0
    for event in play.events:
        plays = re.match(r"plays (\w+) ", event.get("description", ""))
        if event["topic"] == "/node_state" and plays:
            source, began_s = plays[1], event["time"]
        elif event.get("event") == "rule_started":
            gesture = event["rule"].removeprefix("gesture_")
            yield source, gesture, (event["time"] - began_s) * SPEED


def caught(made: Made, firings: list[tuple[str, str, float]]) -> bool:
    """Whether the right rule fired while the gesture was made or just after."""
    return any(
        (source, gesture) == (made.gesture, made.gesture)
        and made.begin_s <= second <= made.end_s + SECONDS_LATE
        for source, gesture, second in firings
    )


@pytest.fixture(params=["j", "l", "na"])
def trained(request: pytest.FixtureRequest, shared_data: Path, tmp_path: Path) -> Any:
    """A person's project, what is to come, and the folder."""
    to_come = split(shared_data / "uhh_gestures", request.param, tmp_path)
    model = tmp_path / "mine.gestures"
    assert main(["train", str(tmp_path / "train"), "-o", str(model)]) == 0
    return project(tmp_path, model), to_come, tmp_path


@pytest.mark.timeout(300)
def test_the_right_rule_fires_for_most_gestures_and_hardly_any_in_daily_life(
    trained: Any, shared_data: Path
) -> None:
    file, to_come, folder = trained

    with playing(file, "--recording", folder / "play", "--speed", SPEED) as play:
        assert play.finish(200) == 0, play.errors()
    firings = list(fired(play))
    made = [one for gesture in GESTURES for one in to_come[gesture]]
    right = sum(caught(one, firings) for one in made)
    assert right / len(made) >= 0.85, f"{right} of {len(made)}"

    everyday = shared_data / "everyday_watch"
    with playing(file, "--recording", everyday, "--speed", SPEED) as play:
        assert play.finish(200) == 0, play.errors()
    minutes = sum(read_recording(path).t[-1] for path in everyday.glob("*.csv")) / 60
    assert len(list(fired(play))) < minutes
