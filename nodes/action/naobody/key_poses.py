"""An animation written as poses, one after the other: what each part of the body does, and when.

Angles are in degrees (hands: 0 closed to 1 open). ``arms`` and ``legs`` are the angles of the left
side; the right side does the same as in a mirror. A joint that a pose does not name moves on to
the next pose that names it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import msgspec

from nodes.action.naobody.keyframes import SHORTEST_STEP_S, Track, mirror_angle

Degrees = dict[str, float]


class Pose(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One key pose: when it is reached (s), what the robot is doing, and the joints it names."""

    at: float
    doing: str
    head: Degrees = {}
    arms: Degrees = {}
    left_arm: Degrees = {}
    right_arm: Degrees = {}
    legs: Degrees = {}
    left_leg: Degrees = {}
    right_leg: Degrees = {}
    joints: Degrees = {}


def tracks_of(poses: tuple[Pose, ...]) -> dict[str, Track]:
    """Return the keys of every joint that the poses name. Raises ValueError: what is wrong."""
    times: dict[str, list[float]] = {}
    keys: dict[str, list[float]] = {}
    now_s = 0.0
    for pose in poses:
        if not pose.at >= now_s + SHORTEST_STEP_S - 1e-9:
            raise ValueError(f"poses: {pose.at} s, {pose.doing}: it must be later than {now_s} s")
        now_s = pose.at
        for name, angle in joints_of(pose).items():
            times.setdefault(name, []).append(now_s)
            keys.setdefault(name, []).append(_in_body_units(name, angle))
    return {name: Track(tuple(times[name]), tuple(keys[name])) for name in keys}


def joints_of(pose: Pose) -> Degrees:
    """Return the angle of each joint that a pose names, in degrees; the most special one counts."""
    return dict(_named(pose))


def _named(pose: Pose) -> Iterator[tuple[str, float]]:
    for pair in (pose.arms, pose.legs):
        for name, angle in pair.items():
            yield f"L{name}", angle
            yield f"R{name}", mirror_angle(name, angle)
    sides = ((pose.left_arm, "L"), (pose.left_leg, "L"), (pose.right_arm, "R"))
    for angles, before in (*sides, (pose.right_leg, "R"), (pose.head, "Head"), (pose.joints, "")):
        for name, angle in angles.items():
            yield before + name, angle


def _in_body_units(name: str, angle: float) -> float:
    """Rad to a thousandth of a degree, hands as they are."""
    return angle if name.endswith("Hand") else round(math.radians(angle), 5)
