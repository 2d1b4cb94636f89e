"""Writes resources/examples/own_gestures.nep: a project with gestures of its own, learned already.

.venv/bin/python tools/make_gesture_example.py

A simulated person makes a big wave, a circle and a knock, five times each, and moves as on any
other day for a minute: so that teaching gestures can be looked at, and tried, without a watch. The
program around them is in this file; what is learned is what a training in the studio gives.
"""

from __future__ import annotations

import sys
import tempfile
from array import array
from base64 import b64encode
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from nep_studio.blocks.files import (
    from_bytes,
    load,
    save,
)
from nep_studio.blocks.own_gestures import (
    OwnGesture,
    OwnRecogniser,
    OwnRecording,
    OwnTake,
    keep_gesture,
    keep_recogniser,
    keep_recording,
    packed_samples,
    training_digest,
)
from nep_studio.run.installation import studio_language
from nodes.perceptual.recognition.model import write_model
from nodes.perceptual.recognition.streams import takes_of
from nodes.perceptual.recognition.training import train
from nodes.recordings import Recording
from nodes.sensory.arm.everyday import rest
from nodes.sensory.arm.gestures import Gesture, KeyStroke, arm, trunk
from nodes.sensory.arm.people import (
    Performer,
    person_numbered,
    simulate_everyday,
)

FILE = ROOT / "resources" / "examples" / "own_gestures.nep"
PERSON, TAKES, RATE_HZ, EVERYDAY_S = 150, 5, 50.0, 60.0
NAME = "Mia"

_UP, _OUT = arm(95, 25, 60, 75, 40), arm(95, 25, 60, 25, 10)
GESTURES = (
    Gesture(  # the raised forearm swings out and in three times
        "big_wave",
        ready={**arm(20, 10, 10, 60, 20), **trunk(0)},
        strokes=(
            KeyStroke(0.1, 0.5, _UP),
            KeyStroke(0.6, 0.3, _OUT),
            KeyStroke(0.9, 0.3, _UP),
            KeyStroke(1.2, 0.3, _OUT),
            KeyStroke(1.5, 0.3, _UP),
        ),
        duration_s=1.9,
    ),
    Gesture(  # the hand draws a large circle in the air before the body
        "circle",
        ready={**arm(45, 5, 30, 50, 30), **trunk(0)},
        strokes=(
            KeyStroke(0.1, 0.45, arm(90, 45, 10, 15, 0)),
            KeyStroke(0.5, 0.45, arm(140, 10, 20, 20, 0)),
            KeyStroke(0.9, 0.45, arm(95, -30, 40, 35, 10)),
            KeyStroke(1.3, 0.45, arm(45, 5, 30, 50, 30)),
        ),
        duration_s=1.9,
    ),
    Gesture(  # the fist knocks twice at a door before the shoulder
        "knock",
        ready={**arm(50, 5, 20, 100, 60), **trunk(0)},
        strokes=(
            KeyStroke(0.15, 0.22, arm(62, 5, 20, 68, 60)),
            KeyStroke(0.38, 0.22, arm(50, 5, 20, 105, 60)),
            KeyStroke(0.62, 0.22, arm(62, 5, 20, 68, 60)),
            KeyStroke(0.85, 0.25, arm(50, 5, 20, 100, 60)),
        ),
        duration_s=1.2,
    ),
)
TITLES = {"big_wave": "big wave", "circle": "circle", "knock": "knock"}

RULES: dict[str, list[dict[str, Any]]] = {
    "big_wave": [
        {"type": "robot.play", "fields": {"animation": "wave"}},
        {"type": "robot.say", "fields": {"text": "Hello! I saw you from far away."}},
    ],
    "circle": [
        {"type": "robot.say", "fields": {"text": "Round and round we go."}},
        {"type": "robot.play", "fields": {"animation": "twist"}},
    ],
    "knock": [
        {"type": "robot.say", "fields": {"text": "Who is there? Come in.", "gesture": "welcome"}}
    ],
}
NOTE = (
    "Three gestures that were taught: a big wave, a circle and a knock. They are in the panel"
    " Gestures, with five takes each by a simulated person.\n\nChange first: what NAO does. Then"
    " record a gesture of your own, press Train, and give it a rule."
)


