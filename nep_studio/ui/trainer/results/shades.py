"""Colours between two of the table, and the one of two that can be read on another."""

from __future__ import annotations

from PySide6.QtGui import QColor


def mixed(one: QColor, other: QColor, part: float) -> QColor:
    """A colour on the way from one to another; ``part`` is how far, from 0 to 1."""
    return QColor(
        round(one.red() + part * (other.red() - one.red())),
        round(one.green() + part * (other.green() - one.green())),
        round(one.blue() + part * (other.blue() - one.blue())),
    )


def legible(ground: QColor, *colours: QColor) -> QColor:
    """Of these colours the one with the highest contrast on a ground."""
    return max(colours, key=lambda colour: contrast(ground, colour))


def contrast(one: QColor, other: QColor) -> float:
    """The contrast of two colours, from 1 to 21, as WCAG 2 defines it."""
    bright, dark = sorted((_luminance(one), _luminance(other)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


def _luminance(colour: QColor) -> float:
    parts = (colour.redF(), colour.greenF(), colour.blueF())
    linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
