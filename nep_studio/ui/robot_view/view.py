"""The robot view: a small room with robots, which can be looked at from all sides and touched."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QEvent, QPointF, Qt, Signal
from PySide6.QtGui import QHelpEvent, QHideEvent, QKeyEvent, QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QToolTip

from nep_studio.ui.theme import Look

from .drawing import Drawing
from .gestures import Gesture, begun
from .keys import key_pressed, key_released, next_mark
from .picking import Found, find_at, place_of_sensor
from .room import moved
from .room_picture import RoomPicture, nao_folder
from .scene import Marked
from .telling import hovered, pinched, tip_words

__all__ = ["RobotView", "nao_folder"]

WHEEL_STEP = 1.0015


class RobotView(RoomPicture):
    """Shows robots and things in a room.

    ``touched`` gives a robot, its sensor, and whether it is pressed or let go. ``thing_chosen``
    gives a thing's id ("" none), ``thing_moved`` also where on the floor it is dragged to (m).
    While ``is_posing``, ``limb_pressed`` and ``limb_dragged`` give a robot, a link, and the place
    (x, y, z m in the room) of the pointer; ``limb_released`` a robot and a link.
    """

    touched = Signal(str, str, bool)
    robot_chosen = Signal(str)
    thing_chosen = Signal(str)
    thing_moved = Signal(str, float, float)
    limb_pressed = Signal(str, str, tuple)
    limb_dragged = Signal(str, str, tuple)
    limb_released = Signal(str, str)

    def __init__(
        self,
        look: Look,
        touch_names: Mapping[str, str] | None = None,
        drawing: Drawing = "auto",
    ) -> None:
        super().__init__(look, touch_names, drawing)
        self.is_posing = False
        self.can_move_things = True
        self._gesture: Gesture | None = None
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.grabGesture(Qt.GestureType.PinchGesture)

    def move_thing(self, thing: str, x: float, y: float) -> None:
        """Put a thing somewhere else, and tell it."""
        self.show_things(moved(self.room.things, thing, x, y))
        self.thing_moved.emit(thing, x, y)

    def press(self, robot: str, sensor: str) -> None:
        """Touch a sensor of a robot."""
        self.mark(Marked(robot, sensor, is_pressed=True))
        self.touched.emit(robot, sensor, True)

    def release(self, robot: str, sensor: str) -> None:
        """Let go of a sensor."""
        self.mark(Marked(robot, sensor))
        self.touched.emit(robot, sensor, False)

    def found_at(self, at: QPointF) -> Found:
        """What is at a place of this widget."""
        scene = self.room.scene()
        return find_at(self.painter.bodies_of(scene, self.lens), scene, at)

    def place_of(self, robot: str, sensor: str) -> QPointF | None:
        """Where a sensor is in this widget."""
        scene = self.room.scene()
        return place_of_sensor(self.painter.bodies_of(scene, self.lens), scene, robot, sensor)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin to look around, to touch, or to drag."""
        self._end_gesture()
        self._gesture = begun(self, event, self.found_at(event.position()))
        self.setCursor(self._gesture.cursor)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Go on, or show what could be touched."""
        if self._gesture is not None:
            self._gesture.move(event.position())
            return
        found = self.found_at(event.position())
        self.mark(hovered(self, found))
        is_hot = self.room.marked != Marked()
        shape = Qt.CursorShape.PointingHandCursor if is_hot else Qt.CursorShape.OpenHandCursor
        self.setCursor(shape)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let go."""
        self._end_gesture()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """See all again; on a sensor it is a second touch."""
        found = self.found_at(event.position())
        if found == Found() and event.button() == Qt.MouseButton.LeftButton:
            self.fit()
        else:
            self.mousePressEvent(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Come nearer or go away."""
        self.zoom(WHEEL_STEP ** event.angleDelta().y())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Look around and touch with keys."""
        if not key_pressed(self, event):
            super().keyPressEvent(event)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """Let go."""
        if not key_released(self, event):
            super().keyReleaseEvent(event)

    def focusNextPrevChild(self, is_next: bool) -> bool:
        """Let Tab go through what can be touched, then on to the next widget."""
        marked = next_mark(self, 1 if is_next else -1)
        self.mark(marked or Marked())
        return marked is not None or super().focusNextPrevChild(is_next)

    def event(self, event: QEvent) -> bool:
        """Tell what is under the pointer; zoom with two fingers; let go when the mouse leaves."""
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            words = tip_words(self, self.found_at(event.pos().toPointF()))
            QToolTip.showText(event.globalPos(), words, self)
            return True
        factor = pinched(event)
        if factor is not None:
            self.zoom(factor)
            return True
        if event.type() == QEvent.Type.FocusOut or (
            event.type() == QEvent.Type.Leave and self._gesture is None
        ):
            self._let_go()
        return super().event(event)

    def hideEvent(self, event: QHideEvent) -> None:
        """Let go; do nothing while nobody looks."""
        self._let_go()
        super().hideEvent(event)

    def _let_go(self) -> None:
        """Touch nothing, whether with the mouse or with a key, and mark nothing."""
        self._end_gesture()
        marked = self.room.marked
        if marked.is_pressed:
            self.release(marked.robot, marked.sensor)
        self.mark(Marked())

    def _end_gesture(self) -> None:
        if self._gesture is not None:
            gesture, self._gesture = self._gesture, None
            gesture.end()
            self.setCursor(Qt.CursorShape.OpenHandCursor)
