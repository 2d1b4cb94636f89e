"""The arguments of what a robot can be asked to do with its body."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

Side = Literal["left", "right", "both"]
Frame = Literal["robot", "torso", "world"]
JointAngle = Annotated[float, Meta(ge=-360.0, le=360.0)]
Length = Annotated[float, Meta(ge=-100.0, le=100.0)]
Share = Annotated[float, Meta(ge=-1.0, le=1.0)]
Patience = Annotated[float, Meta(ge=0.0, le=60.0)]
Speed = Annotated[float, Meta(ge=0.001, le=1.0)]


class Hand(msgspec.Struct, frozen=True):
    """Open or close the hand of a side."""

    side: Side
    open: bool


class MoveJoint(msgspec.Struct, frozen=True):
    """Move a joint to an angle, or by one; ``speed`` is a part of its top speed."""

    joint: str
    degrees: JointAngle
    relative: bool = False
    speed: Speed = 0.3


class Stiffness(msgspec.Struct, frozen=True):
    """Lock the joints of a part of the body, or release them, so that a person can move them."""

    part: str
    on: bool


class WakeUp(msgspec.Struct, frozen=True):
    """Lock all joints and stand up."""


class Rest(msgspec.Struct, frozen=True):
    """Go down to the rest posture and release all joints."""


class Awareness(msgspec.Struct, frozen=True):
    """Let the robot look at people by itself, or not."""

    on: bool


class Breathing(msgspec.Struct, frozen=True):
    """Let the robot move a little as if it breathed, or not."""

    on: bool


class WalkFreely(msgspec.Struct, frozen=True):
    """Walk until something else is asked of the legs; each speed is a part of the highest.

    ``unless_asked_s``: stop by itself when the same request has not come again for so long, so
    that a robot whose driver is gone does not walk on; 0 is never.
    """

    forward: Share = 0.0
    left: Share = 0.0
    turn: Share = 0.0
    unless_asked_s: Patience = 0.0


class StopMoving(msgspec.Struct, frozen=True):
    """End what moves joints, at once; what is said or lit goes on."""


class LookAt(msgspec.Struct, frozen=True):
    """Turn the head to a place, m: in front of, left of and above the robot's feet or torso."""

    x_m: Length
    y_m: Length
    z_m: Length
    frame: Frame = "robot"


class PointAt(msgspec.Struct, frozen=True):
    """Point at a place with an arm; "" is the arm on the side of the place."""

    x_m: Length
    y_m: Length
    z_m: Length
    frame: Frame = "robot"
    arm: Literal["left", "right", ""] = ""


class LookAtSeen(msgspec.Struct, frozen=True):
    """Turn the head to something that the robot sees or hears."""

    thing: str


class Track(msgspec.Struct, frozen=True):
    """Keep the head, or the whole body, turned to something; "off" ends it."""

    thing: str
    using: Literal["head", "body", "off"] = "head"


BODY_ACTIONS: dict[str, type[msgspec.Struct]] = {
    "hand": Hand,
    "move_joint": MoveJoint,
    "stiffness": Stiffness,
    "wake_up": WakeUp,
    "rest": Rest,
    "awareness": Awareness,
    "breathing": Breathing,
    "walk_freely": WalkFreely,
    "look_at": LookAt,
    "point_at": PointAt,
    "look_at_seen": LookAtSeen,
    "track": Track,
}
