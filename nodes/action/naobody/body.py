"""A robot's body as it was built: joints with their limits and speeds, head shell, postures."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from nep_core.errors import NodeStartError
from nodes.action.naobody.limbs import Limb

Angles = NDArray[np.float64]
"""Rad in the body's joint order (hands 0 to 1), or rows of them, one every tick."""
Vector = tuple[float, float, float]

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
    """

    mass_kg: float = 0.0
    centre_m: Vector = (0.0, 0.0, 0.0)
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


class Way(msgspec.Struct, frozen=True):
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
    ways: tuple[Way, ...] = ()
    cameras: tuple[Camera, ...] = ()
    sonars: dict[str, Sonar] = {}


class Body:
    """The joint table and postures of one kind of robot.

    ``names``, ``min``, ``max`` and ``max_speed`` are in the same order: the body's joint order.
    """

    def __init__(self, file: _BodyFile) -> None:
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
    """Read ``body.json`` of a robot's folder. Raises NodeStartError when it cannot be used."""
    path = folder / "body.json"
    try:
        return Body(msgspec.json.decode(path.read_bytes(), type=_BodyFile))
    except (OSError, msgspec.DecodeError) as error:
        raise NodeStartError(
            f"The description of the robot's body, {path}, cannot be read.",
            checklist=("Install NEP Studio again: this file comes with it.",),
            details=str(error),
        ) from error
