"""Keyframes as ALMotion.angleInterpolationBezier takes them, within limits and speeds."""

from __future__ import annotations

from dataclasses import dataclass

from nodes.action.naobody.body import Angles, Body
from nodes.action.naobody.curves import control_points
from nodes.action.naobody.keyframes import Keyframes, Track
from nodes.action.naobody.motion import playable

BEZIER = 3
"""NAOqi's number for a handle of a curve, as Choregraphe writes it."""

Handle = list[float | int]
Key = list[float | Handle]


@dataclass(frozen=True)
class BezierCall:
    """The arguments of the call, how long it takes, where joints are at its end."""

    names: list[str]
    times: list[list[float]]
    keys: list[list[Key]]
    duration_s: float
    end: dict[str, float]
    notes: tuple[str, ...] = ()


def bezier_call(body: Body, pose: Angles, keyframes: Keyframes) -> BezierCall:
    """Return keyframes as a call that begins at a pose (every joint).

    What is too fast is stretched, angles that joints cannot have are clamped; the notes say so.
    """
    fitted, notes = playable(body, pose, keyframes)
    names, clamped = list(fitted.tracks), []
    keys = []
    for name, track in fitted.tracks.items():
        allowed = _allowed(body, name, track)
        if allowed != track:
            clamped.append(name)
        keys.append(_keys(body, float(pose[body.index[name]]), name, allowed))
    if clamped:
        notes = [*notes, f"kept within the limits of {', '.join(clamped)}"]
    return BezierCall(
        names,
        [[float(time) for time in fitted.tracks[name].times] for name in names],
        keys,
        fitted.duration_s,
        {name: float(one[-1][0]) for name, one in zip(names, keys, strict=True)},  # type: ignore[arg-type]
        tuple(notes),
    )


def _allowed(body: Body, name: str, track: Track) -> Track:
    low, high = float(body.min[body.index[name]]), float(body.max[body.index[name]])
    keys = tuple(min(max(key, low), high) for key in track.keys)
    return track if keys == track.keys else Track(track.times, keys, track.handles)


def _keys(body: Body, start: float, name: str, track: Track) -> list[Key]:
    """Each key: its angle, the handle before it and the one after it, both relative to it."""
    x, y = control_points(track, start, float(body.max_speed[body.index[name]]))
    count = len(track.keys)
    keys: list[Key] = []
    for i in range(count):
        before: Handle = [BEZIER, float(x[2, i] - x[3, i]), float(y[2, i] - y[3, i])]
        after: Handle = [BEZIER, 0.0, 0.0]
        if i + 1 < count:
            after = [BEZIER, float(x[1, i + 1] - x[0, i + 1]), float(y[1, i + 1] - y[0, i + 1])]
        keys.append([float(track.keys[i]), before, after])
    return keys
