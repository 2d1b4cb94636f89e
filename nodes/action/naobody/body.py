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

CLAMP_TOLERANCE_RAD = 1e-6


class Joint(msgspec.Struct, frozen=True):
    """One joint: what it may do. Hands count 0 (closed) to 1 (open) instead of rad."""

    name: str
    limb: Limb
    min_rad: float
    max_rad: float
    max_speed_rad_s: float


class ShellLimit(msgspec.Struct, frozen=True):
    """How far the head can nod (degrees) when it is turned by ``yaw`` degrees to either side."""

    yaw: float
    min_pitch: float
    max_pitch: float


class Posture(msgspec.Struct, frozen=True):
    """A named pose; ``next`` are the postures that can be reached from it in one move."""

    family: str
    next: tuple[str, ...]
    angles: tuple[float, ...]


class _BodyFile(msgspec.Struct, frozen=True):
    joints: tuple[Joint, ...]
    same_motor: dict[str, str]
    head_shell_deg: tuple[ShellLimit, ...]
    postures: dict[str, Posture]


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
        self._shell = np.radians([(s.yaw, s.min_pitch, s.max_pitch) for s in file.head_shell_deg]).T

    @cached_property
    def head(self) -> tuple[int, int]:
        """Where the head's yaw and pitch are in the joint order."""
        return self.index["HeadYaw"], self.index["HeadPitch"]

    def posture_angles(self, name: str) -> Angles:
        """Return the angles of a posture, in joint order."""
        return np.array(self.postures[name].angles)

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
