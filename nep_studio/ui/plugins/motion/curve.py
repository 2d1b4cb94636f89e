"""The curve of one joint: its keys, each to be moved in time and angle by itself."""

from __future__ import annotations

import math
from collections.abc import Callable

from PySide6.QtCore import QLineF, QPointF, QRectF, QSignalBlocker, QSize, Qt
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QComboBox, QWidget

from nep_studio.blocks.language import Language
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr

from . import editing
from .motion_controller import MotionController, joint_words, limb_of_joint_words
from .timeline import Timeline, shift_of, snapped

SMALL_STEP, LARGE_STEP = 1.0, 5.0
"""Degrees, or hundredths of a hand, for an arrow key."""


class CurveView(QWidget):
    """Shows ``joint``; time is where it is on the timeline."""

    def __init__(self, controller: MotionController, timeline: Timeline, look: Look) -> None:
        super().__init__()
        self.controller, self.timeline, self.look = controller, timeline, look
        self.joint = controller.body.names[0]
        self.key_s: float | None = None
        self._grip: QPointF | None = None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        labelled(self, name="Curve of the joint")
        for signal in (controller.changed, controller.moved):
            signal.connect(self.update)

    def show_joint(self, name: str) -> None:
        """Show another joint."""
        self.joint, self.key_s = name, None
        self.update()

    @property
    def keys(self) -> list[tuple[float, float]]:
        """The times and angles of the joint's keys."""
        joint = self.controller.motion.joints.get(self.joint)
        return list(zip(joint.times, joint.keys, strict=True)) if joint is not None else []

    def place_of(self, time: float, angle: float) -> QPointF:
        """Where a moment and an angle are."""
        low, high, area = *self._limits(), self._area()
        share = (angle - low) / (high - low)
        return QPointF(self.timeline.scale.x(time), area.bottom() - share * area.height())

    def angle_at(self, y: float) -> float:
        """The angle at a height, within the limits."""
        low, high, area = *self._limits(), self._area()
        share = (area.bottom() - y) / max(area.height(), 1.0)
        return min(max(low + share * (high - low), low), high)

    def sizeHint(self) -> QSize:
        """As the timeline."""
        return self.timeline.sizeHint()

    # The mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take a key, or show a moment."""
        if event.button() != Qt.MouseButton.LeftButton:
            return
        self.key_s = self._key_at(event.position())
        if self.key_s is None:
            self.controller.show(self._time_at(event.position()))
        else:
            self.controller.show(self.key_s)
            self._grip = event.position()
        self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move the key, or show another moment."""
        if not event.buttons() & Qt.MouseButton.LeftButton:
            return
        place = event.position()
        if self._grip is None:
            self.controller.show(self._time_at(place))
        elif (place - self._grip).manhattanLength() >= self.fontMetrics().height() * 0.25:
            self._move(self._time_at(place), self.angle_at(place.y()))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let go."""
        self._grip = None
        self.controller.seal()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Set a key of this joint there."""
        place = event.position()
        if self._key_at(place) is None:
            self._set(editing.usable(self._time_at(place)), self.angle_at(place.y()))

    # The keyboard

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrows go through time and turn the joint; Page keys go from key to key."""
        is_large = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        turn = self._unit(LARGE_STEP if is_large else SMALL_STEP)
        step_s = shift_of(event.key(), self.timeline.snap_s or 0.01)
        match event.key():
            case Qt.Key.Key_Up | Qt.Key.Key_Down:
                sign = 1.0 if event.key() == Qt.Key.Key_Up else -1.0
                self._turn(sign * turn)
            case Qt.Key.Key_PageUp | Qt.Key.Key_PageDown:
                is_later = event.key() == Qt.Key.Key_PageDown
                now, times = self.controller.cursor_s, [time for time, _ in self.keys]
                later = [t for t in times if t > now + editing.SAME_S]
                earlier = [t for t in times if t < now - editing.SAME_S]
                found = min(later, default=None) if is_later else max(earlier, default=None)
                if found is not None:
                    self.key_s = found
                    self.controller.show(found)
            case Qt.Key.Key_Delete | Qt.Key.Key_Backspace if self.key_s is not None:
                motion = editing.without_key(self.controller.motion, self.joint, self.key_s)
                self.key_s = None
                self.controller.do(tr("delete a key"), motion)
            case _ if step_s is not None:
                time = snapped(self.controller.cursor_s + step_s, self.timeline.snap_s)
                self.controller.show(time)
            case _:
                super().keyPressEvent(event)

    def _turn(self, change: float) -> None:
        if self.key_s is None:
            return
        angle = next((a for t, a in self.keys if abs(t - self.key_s) < editing.SAME_S), None)
        if angle is not None:
            low, high = self._limits()
            self._set(self.key_s, min(max(angle + change, low), high), merge="turn a key")

    # Changes

    def _set(self, time: float, angle: float, *, merge: str = "") -> None:
        self.key_s = time
        self.controller.set_key(self.joint, time, angle, tr("move a key"), merge=merge)

    def _move(self, time: float, angle: float) -> None:
        assert self.key_s is not None
        before, time = self.key_s, editing.usable(time)
        others = [t for t, _ in self.keys if abs(t - before) >= editing.SAME_S]
        if any(abs(t - time) < editing.SAME_S for t in others):
            time = before  # it does not push another key of this joint away
        self.key_s = time
        self.controller.move_key(self.joint, before, time, angle, tr("move a key"), merge="curve")
        self.controller.show(time)

    def _time_at(self, place: QPointF) -> float:
        return snapped(self.timeline.scale.time(place.x()), self.timeline.snap_s)

    def _key_at(self, place: QPointF) -> float | None:
        near = self.fontMetrics().height() * 0.6
        for time, angle in self.keys:
            if (self.place_of(time, angle) - place).manhattanLength() <= near:
                return time
        return None

    def _limits(self) -> tuple[float, float]:
        body = self.controller.body
        column = body.index[self.joint]
        return float(body.min[column]), float(body.max[column])

    def _unit(self, steps: float) -> float:
        return steps / 100.0 if self.joint.endswith("Hand") else math.radians(steps)

    def _words(self, angle: float) -> str:
        if self.joint.endswith("Hand"):
            return f"{angle * 100.0:.0f} %"
        return f"{math.degrees(angle):.0f}°"

    # Painting

    def _area(self) -> QRectF:
        line = self.fontMetrics().height()
        return QRectF(0.0, line * 0.8, self.width(), self.height() - line * 1.6)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the curve between its limits."""
        theme, line = self.look.theme, self.fontMetrics().height()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), theme.colour("field"))
        low, high = self._limits()
        for angle in (low, 0.0, high):
            if low <= angle <= high:
                self._paint_level(painter, angle, is_limit=angle != 0.0)
        rehearsal = self.controller.rehearsal
        column = self.controller.body.index[self.joint]
        every = max(1, len(rehearsal.times) // 1000)
        times, angles = rehearsal.times[::every], rehearsal.angles[::every, column]
        curve = [self.place_of(float(t), float(a)) for t, a in zip(times, angles, strict=True)]
        painter.setPen(QPen(theme.colour("plot_1"), line / 7))
        painter.drawPolyline(QPolygonF(curve))
        for time, angle in self.keys:
            self._paint_key(painter, time, angle)
        x = self.timeline.scale.x(self.controller.cursor_s)
        painter.setPen(QPen(theme.colour("snap"), max(1.5, line / 9)))
        painter.drawLine(QLineF(x, 0.0, x, self.height()))
        if self.hasFocus():
            painter.setPen(QPen(theme.colour("focus"), max(2.0, line / 8)))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(self.rect().adjusted(1, 1, -1, -1))
        painter.end()

    def _paint_level(self, painter: QPainter, angle: float, *, is_limit: bool) -> None:
        theme, line = self.look.theme, self.fontMetrics().height()
        y = self.place_of(0.0, angle).y()
        style = Qt.PenStyle.DashLine if is_limit else Qt.PenStyle.SolidLine
        painter.setPen(QPen(theme.colour("line"), max(1.0, line / 16), style))
        painter.drawLine(QLineF(self.timeline.scale.x(0.0), y, self.width(), y))
        painter.setPen(theme.colour("muted"))
        place = QRectF(0.0, y - line / 2, self.timeline.scale.x(0.0) - line * 0.4, line)
        painter.drawText(place, Qt.AlignmentFlag.AlignRight, self._words(angle))

    def _paint_key(self, painter: QPainter, time: float, angle: float) -> None:
        theme, size = self.look.theme, self.fontMetrics().height() * 0.34
        is_taken = self.key_s is not None and abs(time - self.key_s) < editing.SAME_S
        painter.setPen(QPen(theme.colour("accent"), max(1.5, size / 3)))
        painter.setBrush(theme.colour("accent" if is_taken else "field"))
        painter.drawEllipse(self.place_of(time, angle), size, size)
        if is_taken:
            painter.setPen(theme.colour("text"))
            place = self.place_of(time, angle) + QPointF(size * 2, -size)
            painter.drawText(place, self._words(angle))


# The curve of a joint, and which one it is.


class CurvePanel(QWidget):
    """A choice of the joints, those that move first, and the curve of the chosen one."""

    def __init__(
        self,
        controller: MotionController,
        timeline: Timeline,
        language: Callable[[], Language],
        look: Look,
    ) -> None:
        super().__init__()
        self.controller, self._language = controller, language
        self.curve = CurveView(controller, timeline, look)
        self.joint = labelled(QComboBox(), name="Joint")
        self._moving: tuple[str, ...] | None = None
        in_column(self.joint, (self.curve, 1), of=self, margins=0)
        self.joint.currentIndexChanged.connect(self._on_chosen)
        controller.changed.connect(self.refresh)
        follow_words(self, self._say)

    def _say(self) -> None:
        self._moving = None
        self.refresh()

    def refresh(self) -> None:
        """Put the joints that move before the others."""
        body = self.controller.body
        moving = tuple(name for name in body.names if name in self.controller.motion.joints)
        if moving == self._moving:
            return
        self._moving = moving
        shown = self.curve.joint if self.joint.count() else ""
        names = [n for n in (*moving, *body.names) if n not in body.same_motor]
        with QSignalBlocker(self.joint):
            self.joint.clear()
            for name in dict.fromkeys(names):
                limb = limb_of_joint_words(body, name)
                self.joint.addItem(f"{limb}: {joint_words(self._language(), body, name)}", name)
            self.joint.setCurrentIndex(max(0, self.joint.findData(shown)))
        self._on_chosen()

    def show_joint(self, name: str) -> None:
        """Show the curve of a joint."""
        self.joint.setCurrentIndex(max(0, self.joint.findData(name)))

    def _on_chosen(self) -> None:
        if self.joint.currentData() is not None:
            self.curve.show_joint(self.joint.currentData())
