"""Paints a scene: floor, shadows, bodies, the glow of lights, marks, speech bubbles."""

from __future__ import annotations

import logging
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import (
    QColor,
    QFont,
    QFontMetricsF,
    QPainter,
    QPainterPath,
    QPen,
    QPixmap,
    QPolygonF,
    QTransform,
)

from nep_studio.ui.theme.colours import Theme

from .bodies import Bodies, Dress
from .camera import Lens
from .drawing import NoContext
from .figure import Placed
from .gestures import head_of
from .scene import FloorPlace, Marked, Scene, placed_thing, thing_colours
from .shading import Shades, Shadow, cast_shadow, fading
from .silhouettes import polygons

if TYPE_CHECKING:
    from .gl_bodies import GlBodies

log = logging.getLogger(__name__)


# The speech bubbles beside the heads of robots that talk, all of each inside the picture.

MOST_LETTERS = 400
WIDEST_EM, NARROWEST_EM = 22.0, 10.0
EDGE, AIR, TAIL = 0.3, 0.45, 0.8
"""In lines: around bubbles, around words, and between a bubble and its head."""
HIGHEST_SHARE = 0.4
FLAGS = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap


@dataclass(frozen=True)
class Said:
    """What a robot says, and where the middle of its head is on the picture, and how large."""

    words: str
    head: QPointF
    half_px: float


@dataclass(frozen=True)
class Bubble:
    """Where the words are, and where the tail points to."""

    words: str
    box: QRectF
    tip: QPointF


def placed_bubbles(said: Iterable[Said], font: QFont, width: float, height: float) -> list[Bubble]:
    """Place bubbles above or beside heads, inside the picture and not over each other."""
    placed: list[Bubble] = []
    for one in sorted(said, key=lambda item: item.head.x()):
        bubble = _placed(one, QFontMetricsF(font), width, height)
        box = QRectF(bubble.box)
        # It is moved off those that are there already.
        for other in placed:
            if not box.intersects(other.box):
                continue
            if other.box.top() - box.height() - 6 >= 0:
                box.moveBottom(other.box.top() - 6)
            elif other.box.right() + 6 + box.width() <= width:
                box.moveLeft(other.box.right() + 6)
            else:
                box.moveTop(other.box.bottom() + 6)
        placed.append(Bubble(bubble.words, box, bubble.tip))
    return placed


def _placed(said: Said, metrics: QFontMetricsF, width: float, height: float) -> Bubble:
    """Above the head if there is room, else beside it, else as much as goes above."""
    line, head, half = metrics.height(), said.head, said.half_px
    edge, air = line * EDGE, line * AIR
    widest = min(WIDEST_EM * metrics.averageCharWidth() * 1.6, width - 2 * edge)
    above = head.y() - half - line * TAIL - edge
    side = 1 if head.x() < width / 2 else -1
    beside = (width - head.x() if side > 0 else head.x()) - half * 1.15 - line * TAIL - edge
    words, size = _fitting(said.words, metrics, widest - 2 * air, HIGHEST_SHARE * height)
    box = QRectF(0, 0, size.width() + 2 * air, size.height() + 1.2 * air)
    if box.height() > above and beside > metrics.averageCharWidth() * NARROWEST_EM:
        words, size = _fitting(words, metrics, min(widest, beside) - 2 * air, height - 2 * edge)
        box = QRectF(0, 0, size.width() + 2 * air, size.height() + 1.2 * air)
        off = half * 1.15 + line * TAIL + box.width() / 2
        box.moveCenter(QPointF(head.x() + side * off, head.y() - half * 0.5))
        tip = QPointF(head.x() + side * half * 1.1, head.y())
    else:
        room = max(above, line * 1.6)
        words, size = _fitting(words, metrics, widest - 2 * air, room - 1.2 * air)
        box = QRectF(0, 0, size.width() + 2 * air, size.height() + 1.2 * air)
        box.moveCenter(QPointF(head.x() + half * 0.6, 0))
        box.moveBottom(head.y() - half - line * TAIL)
        tip = QPointF(head.x() + half * 0.25, head.y() - half)
    box.moveLeft(min(max(box.left(), edge), max(width - box.width() - edge, 0)))
    box.moveTop(min(max(box.top(), edge), max(height - box.height() - edge, 0)))
    return Bubble(words, box, tip)