def main() -> None:
    """Write the example and say how well its gestures are recognised."""
    language = studio_language()
    project = from_bytes(_program(), FILE.name, language)
    sessions = [_session(gesture) for gesture in GESTURES]
    everyday = simulate_everyday(PERSON, EVERYDAY_S, RATE_HZ)
    for gesture, session in zip(GESTURES, sessions, strict=True):
        takes = tuple(
            OwnTake(f"{gesture.name}_{n}", gesture.name, take.start_s, take.end_s)
            for n, take in enumerate(takes_of(session), start=1)
        )
        number = GESTURES.index(gesture)
        keep_recording(gesture.name, _kept(session)).apply(project)
        keep_gesture(gesture.name, OwnGesture(TITLES[gesture.name], number, takes=takes)).apply(
            project
        )
    keep_recording("everyday", _kept(everyday, is_everyday=True)).apply(project)
    model = train(sessions, [everyday])
    names = tuple(gesture.name for gesture in GESTURES)
    report = {method: dict(found) for method, found in model.report.items()}
    keep_recogniser(OwnRecogniser(training_digest(project), names, _file(model), report)).apply(
        project
    )
    save(project, FILE)
    load(FILE, language)
    print(f"{FILE.name}: {FILE.stat().st_size / 1000:.0f} kB")


def _session(gesture: Gesture) -> Recording:
    performer = Performer(person_numbered(PERSON), RATE_HZ, seed=7)
    parts = []
    for _ in range(TAKES):
        performer.live(rest)
        performer.make(gesture)
        parts.append(performer.planned_samples())
    performer.live(rest)
    parts.append(performer.planned_samples())
    return Recording(
        source=gesture.name,
        t=np.concatenate([part.t for part in parts]),
        acc=np.concatenate([part.acc for part in parts]),
        gyr=np.concatenate([part.gyr for part in parts]),
        labels=[label for part in parts for label in part.labels],
        gravity_included=True,
        person=NAME,
        simulated=True,
    )


def _kept(recording: Recording, *, is_everyday: bool = False) -> OwnRecording:
    assert recording.gyr is not None
    rows = array("f")
    for t, acc, gyr in zip(recording.t, recording.acc, recording.gyr, strict=True):
        rows.extend([t, *acc, *gyr])
    return OwnRecording(
        seconds=round(float(recording.t[-1]), 3),
        rate_hz=RATE_HZ,
        samples=packed_samples(rows.tobytes()),
        person=NAME,
        source="virtual watch",
        has_rotation=True,
        simulated=True,
        everyday=is_everyday,
    )


def _file(model: Any) -> str:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "own.gestures"
        write_model(path, model)
        return b64encode(path.read_bytes()).decode("ascii")


def _program() -> bytes:
    blocks: list[dict[str, Any]] = []
    pages: dict[str, list[dict[str, Any]]] = {"behaviour": [], "robots": [], "nodes": []}

    def stack(page: str, x: float, y: float, chain: list[dict[str, Any]]) -> None:
        for block in chain:
            blocks.append({"id": f"b{len(blocks) + 1}", **block})
        ids = [block["id"] for block in blocks[-len(chain) :]]
        pages[page].append({"id": f"s{ids[0]}", "x": x, "y": y, "body": ids})

    for number, (gesture, answers) in enumerate(RULES.items()):
        hat = {"type": "event.gesture", "fields": {"gesture": gesture}}
        stack("behaviour", 40.0, 200.0 + 180.0 * number, [hat, *answers])
    stack("robots", 40.0, 40.0, [{"type": "robots.robot", "fields": {"name": "NAO"}}])
    made = {"gestures": "4 big_wave, 14 circle, 24 knock", "person": PERSON}
    watch = {"node": "sensory/virtual_watch", "name": "watch", "parameters": made}
    stack("nodes", 40.0, 40.0, [{"type": "nodes.launch", "fields": watch}])
    note = {"id": "note_1", "page": "behaviour", "text": NOTE}
    place = {"x": 40.0, "y": 40.0, "width": 460.0, "height": 130.0}
    return msgspec.json.encode(
        {
            "format": "nep-studio-project",
            "version": 2,
            "name": "Gestures of your own",
            "blocks": blocks,
            "pages": pages,
            "variables": [],
            "procedures": [],
            "notes": [note | place],
            "page_order": [{"id": page, "title": ""} for page in pages],
        }
    )


if __name__ == "__main__":
    main()
