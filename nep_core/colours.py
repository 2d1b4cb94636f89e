"""Colours written as texts such as "#ff8800": made from their parts, and mixed."""

from __future__ import annotations

import re

_COLOUR = re.compile(r"#?([0-9a-fA-F]{2})([0-9a-fA-F]{2})([0-9a-fA-F]{2})")


def colour_from(red: float, green: float, blue: float) -> str:
    """The colour with these parts of red, green and blue, each from 0 to 255."""
    return "#" + "".join(f"{_part(value):02x}" for value in (red, green, blue))


def mix_colours(first: str, second: str, percent: float = 50) -> str:
    """A colour between two others: the first at 0 percent, the second at 100."""
    share = min(max(percent, 0), 100) / 100
    pairs = zip(_parts(first), _parts(second), strict=True)
    red, green, blue = (a + (b - a) * share for a, b in pairs)
    return colour_from(red, green, blue)


def _parts(colour: str) -> tuple[int, ...]:
    parts = _COLOUR.fullmatch(colour)
    if parts is None:
        raise ValueError(f"{colour!r} is not a colour: a colour is written like #ff8800.")
    return tuple(int(part, 16) for part in parts.groups())


def _part(value: float) -> int:
    return min(max(round(value), 0), 255)
