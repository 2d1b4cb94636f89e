"""Paints the floor: a grid that fades away, walked paths, and the soft shadows of what stands."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QLineF, QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen, QPolygonF, QTransform

from nep_studio.ui.theme.colours import Theme

from .camera import Lens
from .scene import FloorPlace
from .shading import fading

Array = NDArray[np.float64]
GRID_M, REACH_M = 0.25, 3.0
NEAR_M = 0.1
POOL_M, POOL_DARK, POOL_LIGHT = 1.6, 0.13, 0.6


def paint_grid(painter: QPainter, lens: Lens, theme: Theme) -> None:
    """Paint lines on the floor around what is looked at, paler the farther they are."""
    if lens.eye[2] <= 0.02:
        return
    _paint_pool(painter, lens, theme)
    x, y = (round(value / GRID_M) * GRID_M for value in lens.camera.target[:2])
    reach = min(REACH_M, max(1.0, 1.4 * lens.camera.distance))
    steps = np.arange(-reach, reach + GRID_M / 2, GRID_M)
    half = np.sqrt(np.maximum(reach * reach - steps * steps, 0))
    along_x = [((x - h, y + s, 0.0), (x + h, y + s, 0.0)) for s, h in zip(steps, half, strict=True)]
    along_y = [((x + s, y - h, 0.0), (x + s, y + h, 0.0)) for s, h in zip(steps, half, strict=True)]
    ends = _before_eye(np.array(along_x + along_y), lens)
    if not len(ends):
        return
    middle = np.array([x, y, 0.0])
    depth = max(float(lens.depths(middle)), NEAR_M)
    at = QPointF(*lens.project(middle).tolist())
    stops = ((0.0, 1.0), (0.45, 0.7), (1.0, 0.0))
    brush = fading(theme.colour("canvas_dot"), stops, lens.scale * reach / depth, at)
    painter.setPen(QPen(brush, 1.0))
    painter.drawLines([QLineF(a, b, c, d) for a, b, c, d in ends.tolist()])


def _paint_pool(painter: QPainter, lens: Lens, theme: Theme) -> None:
    """Paint the light that falls on the floor around what is looked at; shadows need it."""
    target, yaw = np.array([*lens.camera.target[:2], 0.0]), lens.camera.yaw
    reach = min(0.8 * lens.camera.distance, POOL_M)
    to_eye = np.array([math.cos(yaw), math.sin(yaw), 0.0]) * reach
    aside = np.array([-to_eye[1], to_eye[0], 0.0])
    sides = (-to_eye - aside, to_eye - aside, to_eye + aside, aside - to_eye)
    corners = target + np.stack(sides)
    if (lens.depths(corners) < NEAR_M).any():
        return
    seen = QPolygonF([QPointF(a, b) for a, b in lens.project(corners).tolist()])
    square = QPolygonF([QPointF(a, b) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    laid = QTransform()
    if not QTransform.quadToQuad(square, seen, laid):
        return
    pool = QPainterPath()
    pool.addEllipse(QPointF(0, 0), 1, 1)
    most = POOL_DARK if theme.is_dark else POOL_LIGHT
    light = fading(QColor(Qt.GlobalColor.white), ((0.0, most), (0.5, 0.62 * most), (1.0, 0.0)))
    plain = QTransform(painter.transform())
    painter.setTransform(laid * plain)
    painter.fillPath(pool, light)
    painter.setTransform(plain)


def _before_eye(ends: Array, lens: Lens) -> Array:
    """The lines (n, 2, 3) as pixels (m, 4), as far as they are before the eye."""
    depths = lens.depths(ends)
    ends, depths = ends[(depths > NEAR_M).any(axis=1)], depths[(depths > NEAR_M).any(axis=1)]
    for one, other in ((0, 1), (1, 0)):
        behind = depths[:, one] < NEAR_M
        share = (NEAR_M - depths[behind, one]) / (depths[behind, other] - depths[behind, one])
        ends[behind, one] += share[:, None] * (ends[behind, other] - ends[behind, one])
    pixels: Array = lens.project(ends).reshape(-1, 4)
    return pixels


def paint_path(painter: QPainter, lens: Lens, theme: Theme, path: Sequence[FloorPlace]) -> None:
    """Paint the way that a robot has walked: dots on the floor, and where it began."""
    if len(path) < 2:
        return
    places = np.array([(x, y, 0.001) for x, y in path])
    places = places[lens.depths(places) > NEAR_M]
    if len(places) < 2:
        return
    line = QPolygonF([QPointF(x, y) for x, y in lens.project(places).tolist()])
    colour = theme.colour("accent")
    colour.setAlphaF(0.75)
    pen = QPen(colour, 2.2, Qt.PenStyle.CustomDashLine, Qt.PenCapStyle.RoundCap)
    pen.setDashPattern([0.1, 2.4])
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawPolyline(line)
    # Paint a circle on the floor
    middle = path[0]
    turns = np.linspace(0, 2 * math.pi, 40)
    x, y = middle[0] + 0.03 * np.cos(turns), middle[1] + 0.03 * np.sin(turns)
    places = np.stack([x, y, np.full_like(x, 0.001)], axis=1)
    if (lens.depths(places) > NEAR_M).all():
        painter.setPen(QPen(colour, 1.6))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolygon(QPolygonF([QPointF(a, b) for a, b in lens.project(places).tolist()]))
