"""Every change that the trainer makes to the project, each one step of undo."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Sequence
from datetime import datetime

from msgspec.structs import replace

from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.own_gestures import (
    OwnGesture,
    OwnRecording,
    OwnTake,
    free_gesture_name,
    keep_gesture,
    keep_recording,
)

from .gesture_controller import GestureController
from .live import Samples, as_recording, thinned

Span = tuple[float, float]
SHORTEST_TAKE_S, LONGEST_TAKE_S = 0.3, 7.9
"""Shorter and longer ones cannot be learned, whatever the rate of the sensor."""
_BETWEEN_S = 0.04
"""Two takes never touch: they would be one."""
_DIGITS = 4

LABELS = {
    "record": "record takes",
    "delete one": "delete a take",
    "delete": "delete takes",
    "leave out": "leave out a take",
    "use again": "use a take again",
}
"""Steps whose names depend on what is done; the window translates them."""


class Keeping:
    """Asks the controller for changes; each is named in English, as all steps are."""

    def __init__(self, controller: GestureController) -> None:
        self._controller = controller

    # Gestures

    def new_gesture(self, title: str) -> str:
        """Make a gesture without takes; gives its name, "" when it cannot be."""
        controller = self._controller
        name = free_gesture_name(title, controller.gestures)
        number = max((one.number for one in controller.gestures.values()), default=-1) + 1
        edit = keep_gesture(name, OwnGesture(title.strip(), number))
        return name if controller.change("make a gesture", [edit]) else ""

    def rename_gesture(self, name: str, title: str) -> None:
        """Give a gesture another title; blocks that use it go on with it."""
        gesture = self._controller.gestures.get(name)
        if gesture is not None and title.strip() and title.strip() != gesture.title:
            edit = keep_gesture(name, replace(gesture, title=title.strip()))
            self._controller.change("rename a gesture", [edit])

    def delete_gesture(self, name: str) -> None:
        """Delete a gesture with its takes; the recordings without any other take go too."""
        gesture = self._controller.gestures.get(name)
        if gesture is not None:
            edits = [keep_gesture(name, None), *self._forget(gesture.takes)]
            self._controller.change("delete a gesture", edits)

    # Takes

    def keep_session(
        self,
        gesture: str,
        samples: Samples,
        takes: Sequence[Span],
        forgotten: Sequence[Span] = (),
        label: str = LABELS["record"],
    ) -> list[str]:
        """Keep a recording with the takes in it (spans on its clock); gives the takes' ids."""
        kept = self._controller.gestures.get(gesture)
        if kept is None or not len(samples):
            return []
        recording = self._recording(samples, forgotten=forgotten)
        recording_id = new_id("r")
        begin = float(samples.t[0])
        made = tuple(_take(recording_id, span, begin, recording.seconds) for span in takes)
        edits = [
            keep_recording(recording_id, recording),
            keep_gesture(gesture, replace(kept, takes=(*kept.takes, *made))),
        ]
        return [take.id for take in made] if self._controller.change(label, edits) else []

    def keep_everyday(self, samples: Samples) -> bool:
        """Keep everyday movement, in which there is no gesture."""
        if len(samples) < 2:
            return False
        recording = self._recording(samples, everyday=True)
        edit = keep_recording(new_id("r"), recording)
        return self._controller.change("record everyday movement", [edit])

    def delete_recording(self, recording_id: str) -> None:
        """Delete a recording of everyday movement."""
        if recording_id in self._controller.recordings:
            edit = keep_recording(recording_id, None)
            self._controller.change("delete a recording", [edit])

    def delete_takes(self, take_ids: Collection[str]) -> None:
        """Delete takes; where they were, the recording is neither a gesture nor nothing."""
        edits: list[SetExtra] = []
        gone: list[OwnTake] = []
        for name, gesture in self._controller.gestures.items():
            here = [take for take in gesture.takes if take.id in take_ids]
            if here:
                gone += here
                edits.append(keep_gesture(name, _without(gesture, take_ids)))
        if gone:
            label = LABELS["delete one" if len(gone) == 1 else "delete"]
            self._controller.change(label, [*edits, *self._forget(gone)])

    def relabel_takes(self, take_ids: Collection[str], to: str) -> None:
        """Say that takes are of another gesture."""
        target, moved, edits = self._controller.gestures.get(to), [], []
        for name, gesture in self._controller.gestures.items():
            here = [take for take in gesture.takes if take.id in take_ids]
            if here and name != to:
                moved += here
                edits.append(keep_gesture(name, _without(gesture, take_ids)))
        if target is None or not moved:
            return
        edits.append(keep_gesture(to, replace(target, takes=(*target.takes, *moved))))
        self._controller.change("give a take to another gesture", edits)

    def leave_out(self, take_ids: Collection[str], is_out: bool) -> None:
        """Learn no more from takes, or learn from them again."""
        label = LABELS["leave out" if is_out else "use again"]
        edits = []
        for name, gesture in self._controller.gestures.items():
            takes = tuple(
                replace(take, left_out=is_out) if take.id in take_ids else take
                for take in gesture.takes
            )
            if takes != gesture.takes:
                edits.append(keep_gesture(name, replace(gesture, takes=takes)))
        if edits:
            self._controller.change(label, edits)

    def trim_take(self, take_id: str, start_s: float, end_s: float) -> None:
        """Let a take begin and end elsewhere in its recording, as far as there is room."""
        found = self._controller.find_take(take_id)
        if found is None:
            return
        name, old = found
        first_s, last_s = self.room_of(old)
        start_s, end_s = max(first_s, start_s), min(last_s, end_s)
        if not SHORTEST_TAKE_S <= end_s - start_s <= LONGEST_TAKE_S:
            return
        new = replace(old, start_s=round(start_s, _DIGITS), end_s=round(end_s, _DIGITS))
        gesture = self._controller.gestures[name]
        takes = tuple(new if take.id == take_id else take for take in gesture.takes)
        if new != old:
            edit = keep_gesture(name, replace(gesture, takes=takes))
            self._controller.change("change where a take begins and ends", [edit])

    def room_of(self, take: OwnTake) -> Span:
        """From where to where a take may go: its recording, up to the takes beside it."""
        recording = self._controller.recordings.get(take.recording)
        first_s, last_s = 0.0, recording.seconds if recording is not None else take.end_s
        for gesture in self._controller.gestures.values():
            for other in gesture.takes:
                if other.recording != take.recording or other.id == take.id:
                    continue
                if other.end_s <= take.start_s:
                    first_s = max(first_s, other.end_s + _BETWEEN_S)
                elif other.start_s >= take.end_s:
                    last_s = min(last_s, other.start_s - _BETWEEN_S)
        return min(first_s, take.start_s), max(last_s, take.end_s)

    # People

    def rename_person(self, name: str, new_name: str) -> None:
        """Give a person another name, in all recordings."""
        new_name = new_name.strip()
        edits = [
            keep_recording(key, replace(one, person=new_name))
            for key, one in self._controller.recordings.items()
            if one.person == name
        ]
        if (
            new_name
            and new_name != name
            and (not edits or self._controller.change("rename a person", edits))
        ):
            self._controller.set_wearer(new_name)

    def delete_person(self, name: str) -> None:
        """Delete all recordings of a person, and the takes in them."""
        gone = {key for key, one in self._controller.recordings.items() if one.person == name}
        edits = [keep_recording(key, None) for key in sorted(gone)]
        for key, gesture in self._controller.gestures.items():
            takes = tuple(take for take in gesture.takes if take.recording not in gone)
            if takes != gesture.takes:
                edits.append(keep_gesture(key, replace(gesture, takes=takes)))
        if not edits or self._controller.change("delete a person", edits):
            others = [person for person in self._controller.people if person != name]
            self._controller.set_wearer(others[0] if others else "")

    # Within

    def _recording(
        self, samples: Samples, *, everyday: bool = False, forgotten: Sequence[Span] = ()
    ) -> OwnRecording:
        """Samples as the project keeps them, with who wore the sensor and where."""
        controller, live = self._controller, self._controller.live
        samples, begin = thinned(samples), float(samples.t[0])
        spans = [(max(0.0, a - begin), min(samples.seconds, b - begin)) for a, b in forgotten]
        return as_recording(
            samples,
            person=controller.person,
            wrist=controller.wrist,
            source=live.source if live is not None else "",
            gravity_included=live.gravity_included if live is not None else True,
            simulated=live.simulated if live is not None else False,
            everyday=everyday,
            recorded=datetime.now().astimezone().isoformat(timespec="seconds"),
            forgotten=_rounded(spans),
        )

    def _forget(self, takes: Iterable[OwnTake]) -> list[SetExtra]:
        """The edits of recordings after these takes are gone; one without takes goes itself."""
        gone = {take.id: take for take in takes}
        left = {
            take.recording
            for gesture in self._controller.gestures.values()
            for take in gesture.takes
            if take.id not in gone
        }
        edits = []
        for key in dict.fromkeys(take.recording for take in gone.values()):
            recording = self._controller.recordings.get(key)
            if recording is None:
                continue
            spans = [(one.start_s, one.end_s) for one in gone.values() if one.recording == key]
            forgotten = _rounded([*recording.forgotten, *spans])
            now = replace(recording, forgotten=forgotten) if key in left else None
            edits.append(keep_recording(key, now))
        return edits


def new_id(letter: str) -> str:
    """An id that no take and no recording has."""
    return f"{letter}{os.urandom(5).hex()}"


def _take(recording: str, span: Span, begin: float, last_s: float) -> OwnTake:
    start_s, end_s = max(0.0, span[0] - begin), min(last_s, span[1] - begin)
    return OwnTake(new_id("t"), recording, round(start_s, _DIGITS), round(end_s, _DIGITS))


def _without(gesture: OwnGesture, ids: Collection[str]) -> OwnGesture:
    return replace(gesture, takes=tuple(take for take in gesture.takes if take.id not in ids))


def _rounded(spans: Sequence[Span]) -> tuple[Span, ...]:
    return tuple((round(a, _DIGITS), round(b, _DIGITS)) for a, b in spans if b > a)
