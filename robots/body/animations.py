"""The animations that a robot knows, read from its folder of TOML files.

A file has a title, a description, what kind it is, the posture it starts from (files that move
the legs must have one), a sound that the robot makes meanwhile (``says``), and its movement: either
``poses``, which people write (key_poses.py), or for every joint its key times (s), its keys (rad)
and, if wanted, Bezier handles (s, rad before; s, rad after), which programs write.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Literal

import msgspec

from faults import Text
from faults.files import read_toml
from robots.errors import ActionFailed, FilesUnusable, nearest

from .body import Body
from .keyframes import SHORTEST_STEP_S, Handle, Keyframes, Track, mirror_angle, problem_of
from .limbs import MOVING, Limb

# An animation written as poses, one after the other: what each part of the body does, and when.
#
# Angles are in degrees (hands: 0 closed to 1 open). ``arms`` and ``legs`` are the angles of the
# left side; the right side does the same as in a mirror. A joint that a pose does not name moves
# on to the next pose that names it.

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
            # Rad to a thousandth of a degree, hands as they are
            in_rad = angle if name.endswith("Hand") else round(math.radians(angle), 5)
            keys.setdefault(name, []).append(in_rad)
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


Kind = Literal["animation", "animal", "gesture"]
NO_GESTURE = "no_gesture"


class _JointKeys(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    times: tuple[float, ...]
    keys: tuple[float, ...]
    handles: tuple[Handle, ...] | None = None


class _AnimationFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    title: str
    description: str
    kind: Kind
    joints: dict[str, _JointKeys] = {}
    poses: tuple[Pose, ...] = ()
    starts_from: str = ""
    says: str = ""


class Animation(msgspec.Struct, frozen=True):
    """A movement with a name; ``starts_from`` is empty when it goes with any posture."""

    name: str
    title: str
    description: str
    kind: Kind
    starts_from: str
    says: str
    keyframes: Keyframes
    joint_limbs: frozenset[Limb]

    @property
    def limbs(self) -> frozenset[Limb]:
        """The limbs that nothing else may use meanwhile."""
        joints = MOVING if self.starts_from else self.joint_limbs
        return joints | {Limb.VOICE} if self.says else joints


class Animations:
    """The animations of one robot, by name."""

    def __init__(self, animations: dict[str, Animation]) -> None:
        self._animations = animations

    def names(self, *kinds: Kind) -> list[str]:
        """Return the names of some kinds of animations, in alphabetical order; without: of all."""
        return sorted(
            name for name, one in self._animations.items() if not kinds or one.kind in kinds
        )

    def get(self, name: str, *kinds: Kind) -> Animation:
        """Return an animation of one of these kinds. Raises ActionFailed with those there are."""
        if name not in self.names(*kinds):
            known = ", ".join(self.names(*kinds))
            word = Text(kinds[0] if kinds else "animation")
            raise ActionFailed(
                'There is no {word} "{name}". Possible: {known}.',
                word=word,
                name=name,
                known=known,
                checklist=nearest(name, self.names(*kinds)),
            )
        return self._animations[name]


def load_animations(folder: Path, body: Body) -> Animations:
    """Read every ``*.toml`` of a folder. Raises FilesUnusable, which names file and place."""
    files = sorted(folder.glob("*.toml"))
    return Animations({path.stem: load_animation(path, body) for path in files})


def load_animation(path: Path, body: Body) -> Animation:
    """Read one animation. Raises FilesUnusable, which names file and place."""
    try:
        file = msgspec.convert(read_toml(path), _AnimationFile)
        if file.joints and file.poses:
            raise ValueError("poses: there are joints too; a file has either of them")
        keys = {name: Track(j.times, j.keys, j.handles) for name, j in file.joints.items()}
        tracks = keys or tracks_of(file.poses)
    except (OSError, ValueError, RecursionError) as error:
        raise _unusable(path, str(error)) from error
    if problem := _problem(file, tracks, body):
        raise _unusable(path, problem)
    return Animation(
        name=path.stem,
        title=file.title,
        description=file.description,
        kind=file.kind,
        starts_from=file.starts_from,
        says=file.says,
        keyframes=Keyframes(tracks),
        joint_limbs=body.limbs_of(tracks),
    )


def _problem(file: _AnimationFile, tracks: dict[str, Track], body: Body) -> str:
    """Return what is wrong with a file that could be read, or nothing."""
    for name, track in tracks.items():
        if name not in body.index:
            return f"joints.{name}: the robot has no such joint"
        if wrong := problem_of(track):
            return f"joints.{name}: {wrong}"
    if not tracks:
        return "joints: there are none"
    if file.starts_from and file.starts_from not in body.postures:
        return f"starts_from: there is no posture {file.starts_from}"
    if Limb.LEGS in body.limbs_of(tracks) and not file.starts_from:
        return "starts_from: an animation that moves the legs needs a posture to start from"
    return ""


def _unusable(path: Path, problem: str) -> FilesUnusable:
    return FilesUnusable(
        "The animation {path} cannot be used: {problem}.",
        checklist=(
            "Open {name} in a text editor and look at that place.",
            "Or take the file out of its folder.",
        ),
        path=path,
        problem=problem,
        name=path.name,
    )


# The animations that a project brings, beside those that its robot knows.


def with_own(known: Animations, folder: str, body: Body) -> tuple[Animations, list[Text]]:
    """Return a robot's animations with those of a folder, and why some of them are left out.

    An own one takes the place of a known one of the same name. What cannot be read, or was made
    for a robot with other joints, is left out: the robot can do all else. "" is no folder.
    """
    found = {name: known.get(name) for name in known.names()}
    problems = []
    for path in sorted(Path(folder).glob("*.toml")) if folder else ():
        try:
            found[path.stem] = load_animation(path, body)
        except FilesUnusable as error:
            problems.append(error.sentence)
    return Animations(found), problems
