"""The picture of one robot's body, which can be touched with the mouse.

This is the one place to change for another picture of a robot: it is shown a RobotState, it says
which part is touched, and it has no other ties to the panel.
"""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QHelpEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QPixmap, QTransform
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from nep_core.messages import RobotState
from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr

from .drawing import RobotDrawing
from .figure import figure

TOUCH_MM = 30.0
PARTS = {
    "head_front": "head_front",
    "head_middle": "head_middle",
    "head_rear": "head_rear",
    "hand_left": "L_hand",
    "hand_right": "R_hand",
    "bumper_left": "L_toe",
    "bumper_right": "R_toe",
    "chest_button": "chest",
}
"""What can be touched: the sensor, and the part of the figure that it is on."""
AIR_MM = 55.0
PALE = 0.4
"""How a robot is drawn of which nothing is known."""
TALL_MM, WIDE_MM = 640.0, 420.0
NO_STATE = RobotState(robot="", joints={})


class RobotScene(QWidget):
    """Shows a robot's body; ``touched`` gives a sensor, and whether it is pressed or let go."""

    touched = Signal(str, bool)

    def __init__(self, look: Look, touch_names: Mapping[str, str]) -> None:
        super().__init__()
        self._look, self._touch_names = look, touch_names
        self._state = NO_STATE
        self._dots = figure({})
        self._pressed = self._hovered = ""
        self.is_touchable = False
        self.setMouseTracking(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        look.theme_changed.connect(self.update)

    def show_state(self, state: RobotState | None) -> None:
        """Show the robot as it is now; None: nothing is known of it."""
        self._state = state or NO_STATE
        self._dots = figure(self._state.joints, self._state.posture)
        self.update()

    def sizeHint(self) -> QSize:
        """Tall enough to see the eyes."""
        line = self.fontMetrics().height()
        return QSize(line * 10, line * 12)

    def part_at(self, place: QPointF) -> str:
        """The sensor under a place of this widget; "" where there is none."""
        inverse, is_there = self._transform().inverted()
        if not is_there or not self.is_touchable:
            return ""
        at = inverse.map(place)
        far = {
            sensor: (self._dots[part].x - at.x()) ** 2 + (self._dots[part].y - at.y()) ** 2
            for sensor, part in PARTS.items()
        }
        nearest = min(far, key=lambda sensor: far[sensor])
        return nearest if far[nearest] <= TOUCH_MM**2 else ""

    def place_of(self, sensor: str) -> QPointF:
        """Where a sensor is in this widget."""
        dot = self._dots[PARTS[sensor]]
        return self._transform().map(QPointF(dot.x, dot.y))

    def _transform(self) -> QTransform:
        """From mm to this widget: all of the body is seen, its middle in the middle."""
        xs, ys = [dot.x for dot in self._dots.values()], [dot.y for dot in self._dots.values()]
        body = QRectF(QPointF(min(xs), min(ys)), QPointF(max(xs), max(ys)))
        body.adjust(-AIR_MM, -AIR_MM, AIR_MM, AIR_MM)
        wide, tall = max(body.width(), WIDE_MM), max(body.height(), TALL_MM)
        scale = min(self.width() / wide, self.height() / tall)
        transform = QTransform.fromTranslate(self.width() / 2, self.height() / 2)
        transform.scale(scale, scale)
        return transform.translate(-body.center().x(), -body.center().y())

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the robot, paler while nothing is known of it."""
        painter = QPainter(self)
        painter.setOpacity(PALE if self._state is NO_STATE else 1.0)
        painter.drawPixmap(0, 0, self._picture())
        painter.setOpacity(1.0)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setTransform(self._transform())
        for sensor in PARTS:
            self._mark_touch(painter, sensor)

    def _picture(self) -> QPixmap:
        """The robot on a sheet of its own, so that it is pale as a whole."""
        ratio = self.devicePixelRatioF()
        picture = QPixmap(self.size() * ratio)
        picture.setDevicePixelRatio(ratio)
        picture.fill(Qt.GlobalColor.transparent)
        painter = QPainter(picture)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setTransform(self._transform(), True)
        RobotDrawing(painter, self._look.theme, self._dots, self._state.leds).draw()
        painter.end()
        return picture

    def _mark_touch(self, painter: QPainter, sensor: str) -> None:
        is_felt = self._state.sensors.get(sensor, 0.0) > 0
        if not is_felt and sensor not in (self._pressed, self._hovered):
            return
        name = "glow" if is_felt or sensor == self._pressed else "focus"
        pen = QPen(self._look.theme.colour(name), 8)
        if not is_felt:
            pen.setStyle(Qt.PenStyle.DotLine)
        painter.setPen(pen)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        dot = self._dots[PARTS[sensor]]
        painter.drawEllipse(QPointF(dot.x, dot.y), TOUCH_MM, TOUCH_MM)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Touch the part under the mouse."""
        self._release()
        part = self.part_at(event.position())
        if part and event.button() == Qt.MouseButton.LeftButton:
            self._pressed = part
            self.touched.emit(part, True)
            self.update()
        else:
            super().mousePressEvent(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let go."""
        self._release()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Show what would be touched."""
        part = self.part_at(event.position())
        if part != self._hovered:
            self._hovered = part
            shape = Qt.CursorShape.PointingHandCursor if part else Qt.CursorShape.ArrowCursor
            self.setCursor(shape)
            self.update()

    def event(self, event: QEvent) -> bool:
        """Say what would be touched, and forget it when the mouse leaves."""
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            part = self.part_at(event.pos().toPointF())
            words = tr("Touch {part}", part=self._touch_names.get(part, part)) if part else ""
            QToolTip.showText(event.globalPos(), words, self)
            return True
        if event.type() in (QEvent.Type.Leave, QEvent.Type.Hide):
            self._hovered = ""
            self._release()
            self.update()
        return super().event(event)

    def _release(self) -> None:
        if self._pressed:
            part, self._pressed = self._pressed, ""
            self.touched.emit(part, False)
            self.update()
