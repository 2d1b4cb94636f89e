"""The parts of a robot that can be busy independently of each other."""

from __future__ import annotations

from enum import StrEnum


class Limb(StrEnum):
    """A part that one command uses at a time."""

    VOICE = "voice"
    HEAD = "head"
    LEFT_ARM = "left_arm"
    RIGHT_ARM = "right_arm"
    LEGS = "legs"
    LEDS = "leds"
    EARS = "ears"


MOVING = frozenset({Limb.HEAD, Limb.LEFT_ARM, Limb.RIGHT_ARM, Limb.LEGS})
"""The limbs that have joints."""
# Where a robot feels that it is touched.

TOUCH_SENSORS = (
    "head_front",
    "head_middle",
    "head_rear",
    "hand_left",
    "hand_right",
    "bumper_left",
    "bumper_right",
    "chest_button",
)
