"""The arguments of what programs can ask of single motors, and of a voice that says nothing."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from nodes.action.naobody.body_actions import Speed
from nodes.action.naobody.keyframes import LARGEST, Track, problem_of
from nodes.action.naobody.limbs import Limb

Firmness = Annotated[float, Meta(ge=0.0, le=1.0)]


class Target(msgspec.Struct, frozen=True):
    """Where a joint is to go (rad, hands 0 to 1), at most at a part of its top speed."""

    angle: float
    speed: float


class SetAngles(msgspec.Struct, frozen=True):
    """Let joints go to angles (rad, hands 0 to 1); nobody waits until they are there.

    Asked again before that, they go to the new angles from where they are, without a halt.
    """

    angles: dict[str, float]
    speed: Speed = 1.0

    def __post_init__(self) -> None:
        """Raise ValueError for what is no angle."""
        _check_angles(self.angles)


class Approach(msgspec.Struct, frozen=True):
    """Go where ``targets`` say, by joint; they may change meanwhile. Only the actor asks this."""

    limb: Limb
    targets: dict[str, Target]


class ReachAngles(msgspec.Struct, frozen=True):
    """Move joints to angles; all arrive together, none faster than a part of its top speed."""

    angles: dict[str, float]
    speed: Speed = 1.0

    def __post_init__(self) -> None:
        """Raise ValueError for what is no angle."""
        _check_angles(self.angles)


class MoveThrough(msgspec.Struct, frozen=True):
    """Move joints through key angles at their times, as far as their speed allows it.

    ``relative``: the keys are added to where each joint is when it begins.
    """

    tracks: dict[str, Track]
    relative: bool = False

    def __post_init__(self) -> None:
        """Raise ValueError for keys that no joint can follow; no keys at all are none."""
        for name, track in self.tracks.items():
            if (track.times or track.keys) and (problem := problem_of(track)):
                raise ValueError(f"{name[:40]}: {problem}")


class SetStiffness(msgspec.Struct, frozen=True):
    """Let the motors of joints hold firmly (1), a little, or not at all (0), in some seconds."""

    joints: dict[str, Firmness]
    seconds: Annotated[float, Meta(ge=0.0, le=60.0)] = 0.0


class Silence(msgspec.Struct, frozen=True):
    """Say nothing for some seconds; what else is to be said waits."""

    seconds: Annotated[float, Meta(ge=0.0, le=70.0)]


def _check_angles(angles: dict[str, float]) -> None:
    if not all(abs(angle) <= LARGEST for angle in angles.values()):
        raise ValueError("an angle is infinite or not a number")


MOTOR_ACTIONS: dict[str, type[msgspec.Struct]] = {
    "set_angles": SetAngles,
    "reach_angles": ReachAngles,
    "move_through": MoveThrough,
    "set_stiffness": SetStiffness,
    "silence": Silence,
}