def _fitting(words: str, metrics: QFontMetricsF, width: float, height: float) -> tuple[str, QRectF]:
    """The words as far as there is room for them, and their size."""
    words = words if len(words) <= MOST_LETTERS else words[:MOST_LETTERS] + "…"
    endless = QRectF(0, 0, width, 1e5)
    size = metrics.boundingRect(endless, FLAGS.value, words)
    kept = words
    while size.height() > height and len(kept) > 3:
        kept = kept[: len(kept) * 9 // 10].rstrip(" …")
        words = kept + "…"
        size = metrics.boundingRect(endless, FLAGS.value, words)
    return words, size


def paint_bubble(painter: QPainter, bubble: Bubble, theme: Theme, font: QFont) -> None:
    """Paint a bubble with its tail and words."""
    line = QFontMetricsF(font).height()
    painter.setPen(QPen(theme.colour("field_line"), max(1.2, line / 13)))
    painter.setBrush(theme.colour("field"))
    box, tip = bubble.box, bubble.tip
    body, tail = QPainterPath(), QPainterPath()
    body.addRoundedRect(box, line * 0.55, line * 0.55)
    foot = QPointF(
        min(max(tip.x(), box.left() + line), box.right() - line),
        min(max(tip.y(), box.top() + line * 0.7), box.bottom() - line * 0.7),
    )
    way = tip - foot
    far = max((way.x() ** 2 + way.y() ** 2) ** 0.5, 1.0)
    aside = QPointF(-way.y(), way.x()) * (line * 0.32 / far)
    short = foot + way * (1 - min(0.25, line * 0.35 / far))
    tail.addPolygon(QPolygonF([foot + aside, short, foot - aside]))
    tail.closeSubpath()
    painter.drawPath(body.united(tail))
    painter.setPen(theme.colour("field_text"))
    painter.setFont(font)
    painter.drawText(bubble.box, FLAGS, bubble.words)


# The floor: a grid that fades away, and walked paths.

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
    ends = np.array(along_x + along_y)
    # The lines (n, 2, 3) as far as they are before the eye
    depths = lens.depths(ends)
    is_ahead = (depths > NEAR_M).any(axis=1)
    ends, depths = ends[is_ahead], depths[is_ahead]
    if not len(ends):
        return
    for one, other in ((0, 1), (1, 0)):
        behind = depths[:, one] < NEAR_M
        share = (NEAR_M - depths[behind, one]) / (depths[behind, other] - depths[behind, one])
        ends[behind, one] += share[:, None] * (ends[behind, other] - ends[behind, one])
    lines = lens.project(ends).reshape(-1, 4).tolist()
    middle = np.array([x, y, 0.0])
    depth = max(float(lens.depths(middle)), NEAR_M)
    at = QPointF(*lens.project(middle).tolist())
    stops = ((0.0, 1.0), (0.45, 0.7), (1.0, 0.0))
    brush = fading(theme.colour("canvas_dot"), stops, lens.scale * reach / depth, at)
    painter.setPen(QPen(brush, 1.0))
    painter.drawLines([QLineF(a, b, c, d) for a, b, c, d in lines])


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


def paint_path(painter: QPainter, lens: Lens, theme: Theme, path: Sequence[FloorPlace]) -> None:
    """Paint the way that a robot has walked: dots on the floor, and where it began."""
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


class ScenePainter:
    """Paints scenes in the colours of a theme; keeps what did not change from frame to frame."""

    def __init__(self, theme: Theme, gl: GlBodies | None = None) -> None:
        self.shades = Shades(theme)
        self.gl = gl
        self._floor: tuple[object, QPixmap] | None = None
        self._shadows: dict[object, tuple[Placed, Shadow | None]] = {}
        self._bodies: tuple[object, Bodies | None] = (None, None)
        self.bubbles: list[Bubble] = []

    def use_theme(self, theme: Theme) -> None:
        """Paint in the colours of another theme from now on."""
        self.shades, self._floor = Shades(theme), None
        self._shadows.clear()

    def paint(self, painter: QPainter, scene: Scene, lens: Lens, font: QFont) -> None:
        """Paint a scene as a lens sees it."""
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(0, 0, int(lens.width) + 1, int(lens.height) + 1, self.shades.canvas)
        if scene.has_floor:
            ratio = painter.device().devicePixelRatioF()
            painter.drawPixmap(0, 0, self._grid(lens, ratio))
        for robot in scene.robots:
            if len(robot.path) > 1:
                paint_path(painter, lens, self.shades.theme, robot.path)
        groups = groups_of(scene)
        kept: dict[object, tuple[Placed, Shadow | None]] = {}
        for placed, dress in groups:
            key = (id(placed), round(lens.camera.yaw, 3))
            if key not in self._shadows:
                strength = 0.5 if dress.is_pale else 1.0
                self._shadows[key] = placed, cast_shadow(placed, lens.camera, strength)
            kept[key] = self._shadows[key]
            shadow = kept[key][1]
            if shadow is not None:
                shadow.paint(painter, lens)
        self._shadows = kept
        if self.gl is None or not self._paint_with_gl(self.gl, painter, scene, lens):
            bodies = self.bodies_of(scene, lens)
            if bodies is not None:
                bodies.paint(painter, self.shades)
        is_felt = any(
            robot.state.sensors.get(sensor, 0) > 0
            for robot in scene.robots
            for sensor in robot.figure.sensors
        )
        if is_felt or scene.marked != Marked():
            self._paint_marks(painter, scene, lens)
        self.bubbles = _bubbles(scene, lens, font) if scene.has_bubbles else []
        for bubble in self.bubbles:
            paint_bubble(painter, bubble, self.shades.theme, font)

    def bodies_of(self, scene: Scene, lens: Lens) -> Bodies | None:
        """All parts as a lens sees them; kept until something moves."""
        key = (scene.robots, scene.things, lens.camera, lens.width, lens.height)
        if self._bodies[0] != key:
            self._bodies = key, Bodies.through(lens, groups_of(scene))
        return self._bodies[1]

    def _paint_with_gl(self, gl: GlBodies, painter: QPainter, scene: Scene, lens: Lens) -> bool:
        """Paint the bodies with OpenGL; whether that went well."""
        try:
            picture = gl.picture(groups_of(scene), lens, self.shades)
        except NoContext as error:
            log.warning("Robots are painted without OpenGL from now on: %s", error)
            self.gl = None
            return False
        painter.drawImage(QPointF(0, 0), picture)
        return True

    def _grid(self, lens: Lens, ratio: float) -> QPixmap:
        key = (lens.camera, lens.width, lens.height, ratio)
        if self._floor is None or self._floor[0] != key:
            sheet = QPixmap(round(lens.width * ratio), round(lens.height * ratio))
            sheet.setDevicePixelRatio(ratio)
            sheet.fill(Qt.GlobalColor.transparent)
            painter = QPainter(sheet)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            paint_grid(painter, lens, self.shades.theme)
            painter.end()
            self._floor = key, sheet
        return self._floor[1]

    def _paint_marks(self, painter: QPainter, scene: Scene, lens: Lens) -> None:
        """Paint rims around what is marked and what is felt."""
        numbers = _marked_parts(scene)
        bodies = self.bodies_of(scene, lens) if numbers else None
        if bodies is None:
            return
        colour = self.shades.theme.colour("glow" if scene.marked.is_pressed else "focus")
        painter.setBrush(Qt.BrushStyle.NoBrush)
        visible = [i for i in bodies.order if i in numbers]
        rims = (bodies.seen.outlines + 2.0 * bodies.seen.ways)[visible]
        for polygon in polygons(rims) if visible else []:
            painter.setPen(QPen(colour, 2.0))
            painter.drawConvexPolygon(polygon)


def groups_of(scene: Scene) -> list[tuple[Placed, Dress]]:
    """All robots and things with what they are painted in."""
    groups = [
        (robot.placed, Dress(robot.figure.colours, robot.state.leds, robot.is_pale))
        for robot in scene.robots
    ]
    return groups + [
        (placed_thing(thing), Dress(thing_colours(thing.kind), {})) for thing in scene.things
    ]


def _marked_parts(scene: Scene) -> set[int]:
    """The numbers of the parts that stand out."""
    numbers, start = set(), 0
    marked = scene.marked
    for robot in scene.robots:
        felt = {name for name, value in robot.state.sensors.items() if value > 0}
        is_marked = robot.name == marked.robot
        parts = robot.placed.assembly.parts
        for number, part in enumerate(parts, start=start):
            is_touched = part.sensor in felt or (is_marked and part.sensor == marked.sensor)
            is_limb = is_marked and bool(marked.link) and part.link == marked.link and not part.on
            if (part.sensor and is_touched) or is_limb:
                numbers.add(number)
        start += len(parts)
    for thing in scene.things:
        count = len(placed_thing(thing).parts)
        if thing.id == marked.thing:
            numbers |= set(range(start, start + count))
        start += count
    return numbers


def _bubbles(scene: Scene, lens: Lens, font: QFont) -> list[Bubble]:
    said = []
    for robot in scene.robots:
        if not robot.state.saying:
            continue
        head = head_of(robot)
        depth = float(lens.depths(head))
        if depth >= 0.05:
            size = robot.figure.top_m * lens.scale / depth
            at = QPointF(*lens.project(head).tolist())
            said.append(Said(robot.state.saying, at, size * 0.55))
    return placed_bubbles(said, font, lens.width, lens.height) if said else []
