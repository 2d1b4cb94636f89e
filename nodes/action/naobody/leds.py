"""A robot's lights: which groups there are, and what a colour's text means."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

from nep_core.errors import ActionFailed

OFF = 0x000000
WHITE = 0xFFFFFF
Colouring = Callable[[int], int]
"""Which colour comes when: the number of the change, 0xRRGGBB."""

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
        raise ActionFailed(f'There are no lights called "{group}". Possible: {known}.')
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
        raise ActionFailed(f'"{colour}" is not a colour. Write one like #ff8000: red, green, blue.')
    return int(colour[1:], 16)


def mixed(start: int, end: int, part: float) -> int:
    """Return the colour that is ``part`` (0 to 1) of the way from one colour to another."""
    colour = 0
    for shift in (16, 8, 0):
        first, last = (start >> shift) & 0xFF, (end >> shift) & 0xFF
        colour |= round(first + (last - first) * part) << shift
    return colour


def brightest(colour: int) -> int:
    """Return a colour with the same hue, as bright as it can be."""
    parts = [(colour >> shift) & 0xFF for shift in (16, 8, 0)]
    most = max(parts) or 255
    red, green, blue = (round(part * 255 / most) for part in parts)
    return red << 16 | green << 8 | blue
