"""Recordings that come from elsewhere, and how they become part of the project."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from msgspec.structs import replace

from nep_studio.blocks.edits import SetExtra
from nep_studio.blocks.own_gestures import (
    OwnGesture,
    OwnRecording,
    OwnTake,
    free_gesture_name,
    keep_gesture,
    keep_recording,
)
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.keeping import LONGEST_TAKE_S, SHORTEST_TAKE_S, new_id


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


def add_imported(desk: TrainerDesk, imported: Sequence[Imported]) -> bool:
    """Keep all of it as one step; a gesture that is known gets more takes."""
    gestures = dict(desk.gestures)
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
    return bool(edits) and desk.change("import takes", edits)


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
