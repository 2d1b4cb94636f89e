"""Paints a scene: floor, shadows, bodies, the glow of lights, marks, speech bubbles."""

from __future__ import annotations

import logging
from collections.abc import Sequence

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QFont, QPainter, QPen, QPixmap

from nep_studio.ui.theme import Theme

from .bodies import Bodies, Dress
from .bubbles import Bubble, Said, paint_bubble, placed_bubbles
from .camera import Lens
from .drawing import NoContext, OnGpu
from .floor import paint_grid, paint_path
from .looking import head_of
from .placed import Placed
from .polygons import polygons
from .scene import Scene, SceneRobot
from .shading import Shades
from .shadows import Shadow, cast_shadow
from .things import placed_thing, thing_colours

log = logging.getLogger(__name__)


class ScenePainter:
    """Paints scenes in the colours of a theme; keeps what did not change from frame to frame."""

    def __init__(self, theme: Theme, gl: OnGpu | None = None) -> None:
        self.shades = Shades(theme)
        self.gl = gl
        self._floor: tuple[object, QPixmap] | None = None
        self._shadows: dict[object, tuple[Placed, Shadow | None]] = {}
        self._bodies: tuple[object, Bodies | None] = (None, None)
        self.bubbles: list[Bubble] = []

    @property
    def theme(self) -> Theme:
        """The theme in use."""
        return self.shades.theme

    def use_theme(self, theme: Theme) -> None:
        """Paint in the colours of another theme from now on."""
        self.shades, self._floor = Shades(theme), None
        self._shadows.clear()

    def paint(self, painter: QPainter, scene: Scene, lens: Lens, font: QFont) -> None:
        """Paint a scene as a lens sees it."""
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._paint_floor(painter, scene, lens)
        self._paint_shadows(painter, groups_of(scene), lens)
        if not self._paint_with_gl(painter, scene, lens):
            bodies = self.bodies_of(scene, lens)
            if bodies is not None:
                bodies.paint(painter, self.shades)
        self._paint_marks(painter, scene, lens)
        self.bubbles = _bubbles(scene, lens, font) if scene.has_bubbles else []
        for bubble in self.bubbles:
            paint_bubble(painter, bubble, self.theme, font)

    def bodies_of(self, scene: Scene, lens: Lens) -> Bodies | None:
        """All parts as a lens sees them; kept until something moves."""
        key = (scene.robots, scene.things, lens.camera, lens.width, lens.height)
        if self._bodies[0] != key:
            self._bodies = key, Bodies.through(lens, groups_of(scene))
        return self._bodies[1]

    def _paint_with_gl(self, painter: QPainter, scene: Scene, lens: Lens) -> bool:
        """Paint the bodies with OpenGL; whether that went well."""
        if self.gl is None:
            return False
        try:
            picture = self.gl.picture(groups_of(scene), lens, self.shades)
        except NoContext as error:
            log.warning("Robots are painted without OpenGL from now on: %s", error)
            self.gl = None
            return False
        painter.drawImage(QPointF(0, 0), picture)
        return True

    def _paint_floor(self, painter: QPainter, scene: Scene, lens: Lens) -> None:
        painter.fillRect(0, 0, int(lens.width) + 1, int(lens.height) + 1, self.shades.canvas)
        if scene.has_floor:
            ratio = painter.device().devicePixelRatioF()
            painter.drawPixmap(0, 0, self._grid(lens, ratio))
        for robot in scene.robots:
            paint_path(painter, lens, self.theme, robot.path)

    def _grid(self, lens: Lens, ratio: float) -> QPixmap:
        key = (lens.camera, lens.width, lens.height, ratio)
        if self._floor is None or self._floor[0] != key:
            sheet = QPixmap(round(lens.width * ratio), round(lens.height * ratio))
            sheet.setDevicePixelRatio(ratio)
            sheet.fill(Qt.GlobalColor.transparent)
            painter = QPainter(sheet)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            paint_grid(painter, lens, self.theme)
            painter.end()
            self._floor = key, sheet
        return self._floor[1]

    def _paint_shadows(
        self, painter: QPainter, groups: Sequence[tuple[Placed, Dress]], lens: Lens
    ) -> None:
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

    def _paint_marks(self, painter: QPainter, scene: Scene, lens: Lens) -> None:
        """Paint rims around what is marked and what is felt."""
        numbers = _marked_parts(scene)
        bodies = self.bodies_of(scene, lens) if numbers else None
        if bodies is None:
            return
        colour = self.theme.colour("glow" if scene.marked.is_pressed else "focus")
        painter.setBrush(Qt.BrushStyle.NoBrush)
        visible = [i for i in bodies.order if i in numbers]
        for polygon in polygons(bodies.seen.grown(2.0)[visible]) if visible else []:
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
        for number, part in enumerate(robot.placed.parts, start=start):
            is_touched = part.sensor in felt or (is_marked and part.sensor == marked.sensor)
            is_limb = is_marked and bool(marked.link) and part.link == marked.link and not part.on
            if (part.sensor and is_touched) or is_limb:
                numbers.add(number)
        start += len(robot.placed.parts)
    for thing in scene.things:
        count = len(placed_thing(thing).parts)
        if thing.id == marked.thing:
            numbers |= set(range(start, start + count))
        start += count
    return numbers


def _bubbles(scene: Scene, lens: Lens, font: QFont) -> list[Bubble]:
    said = [_said(robot, lens) for robot in scene.robots if robot.state.saying]
    return placed_bubbles([one for one in said if one is not None], font, lens.width, lens.height)


def _said(robot: SceneRobot, lens: Lens) -> Said | None:
    """What a robot says, at its head; None behind the eye."""
    head = head_of(robot)
    depth = float(lens.depths(head))
    if depth < 0.05:
        return None
    x, y = lens.project(head).tolist()
    size = robot.figure.top_m * lens.scale / depth
    return Said(robot.state.saying, QPointF(x, y), size * 0.55)
