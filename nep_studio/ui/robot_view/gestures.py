"""What a press of the mouse begins: looking around, touching, moving a thing, dragging a limb."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QMouseEvent

from .camera import Place
from .picking import Found

if TYPE_CHECKING:
    from .view import RobotView

RAD_PER_PX = 0.009


class Gesture(Protocol):
    """From the press of a button to its release."""

    cursor: Qt.CursorShape

    def move(self, at: QPointF) -> None:
        """The pointer is somewhere else now."""

    def end(self) -> None:
        """The button is let go, or the gesture is broken off."""


def begun(view: RobotView, event: QMouseEvent, found: Found) -> Gesture:
    """The gesture that a press begins."""
    at, shift = event.position(), Qt.KeyboardModifier.ShiftModifier
    if event.button() == Qt.MouseButton.MiddleButton or event.modifiers() & shift:
        return Pan(view, at)
    if event.button() != Qt.MouseButton.LeftButton:
        return Orbit(view, at)
    if found.part is not None and view.is_posing:
        return DragLimb(view, found)
    if found.sensor and view.room.can_touch(found.robot):
        return Touch(view, found.robot, found.sensor)
    if found.thing and view.can_move_things:
        return MoveThing(view, found, at)
    if found.robot:
        view.robot_chosen.emit(found.robot)
    return Orbit(view, at, lets_go=not found.robot)


class Orbit:
    """Goes around what is looked at; a click that ``lets_go`` chooses no thing any more."""

    cursor = Qt.CursorShape.ClosedHandCursor

    def __init__(self, view: RobotView, at: QPointF, *, lets_go: bool = False) -> None:
        self._view, self._last, self._lets_go = view, at, lets_go

    def move(self, at: QPointF) -> None:
        """Turn the room with the pointer."""
        way, self._last = at - self._last, at
        self._lets_go = self._lets_go and way.manhattanLength() < 2
        camera = self._view.camera.orbited(-way.x() * RAD_PER_PX, way.y() * RAD_PER_PX)
        self._view.look_through(camera)

    def end(self) -> None:
        """Stay where it is."""
        if self._lets_go:
            self._view.thing_chosen.emit("")


class Pan:
    """Moves what is looked at."""

    cursor = Qt.CursorShape.SizeAllCursor

    def __init__(self, view: RobotView, at: QPointF) -> None:
        self._view, self._last = view, at

    def move(self, at: QPointF) -> None:
        """Move the room with the pointer."""
        way, self._last = at - self._last, at
        camera = self._view.camera
        m_per_px = camera.distance / self._view.lens.scale
        self._view.follows = False
        self._view.look_through(camera.panned(-way.x() * m_per_px, way.y() * m_per_px))

    def end(self) -> None:
        """Stay where it is."""


class Touch:
    """Touches a sensor as long as the button is pressed."""

    cursor = Qt.CursorShape.PointingHandCursor

    def __init__(self, view: RobotView, robot: str, sensor: str) -> None:
        self._view, self._robot, self._sensor = view, robot, sensor
        view.press(robot, sensor)

    def move(self, at: QPointF) -> None:
        """Nothing: a touch stays where it began."""

    def end(self) -> None:
        """Let go."""
        self._view.release(self._robot, self._sensor)


class MoveThing:
    """Drags a thing over the floor."""

    cursor = Qt.CursorShape.ClosedHandCursor

    def __init__(self, view: RobotView, found: Found, at: QPointF) -> None:
        self._view, self._thing, self._above = view, found.thing, found.place[2]
        thing = next(one for one in view.room.things if one.id == found.thing)
        start = view.lens.floor_at(at.x(), at.y(), self._above) or thing.place[:2]
        self._off = (thing.place[0] - start[0], thing.place[1] - start[1])
        view.thing_chosen.emit(found.thing)

    def move(self, at: QPointF) -> None:
        """Put it under the pointer, where the floor is."""
        place = self._view.lens.floor_at(at.x(), at.y(), self._above)
        if place is not None:
            x, y = place[0] + self._off[0], place[1] + self._off[1]
            self._view.move_thing(self._thing, x, y)

    def end(self) -> None:
        """Leave it there."""


class DragLimb:
    """Drags a limb of a robot that is being posed."""

    cursor = Qt.CursorShape.ClosedHandCursor

    def __init__(self, view: RobotView, found: Found) -> None:
        assert found.part is not None
        self._view, self._robot, self._link = view, found.robot, found.part.link
        self._place: Place = found.place
        view.limb_pressed.emit(self._robot, self._link, self._place)

    def move(self, at: QPointF) -> None:
        """Say where in the room the pointer is, as far from the eye as the limb was."""
        place = self._view.lens.plane_at(at.x(), at.y(), self._place)
        self._view.limb_dragged.emit(self._robot, self._link, place)

    def end(self) -> None:
        """The limb stays where it is."""
        self._view.limb_released.emit(self._robot, self._link)
