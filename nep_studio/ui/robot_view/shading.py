"""The brushes that make flat outlines look round, in the colours of a robot and of a theme."""

from __future__ import annotations

from functools import lru_cache

from PySide6.QtCore import QPointF
from PySide6.QtGui import QBrush, QColor, QRadialGradient

from nep_studio.ui.theme import HIGH_CONTRAST, Theme

from .parts import Finish

LIGHT_AT = QPointF(-0.36, -0.46)
"""Where the light falls on the unit circle of a part; it comes from over the left shoulder."""
REACH = 1.58
STOPS = (
    (0.0, 0.55, 0.0),
    (0.28, 0.22, 0.0),
    (0.55, 0.0, 0.06),
    (0.78, 0.0, 0.22),
    (0.94, 0.0, 0.40),
    (1.0, 0.0, 0.36),
)
"""Along the way from the light: where, how much white, how much shade."""
SHADE = QColor("#1d2740")
OUTLINE_SHARE = 0.62
PALE_SHARE = 0.62


def mixed(one: QColor, other: QColor, share: float) -> QColor:
    """The colour on the way from one to another; also its transparency."""
    parts = (
        a + (b - a) * share
        for a, b in zip(one.getRgbF(), other.getRgbF(), strict=True)  # type: ignore[call-overload]
    )
    return QColor.fromRgbF(*(min(max(part, 0.0), 1.0) for part in parts))


def lit_colour(number: int) -> QColor:
    """The colour of a light 0xRRGGBB."""
    return QColor(number >> 16 & 255, number >> 8 & 255, number & 255)


class Shades:
    """Brushes and pens for one theme; each is made once."""

    def __init__(self, theme: Theme) -> None:
        self.theme = theme
        self.canvas = theme.colour("canvas")
        self._white = QColor("#ffffff")
        self.round = lru_cache(maxsize=256)(self._round)
        self.outline = lru_cache(maxsize=256)(self._outline)
        self.lamp = lru_cache(maxsize=512)(self._lamp)
        self.glow = lru_cache(maxsize=512)(self._glow)
        self.gloss = lru_cache(maxsize=64)(self._gloss)

    def base(self, colour: str, is_pale: bool) -> QColor:
        """A colour of a part, nearer to the canvas when it is pale."""
        base = QColor(colour)
        return mixed(base, self.canvas, PALE_SHARE) if is_pale else base

    def _round(self, colour: str, is_pale: bool, finish: Finish) -> QBrush:
        base = self.base(colour, is_pale)
        if finish == "flat":
            return QBrush(base)
        gradient = QRadialGradient(LIGHT_AT, REACH)
        strength = (0.35 if is_pale else 1.0) * (0.4 if finish == "matte" else 1.0)
        for at, white, shade in STOPS:
            tone = mixed(mixed(base, self._white, white * strength), SHADE, shade * strength)
            gradient.setColorAt(at, tone)
        return QBrush(gradient)

    def _outline(self, colour: str, is_pale: bool) -> QColor:
        if self.theme.name == HIGH_CONTRAST:
            return QColor("#000000")
        base = mixed(self.base(colour, False), SHADE, OUTLINE_SHARE)
        return mixed(base, self.canvas, 0.5) if is_pale else base

    def _lamp(self, number: int) -> QBrush:
        """A light that is on: nearly white in its middle."""
        colour = lit_colour(number)
        gradient = QRadialGradient(QPointF(0, 0), 1.15)
        gradient.setColorAt(0, mixed(colour, self._white, 0.45))
        gradient.setColorAt(1, colour)
        return QBrush(gradient)

    def _glow(self, number: int) -> QBrush:
        """What a light that is on sheds around it."""
        colour = lit_colour(number)
        gradient = QRadialGradient(QPointF(0, 0), 1.0)
        for at, alpha in ((0.0, 0.42), (0.35, 0.24), (0.7, 0.07), (1.0, 0.0)):
            colour.setAlphaF(alpha)
            gradient.setColorAt(at, colour)
        return QBrush(gradient)

    def _gloss(self, strength: float) -> QBrush:
        gradient = QRadialGradient(QPointF(0, 0), 1.0)
        white = QColor(self._white)
        for at, alpha in ((0.0, 0.85), (0.5, 0.5), (1.0, 0.0)):
            white.setAlphaF(alpha * strength)
            gradient.setColorAt(at, white)
        return QBrush(gradient)
