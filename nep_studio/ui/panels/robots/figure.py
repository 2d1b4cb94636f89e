"""Where the parts of a robot's body are in the picture, from the angles of its joints.

Places are mm in the torso's frame: x forward, y to the robot's left, z up. Lengths are NAO's, as
its makers publish them. Pictures are seen from in front, a little from the side and from above.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, radians, sin

Place = tuple[float, float, float]
Turn = tuple[Place, Place, Place]
"""A rotation, by its rows."""

NECK_MM, HEAD_MM = 126.5, 78.0
"""The head is drawn larger than it is: what happens in the face matters most."""
SHOULDER_MM, SHOULDER_UP_MM = 98.0, 100.0
UPPER_ARM_MM, FOREARM_MM = 105.0, 90.0
HIP_MM, HIP_DOWN_MM = 50.0, -85.0
THIGH_MM, SHANK_MM, SOLE_MM = 100.0, 103.0, 45.0
TOE_MM = 60.0

VIEW_YAW, VIEW_PITCH = radians(-22), radians(12)
LYING_YAW = radians(-60)
LYING = {"LyingBack": radians(-90), "LyingBelly": radians(90)}
"""How the torso is turned forward in these postures; it is upright in the others."""


@dataclass(frozen=True)
class Dot:
    """A place in the picture: mm to the right and down; ``near`` grows towards the eye."""

    x: float
    y: float
    near: float


def figure(joints: Mapping[str, float], posture: str = "") -> dict[str, Dot]:
    """The parts of the body by name; a joint that is not told is at 0 rad."""
    pitch = LYING.get(posture, 0.0)
    camera = _times(_about_y(VIEW_PITCH), _about_z(LYING_YAW if posture in LYING else VIEW_YAW))
    view = _times(camera, _about_y(pitch))
    places = {"torso": (0.0, 0.0, 30.0), "chest": (55.0, 0.0, 55.0), **_head(joints)}
    for side, sign in (("L", 1.0), ("R", -1.0)):
        places |= _arm(joints, side, sign) | _leg(joints, side, sign)
    return {name: _seen(view, place) for name, place in places.items()}


def _head(joints: Mapping[str, float]) -> dict[str, Place]:
    turn = _times(_about_z(joints.get("HeadYaw", 0.0)), _about_y(joints.get("HeadPitch", 0.0)))
    neck = (0.0, 0.0, NECK_MM)
    on_head = {
        "head": (0.0, 0.0, HEAD_MM),
        "L_eye": (70.0, 36.0, HEAD_MM + 4),
        "R_eye": (70.0, -36.0, HEAD_MM + 4),
        "L_ear": (0.0, 88.0, HEAD_MM),
        "R_ear": (0.0, -88.0, HEAD_MM),
        "mouth": (78.0, 0.0, HEAD_MM - 38),
        "head_front": (50.0, 0.0, HEAD_MM + 54),
        "head_middle": (4.0, 0.0, HEAD_MM + 78),
        "head_rear": (-46.0, 0.0, HEAD_MM + 66),
    }
    return {"neck": neck} | {name: _add(neck, _turned(turn, at)) for name, at in on_head.items()}


def _arm(joints: Mapping[str, float], side: str, sign: float) -> dict[str, Place]:
    def angle(name: str, usual: float = 0.0) -> float:
        return joints.get(f"{side}{name}", usual)

    shoulder = (0.0, sign * SHOULDER_MM, SHOULDER_UP_MM)
    upper = _times(_about_y(angle("ShoulderPitch", 1.5)), _about_z(angle("ShoulderRoll")))
    elbow = _add(shoulder, _turned(upper, (UPPER_ARM_MM, 0.0, 0.0)))
    lower = _times(_times(upper, _about_x(angle("ElbowYaw"))), _about_z(angle("ElbowRoll")))
    hand = _add(elbow, _turned(lower, (FOREARM_MM, 0.0, 0.0)))
    return {f"{side}_shoulder": shoulder, f"{side}_elbow": elbow, f"{side}_hand": hand}


def _leg(joints: Mapping[str, float], side: str, sign: float) -> dict[str, Place]:
    def angle(name: str) -> float:
        return joints.get(f"{side}{name}", 0.0)

    hip = (0.0, sign * HIP_MM, HIP_DOWN_MM)
    thigh = _times(_about_x(angle("HipRoll")), _about_y(angle("HipPitch")))
    knee = _add(hip, _turned(thigh, (0.0, 0.0, -THIGH_MM)))
    shank = _times(thigh, _about_y(angle("KneePitch")))
    ankle = _add(knee, _turned(shank, (0.0, 0.0, -SHANK_MM)))
    foot = _times(_times(shank, _about_y(angle("AnklePitch"))), _about_x(angle("AnkleRoll")))
    heel = _add(ankle, _turned(foot, (-25.0, 0.0, -SOLE_MM / 2)))
    toe = _add(ankle, _turned(foot, (TOE_MM, 0.0, -SOLE_MM / 2)))
    return {
        f"{side}_hip": hip,
        f"{side}_knee": knee,
        f"{side}_ankle": ankle,
        f"{side}_heel": heel,
        f"{side}_toe": toe,
    }


def _seen(view: Turn, place: Place) -> Dot:
    near, left, up = _turned(view, place)
    return Dot(left, -up, near)  # the robot looks at us: its left is to our right


def _about_x(angle: float) -> Turn:
    c, s = cos(angle), sin(angle)
    return ((1, 0, 0), (0, c, -s), (0, s, c))


def _about_y(angle: float) -> Turn:
    c, s = cos(angle), sin(angle)
    return ((c, 0, s), (0, 1, 0), (-s, 0, c))


def _about_z(angle: float) -> Turn:
    c, s = cos(angle), sin(angle)
    return ((c, -s, 0), (s, c, 0), (0, 0, 1))


def _times(first: Turn, second: Turn) -> Turn:
    columns = tuple(zip(*second, strict=True))
    rows = [tuple(_dot(row, column) for column in columns) for row in first]
    return (_place(rows[0]), _place(rows[1]), _place(rows[2]))


def _turned(turn: Turn, place: Place) -> Place:
    return (_dot(turn[0], place), _dot(turn[1], place), _dot(turn[2], place))


def _dot(first: tuple[float, ...], second: tuple[float, ...]) -> float:
    return sum(a * b for a, b in zip(first, second, strict=True))


def _add(first: Place, second: Place) -> Place:
    return (first[0] + second[0], first[1] + second[1], first[2] + second[2])


def _place(row: tuple[float, ...]) -> Place:
    x, y, z = row
    return (x, y, z)
