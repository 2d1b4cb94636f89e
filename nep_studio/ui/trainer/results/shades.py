"""Colours between two of the table, and those that can be read on another."""

from __future__ import annotations

from PySide6.QtGui import QColor

READABLE = 4.5
"""The contrast that words need on what is behind them."""


def mixed(one: QColor, other: QColor, part: float) -> QColor:
    """A colour on the way from one to another; ``part`` is how far, from 0 to 1."""
    return QColor(
        round(one.red() + part * (other.red() - one.red())),
        round(one.green() + part * (other.green() - one.green())),
        round(one.blue() + part * (other.blue() - one.blue())),
    )


def legible(ground: QColor, *colours: QColor) -> QColor:
    """The first of these colours that can be read on a ground; black or white where none can."""
    readable = (colour for colour in colours if contrast(ground, colour) >= READABLE)
    black, white = QColor("black"), QColor("white")
    return next(readable, max(black, white, key=lambda colour: contrast(ground, colour)))


def contrast(one: QColor, other: QColor) -> float:
    """The contrast of two colours, from 1 to 21, as WCAG 2 defines it."""
    bright, dark = sorted((_luminance(one), _luminance(other)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


def _luminance(colour: QColor) -> float:
    parts = (colour.redF(), colour.greenF(), colour.blueF())
    linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
