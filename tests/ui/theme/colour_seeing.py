"""How colours look: contrast by WCAG 2, distance in OKLab, eyes without red or green cones."""

from __future__ import annotations

import math

from PySide6.QtGui import QColor

FULL_SIGHT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
PROTANOPIA = (
    (0.152286, 1.052583, -0.204868),
    (0.114503, 0.786281, 0.099216),
    (-0.003882, -0.048116, 1.051998),
)
DEUTERANOPIA = (
    (0.367322, 0.860646, -0.227968),
    (0.280085, 0.672501, 0.047413),
    (-0.011820, 0.042940, 0.968881),
)
"""Machado, Oliveira and Fernandes 2009, severity 1, on linear sRGB."""

EYES = {"full sight": FULL_SIGHT, "protanopia": PROTANOPIA, "deuteranopia": DEUTERANOPIA}

Matrix = tuple[tuple[float, float, float], ...]


def linear(colour: QColor) -> tuple[float, ...]:
    parts = (colour.redF(), colour.greenF(), colour.blueF())
    return tuple(it / 12.92 if it <= 0.04045 else ((it + 0.055) / 1.055) ** 2.4 for it in parts)


def contrast(one: QColor, other: QColor) -> float:
    """The contrast ratio of WCAG 2, from 1 to 21."""
    weights = (0.2126, 0.7152, 0.0722)
    dark, bright = sorted(
        sum(a * b for a, b in zip(weights, linear(it), strict=True)) for it in (one, other)
    )
    return (bright + 0.05) / (dark + 0.05)


def seen(colour: QColor, eye: Matrix) -> tuple[float, float, float]:
    """A colour in OKLab as an eye sees it."""
    mixed = [sum(a * b for a, b in zip(row, linear(colour), strict=True)) for row in eye]
    red, green, blue = (min(1.0, max(0.0, part)) for part in mixed)
    long = math.cbrt(0.4122214708 * red + 0.5363325363 * green + 0.0514459929 * blue)
    middle = math.cbrt(0.2119034982 * red + 0.6806995451 * green + 0.1073969566 * blue)
    short = math.cbrt(0.0883024619 * red + 0.2817188376 * green + 0.6299787005 * blue)
    return (
        0.2104542553 * long + 0.7936177850 * middle - 0.0040720468 * short,
        1.9779984951 * long - 2.4285922050 * middle + 0.4505937099 * short,
        0.0259040371 * long + 0.7827717662 * middle - 0.8086757660 * short,
    )


def distance(one: QColor, other: QColor, eye: Matrix) -> float:
    """How different two colours look: 0 for the same, 1 for black and white."""
    return math.dist(seen(one, eye), seen(other, eye))
