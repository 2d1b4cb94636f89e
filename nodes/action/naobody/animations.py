"""The animations that a robot knows, read from its folder of TOML files.

A file has a title, a description, what kind it is, the posture it starts from (files that move
the legs must have one), a sound that the robot makes meanwhile (``says``), and its movement: either
``poses``, which people write (key_poses.py), or for every joint its key times (s), its keys (rad)
and, if wanted, Bezier handles (s, rad before; s, rad after), which programs write.
"""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import msgspec

from nep_core.errors import ActionFailed, NodeStartError
from nodes.action.naobody.body import Body
from nodes.action.naobody.key_poses import Pose, tracks_of
from nodes.action.naobody.keyframes import Handle, Keyframes, Track, problem_of
from nodes.action.naobody.limbs import MOVING, Limb

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
            word = kinds[0] if kinds else "animation"
            raise ActionFailed(f'There is no {word} "{name}". Possible: {known}.')
        return self._animations[name]


def load_animations(folder: Path, body: Body) -> Animations:
    """Read every ``*.toml`` of a folder. Raises NodeStartError, which names file and place."""
    found = {}
    for path in sorted(folder.glob("*.toml")):
        found[path.stem] = load_animation(path, body)
    return Animations(found)


def load_animation(path: Path, body: Body) -> Animation:
    """Read one animation. Raises NodeStartError, which names file and place."""
    try:
        file = msgspec.toml.decode(path.read_bytes(), type=_AnimationFile)
        tracks = _tracks(file)
    except (OSError, ValueError) as error:
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


def _tracks(file: _AnimationFile) -> dict[str, Track]:
    if file.joints and file.poses:
        raise ValueError("poses: there are joints too; a file has either of them")
    keys = {name: Track(j.times, j.keys, j.handles) for name, j in file.joints.items()}
    return keys or tracks_of(file.poses)


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


def _unusable(path: Path, problem: str) -> NodeStartError:
    return NodeStartError(
        f"The animation {path} cannot be used: {problem}.",
        checklist=(
            f"Open {path.name} in a text editor and look at that place.",
            "Or take the file out of its folder.",
        ),
    )
