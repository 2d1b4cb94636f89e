"""A robot's body as it was built: joints with their limits and speeds, head shell, postures."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Mapping
from functools import cached_property
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from faults.files import content, read_toml
from robots.errors import ActionFailed, FilesUnusable, nearest

from .limbs import Limb

Angles = NDArray[np.float64]
"""Rad in the body's joint order (hands 0 to 1), or rows of them, one every tick."""
Vector = tuple[float, float, float]

LARGEST_BODY = 4_000_000
CLAMP_TOLERANCE_RAD = 1e-6


class Joint(msgspec.Struct, frozen=True):
    """One joint: what it may do. Hands count 0 (closed) to 1 (open) instead of rad.

    It turns its link ``child`` about an ``axis`` at ``origin_m`` of its link ``parent``, where
    ``turn_rad`` (roll, pitch, yaw) is how the link is turned at rest; a hand has no links.
    """

    name: str
    limb: Limb
    min_rad: float
    max_rad: float
    max_speed_rad_s: float
    parent: str = ""
    child: str = ""
    origin_m: Vector = (0.0, 0.0, 0.0)
    turn_rad: Vector = (0.0, 0.0, 0.0)
    axis: Vector = (0.0, 0.0, 1.0)


class Link(msgspec.Struct, frozen=True):
    """One stiff part of the body: its mass, and how far out it reaches, in its joint's frame.

    ``hull_m`` are round shapes: x, y, z and radius. ``sole_m`` is the outline of a foot's sole.
    ``inertia_kg_m2`` is about the centre of mass: xx, yy, zz, xy, xz, yz.
    """

    mass_kg: float = 0.0
    centre_m: Vector = (0.0, 0.0, 0.0)
    inertia_kg_m2: tuple[float, float, float, float, float, float] = (0.0,) * 6
    hull_m: tuple[tuple[float, float, float, float], ...] = ()
    sole_m: tuple[Vector, ...] = ()


class ShellLimit(msgspec.Struct, frozen=True):
    """How far the head can nod (degrees) when it is turned by ``yaw`` degrees to either side."""

    yaw: float
    min_pitch: float
    max_pitch: float


class Posture(msgspec.Struct, frozen=True):
    """A named pose; ``next`` are the postures that can be reached from it in one move.

    ``down``: about which way is down, in the torso's frame.
    """

    family: str
    next: tuple[str, ...]
    angles: tuple[float, ...]
    down: Vector = (0.0, 0.0, -1.0)


class KeyPose(msgspec.Struct, frozen=True):
    """A pose on the way between two postures; ``down`` is which way is down there."""

    down: Vector
    angles: tuple[float, ...]


class PostureTransition(msgspec.Struct, frozen=True):
    """The key poses through which a robot gets from one posture to another, and back."""

    between: tuple[str, str]
    through: tuple[str, ...]


class Camera(msgspec.Struct, frozen=True):
    """A camera in the head: where it is in the head's frame (m), how far down it looks (rad)."""

    at_m: Vector
    down_rad: float = 0.0


class Sonar(msgspec.Struct, frozen=True):
    """A sonar: where it is in the frame of a link (m), and how far to the left it points (rad)."""

    link: str
    at_m: Vector
    yaw_rad: float = 0.0


class _BodyFile(msgspec.Struct, frozen=True):
    joints: tuple[Joint, ...]
    same_motor: dict[str, str]
    head_shell_deg: tuple[ShellLimit, ...]
    postures: dict[str, Posture]
    links: dict[str, Link] = {}
    key_poses: dict[str, KeyPose] = {}
    ways: tuple[PostureTransition, ...] = ()
    cameras: tuple[Camera, ...] = ()
    sonars: dict[str, Sonar] = {}


class _Profile(msgspec.Struct, frozen=True):
    title: str


