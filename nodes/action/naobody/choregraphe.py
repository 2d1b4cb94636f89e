"""Movements out of Choregraphe: the text that it exports, read without being executed.

Choregraphe writes a timeline as Python or C++: lists of joint names, of key times and of angles,
with or without Bezier handles ("simplified export", "bezier export").
"""

from __future__ import annotations

import math
from itertools import pairwise

from nep_core.errors import NepError
from nodes.action.naobody.keyframes import SHORTEST_STEP_S, Handle, Keyframes, Track
from nodes.action.naobody.listed_values import Value, movement_lists

LONGEST_TEXT = 2_000_000
EXPORTING = (
    "In Choregraphe, right-click in the timeline and export the motion to Python or C++.",
    "Copy the whole text, from the first joint to the last, and nothing else.",
)
NO_HANDLE: Handle = (0.0, 0.0, 0.0, 0.0)


class KeyframesUnreadable(NepError):
    """A text that holds no movement, or one that cannot be used."""

    title = "This text holds no movement that can be read"


def read_choregraphe(text: str) -> Keyframes:
    """Return the movement in a text that Choregraphe exported. Raises KeyframesUnreadable."""
    if len(text) > LONGEST_TEXT:
        raise KeyframesUnreadable(
            "The text is too long for a movement: it has more than 2 million letters.",
            checklist=EXPORTING,
        )
    found = movement_lists(text)
    if not found:
        raise KeyframesUnreadable(
            "The text has no joint names, times and keys in it.", checklist=EXPORTING
        )
    if len(found) > 1:
        raise KeyframesUnreadable(
            f"The text has {len(found)} movements in it; one at a time can be read.",
            checklist=EXPORTING,
        )
    names, times, keys = found[0]
    return _keyframes(_rows(names), _rows(times), _rows(keys))


def _keyframes(names: list[Value], times: list[Value], keys: list[Value]) -> Keyframes:
    if not len(names) == len(times) == len(keys) or not names:
        raise KeyframesUnreadable(
            f"The text has {len(names)} joint names, but {len(times)} lists of times "
            f"and {len(keys)} lists of keys.",
            checklist=EXPORTING,
        )
    tracks: dict[str, Track] = {}
    for name, joint_times, joint_keys in zip(names, times, keys, strict=True):
        if not isinstance(name, str) or not name:
            raise KeyframesUnreadable(
                "A joint's name is not a text in quotes.", checklist=EXPORTING
            )
        if name in tracks:
            raise KeyframesUnreadable(f"{name} is there twice.", checklist=EXPORTING)
        tracks[name] = _track(name, _rows(joint_times), _rows(joint_keys))
    return Keyframes(tracks)


def _track(name: str, times: list[Value], keys: list[Value]) -> Track:
    if len(times) != len(keys) or not keys:
        raise KeyframesUnreadable(
            f"{name} has {len(times)} times for {len(keys)} keys.", checklist=EXPORTING
        )
    seconds = tuple(_number(name, time) for time in times)
    if seconds[0] < 0.0 or any(b - a < SHORTEST_STEP_S - 1e-9 for a, b in pairwise(seconds)):
        raise KeyframesUnreadable(
            f"The times of {name} do not rise by {SHORTEST_STEP_S} s or more.", checklist=EXPORTING
        )
    read = [_key(name, key) for key in keys]
    handles = tuple(handle or NO_HANDLE for _, handle in read)
    has_handles = any(handle for _, handle in read)
    return Track(
        _later(seconds), tuple(angle for angle, _ in read), handles if has_handles else None
    )


def _later(seconds: tuple[float, ...]) -> tuple[float, ...]:
    """A movement begins where the robot is: a key at 0 s is reached a moment later."""
    late = max(0.0, SHORTEST_STEP_S - seconds[0])
    return tuple(time + late for time in seconds)


def _key(name: str, key: Value) -> tuple[float, Handle | None]:
    """A key's angle and its handles: 0.3, [0.3], or [0.3, [3, -0.2, 0.0], [3, 0.2, 0.0]]."""
    if not isinstance(key, list):
        return _number(name, key), None
    match key:
        case [angle]:
            return _number(name, angle), None
        case [angle, [_, before_s, before], [_, after_s, after]]:
            offsets = (before_s, before, after_s, after)
            numbers = [_number(name, offset) for offset in offsets]
            return _number(name, angle), (numbers[0], numbers[1], numbers[2], numbers[3])
    raise KeyframesUnreadable(
        f"A key of {name} is neither an angle nor an angle with two handles.", checklist=EXPORTING
    )


def _number(name: str, value: Value) -> float:
    if isinstance(value, float) and math.isfinite(value):
        return value
    raise KeyframesUnreadable(f"One of the numbers of {name} cannot be read.", checklist=EXPORTING)


def _rows(value: Value) -> list[Value]:
    return value if isinstance(value, list) else [value]
