"""The brushes that make flat outlines look round, in the colours of a robot and of a theme."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QBrush, QColor, QImage, QPainter, QPolygonF, QRadialGradient, QTransform

from nep_studio.ui.theme.colours import HIGH_CONTRAST, Theme, mixed

from .camera import Camera, Lens
from .figure import UP, Placed
from .parts import Finish
from .silhouettes import polygons

MIDDLE = QPointF(0, 0)
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


def fading(
    colour: QColor, stops: Iterable[tuple[float, float]], radius: float = 1.0, at: QPointF = MIDDLE
) -> QBrush:
    """A colour round a place; ``stops``: how far on the way outwards, and how much of it."""
    gradient, colour = QRadialGradient(at, radius), QColor(colour)
    for share, alpha in stops:
        colour.setAlphaF(alpha)
        gradient.setColorAt(share, colour)
    return QBrush(gradient)


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
        colour = QColor.fromRgb(number)
        gradient = QRadialGradient(MIDDLE, 1.15)
        gradient.setColorAt(0, mixed(colour, self._white, 0.45))
        gradient.setColorAt(1, colour)
        return QBrush(gradient)

    def _glow(self, number: int) -> QBrush:
        """What a light that is on sheds around it."""
        stops = ((0.0, 0.42), (0.35, 0.24), (0.7, 0.07), (1.0, 0.0))
        return fading(QColor.fromRgb(number), stops)

    def _gloss(self, strength: float) -> QBrush:
        return fading(self._white, ((0.0, 0.85 * strength), (0.5, 0.5 * strength), (1.0, 0.0)))


# The soft shadow of what stands on the floor, as a small picture that is laid on the floor.

Array = NDArray[np.float64]
SIDE_PX = 96
CORNERS = 16
AIR_M = 0.09
LOW_M = 0.05
"""Parts that come so near to the floor cast a darker, sharper shadow."""
SLANT = 0.32
SOFT, FIRM = 0.30, 0.34
TONE = (0.09, 0.11, 0.17)
"""Red, green and blue of a full shadow."""


@dataclass(frozen=True, eq=False)
class Shadow:
    """A picture of a shadow, and the square of the floor that it covers."""

    image: QImage
    low: tuple[float, float]
    side: float

    def paint(self, painter: QPainter, lens: Lens) -> None:
        """Lay the shadow on the floor."""
        (x, y), side = self.low, self.side
        square = [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]
        places = np.array([(a, b, 0.0) for a, b in square])
        if (lens.depths(places) < 0.1).any() or lens.eye[2] < 0.03:
            return
        corners = QPolygonF([QPointF(a, b) for a, b in lens.project(places).tolist()])
        sheet = QPolygonF([QPointF(a, b) for a, b in _SHEET])
        laid = QTransform()
        if not QTransform.quadToQuad(sheet, corners, laid):
            return
        plain = QTransform(painter.transform())
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.setTransform(laid * plain)
        painter.drawImage(0, 0, self.image)
        painter.setTransform(plain)


_SHEET = [(0, 0), (SIDE_PX, 0), (SIDE_PX, SIDE_PX), (0, SIDE_PX)]


def cast_shadow(placed: Placed, camera: Camera, depth: float = 1.0) -> Shadow | None:
    """The shadow of some parts; the light comes over the left shoulder of who looks."""
    numbers, casting = placed.assembly.casting
    if not casting.parts:
        return None
    placed = Placed(casting, placed.origins[numbers], placed.turns[numbers], {})
    # (2, 3) where on the floor the shadow of a place is
    away = math.cos(camera.yaw + 2.2), math.sin(camera.yaw + 2.2)
    slope = np.array([[1.0, 0.0, SLANT * away[0]], [0.0, 1.0, SLANT * away[1]]])
    turns = np.arange(CORNERS) * (2 * math.pi / CORNERS)
    ways = np.stack([np.cos(turns), np.sin(turns)], axis=1) @ slope
    outlines: Array = placed.farthest(ways) @ slope.T
    low, high = outlines.min(axis=(0, 1)) - AIR_M, outlines.max(axis=(0, 1)) + AIR_M
    middle, side = (low + high) / 2, float((high - low).max())
    low = middle - side / 2
    pixels = (outlines - low) * (SIDE_PX / side)
    lowest = placed.farthest(-UP[None])[:, 0, 2]
    unit = SIDE_PX / side
    soft = _soft_shadow(pixels, max(1, round(0.034 * unit)))
    firm = _soft_shadow(pixels[lowest < LOW_M], max(1, round(0.012 * unit)))
    # Darkness as a picture of a dark colour that lets more or less through
    dark = 255 * (depth * np.minimum(SOFT * soft + FIRM * firm, 0.8))
    dark_px = np.empty((SIDE_PX, SIDE_PX, 4), np.uint8)
    dark_px[..., 3] = dark
    for channel, share in zip((2, 1, 0), TONE, strict=True):
        dark_px[..., channel] = dark * share
    form = QImage.Format.Format_ARGB32_Premultiplied
    image = QImage(dark_px.tobytes(), SIDE_PX, SIDE_PX, 4 * SIDE_PX, form).copy()
    return Shadow(image, (float(low[0]), float(low[1])), side)


def _soft_shadow(outlines: Array, reach: int) -> Array:
    """How much of each pixel of the sheet is in one of the outlines, 0 to 1, blurred."""
    image = QImage(SIDE_PX, SIDE_PX, QImage.Format.Format_Grayscale8)
    image.fill(0)
    painter = QPainter(image)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(Qt.GlobalColor.white)
    for polygon in polygons(outlines):
        painter.drawConvexPolygon(polygon)
    painter.end()
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(SIDE_PX, image.bytesPerLine())
    sheet: Array = rows[:, :SIDE_PX] / 255.0
    width = 2 * reach + 1
    # Two means over a box each way, of as many pixels before and after, come near to a bell.
    for _ in range(4):
        sums = np.zeros((SIDE_PX + width, SIDE_PX))
        np.cumsum(sheet, axis=0, out=sums[reach + 1 : reach + 1 + SIDE_PX])
        sums[reach + 1 + SIDE_PX :] = sums[reach + SIDE_PX]
        sheet = ((sums[width:] - sums[:-width]) / width).T
    return sheet