class Body:
    """The joint table and postures of one kind of robot, and what people call that kind: NAO.

    ``names``, ``min``, ``max`` and ``max_speed`` are in the same order: the body's joint order.
    """

    def __init__(self, file: _BodyFile, title: str) -> None:
        self.title = title
        self.joints = file.joints
        self.names = tuple(joint.name for joint in file.joints)
        self.index = {name: i for i, name in enumerate(self.names)}
        self.min = np.array([joint.min_rad for joint in file.joints])
        self.max = np.array([joint.max_rad for joint in file.joints])
        self.max_speed = np.array([joint.max_speed_rad_s for joint in file.joints])
        self.same_motor = file.same_motor
        self.postures = file.postures
        self.links = file.links
        self.cameras, self.sonars = file.cameras, file.sonars
        self._key_poses = file.key_poses
        self._ways = {way.between: way.through for way in file.ways}
        self._shell = np.radians([(s.yaw, s.min_pitch, s.max_pitch) for s in file.head_shell_deg]).T

    @cached_property
    def head(self) -> tuple[int, int]:
        """Where the head's yaw and pitch are in the joint order."""
        return self.index["HeadYaw"], self.index["HeadPitch"]

    def posture_angles(self, name: str) -> Angles:
        """Return the angles of a posture, in joint order."""
        return np.array(self.postures[name].angles)

    def key_poses(self, start: str, goal: str) -> list[KeyPose]:
        """Return the poses between two postures that are next to each other."""
        names = self._ways.get((start, goal)) or self._ways.get((goal, start), ())[::-1]
        return [self._key_poses[name] for name in names]

    def origin_m(self, joint: str) -> Vector:
        """Return where a joint is in the frame of the link before it (m)."""
        return self.joints[self.index[joint]].origin_m

    def columns(self, limbs: Iterable[Limb]) -> list[int]:
        """Return where the joints of some limbs are in the joint order."""
        wanted = frozenset(limbs)
        return [i for i, joint in enumerate(self.joints) if joint.limb in wanted]

    def limbs_of(self, joint_names: Iterable[str]) -> frozenset[Limb]:
        """Return the limbs that some joints belong to."""
        return frozenset(self.joints[self.index[name]].limb for name in joint_names)

    def clamped(self, angles: Angles) -> tuple[Angles, list[str]]:
        """Return angles that the joints can have, and the names of the joints that were clamped.

        Angles: (joints,) or (ticks, joints). Coupled joints get the angle of their motor.
        """
        allowed = np.clip(angles, self.min, self.max)
        for follower, leader in self.same_motor.items():
            allowed[..., self.index[follower]] = allowed[..., self.index[leader]]
        yaw, pitch = self.head
        low, high = self.pitch_limits(allowed[..., yaw])
        allowed[..., pitch] = np.clip(allowed[..., pitch], low, high)
        wrong = np.atleast_2d(np.abs(allowed - angles) > CLAMP_TOLERANCE_RAD).any(axis=0)
        return allowed, [self.names[i] for i in np.flatnonzero(wrong)]

    def pitch_limits(self, yaw: Angles) -> tuple[Angles, Angles]:
        """Return the lowest and highest head pitch that the shell allows at each yaw (rad)."""
        turn = np.abs(yaw)
        yaws, lows, highs = self._shell
        return np.interp(turn, yaws, lows), np.interp(turn, yaws, highs)


def load_body(folder: Path) -> Body:
    """Read ``body.json`` of a robot's folder. Raises FilesUnusable when it cannot be used.

    ``robot.toml`` beside it says what such a robot is called; without one it is as the folder.
    """
    path, profile = folder / "body.json", folder / "robot.toml"
    try:
        file = msgspec.json.decode(content(path, LARGEST_BODY), type=_BodyFile)
        if not profile.exists():
            return Body(file, folder.name)
        path = profile
        return Body(file, msgspec.convert(read_toml(path), _Profile).title)
    except (OSError, ValueError, RecursionError) as error:
        raise FilesUnusable(
            "The description of the robot's body, {path}, cannot be read.",
            checklist=("Install NEP Studio again: this file comes with it.",),
            details=str(error),
            path=path,
        ) from error


# A robot's lights: which groups there are, and what a colour's text means.

OFF = 0x000000
WHITE = 0xFFFFFF
GROUPS: dict[str, tuple[str, ...]] = {
    "LeftFaceLeds": ("LeftFaceLeds",),
    "RightFaceLeds": ("RightFaceLeds",),
    "FaceLeds": ("LeftFaceLeds", "RightFaceLeds"),
    "LeftEarLeds": ("LeftEarLeds",),
    "RightEarLeds": ("RightEarLeds",),
    "EarLeds": ("LeftEarLeds", "RightEarLeds"),
    "BrainLeds": ("BrainLeds",),
    "ChestLeds": ("ChestLeds",),
    "LeftFootLeds": ("LeftFootLeds",),
    "RightFootLeds": ("RightFootLeds",),
    "FeetLeds": ("LeftFootLeds", "RightFootLeds"),
}
GROUPS["AllLeds"] = tuple(name for name, parts in GROUPS.items() if parts == (name,))
"""NAOqi's names of groups, each with the lights that it is made of."""

LAMPS: dict[str, tuple[str, ...]] = {
    "LeftFaceLeds": tuple(f"FaceLedLeft{number}" for number in range(8)),
    "RightFaceLeds": tuple(f"FaceLedRight{number}" for number in range(8)),
    "LeftEarLeds": tuple(f"LeftEarLed{number}" for number in range(1, 11)),
    "RightEarLeds": tuple(f"RightEarLed{number}" for number in range(1, 11)),
    "BrainLeds": tuple(f"Brain{number}" for number in range(12)),
}
"""The single lamps of the lights that have several; those round an eye begin at its top."""
LIGHT_OF_LAMP = {lamp: light for light, lamps in LAMPS.items() for lamp in lamps}

AT_START: dict[str, int] = {light: OFF for light in GROUPS["AllLeds"]} | {
    "LeftFaceLeds": 0xFFFFFF,
    "RightFaceLeds": 0xFFFFFF,
    "LeftEarLeds": 0x0000FF,
    "RightEarLeds": 0x0000FF,
}


def lights(group: str) -> tuple[str, ...]:
    """Return the lights of a group, or the one lamp that is called so. Raises ActionFailed."""
    if group in LIGHT_OF_LAMP:
        return (group,)
    if group not in GROUPS:
        known = ", ".join(sorted(GROUPS))
        raise ActionFailed(
            'There are no lights called "{group}". Possible: {known}.',
            group=group,
            known=known,
            checklist=nearest(group, GROUPS),
        )
    return GROUPS[group]


def shining(leds: Mapping[str, int], light: str) -> int:
    """Return the colour of a light; a lamp shines as its light does unless it was lit by itself."""
    return leds[light] if light in leds else leds[LIGHT_OF_LAMP[light]]


def shine(leds: dict[str, int], light: str, colour: int) -> None:
    """Let a light shine in a colour, with all of its lamps; or one lamp."""
    for lamp in LAMPS.get(light, ()):
        leds.pop(lamp, None)
    leds[light] = colour


def at_start(light: str) -> int:
    """Return the colour of a light or lamp when the robot starts."""
    return AT_START[LIGHT_OF_LAMP.get(light, light)]


def colour_number(colour: str) -> int:
    """Return 0xRRGGBB for text such as ``#ff8000``. Raises ActionFailed for other text."""
    if not re.fullmatch(r"#[0-9a-fA-F]{6}", colour):
        raise ActionFailed(
            '"{colour}" is not a colour. Write one like #ff8000: red, green, blue.', colour=colour
        )
    return int(colour[1:], 16)


def mixed(start: int, end: int, part: float) -> int:
    """Return the colour that is ``part`` (0 to 1) of the way from one colour to another."""
    pairs = zip(start.to_bytes(3), end.to_bytes(3), strict=True)
    return int.from_bytes(round(first + (last - first) * part) for first, last in pairs)


def brightest(colour: int) -> int:
    """Return a colour with the same hue, as bright as it can be."""
    parts = colour.to_bytes(3)
    most = max(parts) or 255
    return int.from_bytes(round(part * 255 / most) for part in parts)


# Which posture a word means, and by which postures a robot gets from one to another.


def posture_name(body: Body, word: str) -> str:
    """Return the posture that a word such as ``posture_stand`` or ``StandInit`` means.

    Raises ActionFailed with the words that are possible.
    """
    plain = _plain(word)
    for name in body.postures:
        if _plain(name) == plain:
            return name
    known = ", ".join(_word(name) for name in body.postures)
    raise ActionFailed(
        'There is no posture "{word}". Possible postures: {known}.',
        word=word,
        known=known,
        checklist=nearest(word, map(_word, body.postures)),
    )


def posture_path(body: Body, start: str, goal: str) -> list[str]:
    """Return the postures to pass after ``start``, the goal last: the way with the fewest moves."""
    known, paths = {start}, deque([[start]])
    while paths:
        path = paths.popleft()
        if path[-1] == goal:
            return path[1:] or [goal]
        for neighbour in body.postures[path[-1]].next:
            if neighbour not in known:
                known.add(neighbour)
                paths.append([*path, neighbour])
    raise ActionFailed("There is no way from {start} to {goal}.", start=start, goal=goal)


def _word(name: str) -> str:
    return "posture" + "".join(f"_{c.lower()}" if c.isupper() else c for c in name)


def _plain(word: str) -> str:
    letters = "".join(letter for letter in word if letter.isalnum()).casefold()
    return letters.removeprefix("posture")


# The parts of NAO's body that can be locked and released, with the joints of each.

PART_OF_LIMB = {Limb.HEAD: "head", Limb.LEFT_ARM: "left_arm", Limb.RIGHT_ARM: "right_arm"}
PLAIN_NAMES = {
    "head": "head",
    "left_arm": "left arm",
    "right_arm": "right arm",
    "left_leg": "left leg",
    "right_leg": "right leg",
}
SINGLE_PARTS = tuple(PLAIN_NAMES)
PARTS: dict[str, tuple[str, ...]] = {part: (part,) for part in SINGLE_PARTS} | {
    "arms": ("left_arm", "right_arm"),
    "legs": ("left_leg", "right_leg"),
    "body": SINGLE_PARTS,
}


def part_of(body: Body, joint: str) -> str:
    """Return the single part that a joint is in."""
    limb = body.joints[body.index[joint]].limb
    if limb is Limb.LEGS:
        return "left_leg" if joint.startswith("L") else "right_leg"
    return PART_OF_LIMB[limb]


def single_parts(part: str) -> tuple[str, ...]:
    """Return the single parts of a part. Raises ActionFailed with the parts that there are."""
    if part not in PARTS:
        raise ActionFailed(
            'There is no part "{part}" of the body. Possible: {parts}.',
            part=part,
            parts=", ".join(PARTS),
            checklist=nearest(part, PARTS),
        )
    return PARTS[part]


def parts_of_limbs(limbs: frozenset[Limb]) -> frozenset[str]:
    """Return the single parts that some limbs move."""
    parts = {PART_OF_LIMB[limb] for limb in limbs if limb in PART_OF_LIMB}
    return frozenset(parts | ({"left_leg", "right_leg"} if Limb.LEGS in limbs else set()))
