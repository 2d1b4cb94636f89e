"""What a press of the mouse begins: looking around, touching, moving a thing, dragging a limb."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QMouseEvent

from .bodies import Bodies
from .camera import Camera, Frame, Place, fitted
from .parts import Part
from .scene import Scene, SceneRobot, placed_thing

if TYPE_CHECKING:
    from .view import RobotView


# What is under the pointer: a robot's part, a thing, or the floor.

NEAR_PX = 9.0
"""A sensor is found from so near: fingers and small pads are hard to hit."""


@dataclass(frozen=True)
class Found:
    """What is at a pixel; empty where there is only the floor."""

    robot: str = ""
    part: Part | None = None
    thing: str = ""
    place: Place = (0.0, 0.0, 0.0)
    """The middle of the part, or of the thing, in the room."""

    @property
    def sensor(self) -> str:
        """The sensor that is touched there; "" none."""
        return self.part.sensor if self.part is not None else ""


def find_at(bodies: Bodies | None, scene: Scene, at: QPointF) -> Found:
    """What is seen at a pixel; a sensor also where it is missed by very little."""
    if bodies is None:
        return Found()
    for x, y in _around(at):
        number = bodies.part_at(x, y)
        found = Found() if number is None else _found(bodies, scene, number)
        if found.sensor or ((x, y) == (at.x(), at.y()) and found != Found()):
            return found
    return Found()


def _around(at: QPointF) -> list[tuple[float, float]]:
    x, y, near = at.x(), at.y(), NEAR_PX / 2
    return [(x, y), (x - near, y), (x + near, y), (x, y - near), (x, y + near)]


def _found(bodies: Bodies, scene: Scene, number: int) -> Found:
    group = int(bodies.whose[number])
    middle = bodies.placed.middles()[number]
    place = (float(middle[0]), float(middle[1]), float(middle[2]))
    if group < len(scene.robots):
        return Found(scene.robots[group].name, bodies.placed.parts[number], place=place)
    return Found(thing=scene.things[group - len(scene.robots)].id, place=place)


def place_of_sensor(bodies: Bodies | None, scene: Scene, robot: str, sensor: str) -> QPointF | None:
    """A pixel where a sensor is seen, else the middle of it; None where there is no such sensor."""
    if bodies is None:
        return None
    names = [one.name for one in scene.robots]
    group = names.index(robot) if robot in names else -1
    parts = bodies.placed.parts
    mine = np.flatnonzero(bodies.whose == group).tolist()
    numbers = [number for number in mine if parts[number].sensor == sensor]
    for number in numbers:
        middle = bodies.seen.centres[number]
        for share in (0.0, 0.35, 0.7):
            for x, y in (middle + share * (bodies.seen.outlines[number][::4] - middle)).tolist():
                found = bodies.part_at(x, y)
                if found is not None and found in numbers:
                    return QPointF(x, y)
    return QPointF(*bodies.seen.centres[numbers[0]].tolist()) if numbers else None


RAD_PER_PX = 0.009


class Gesture:
    """From the press of a button to its release; as it stands here, one that does nothing."""

    cursor = Qt.CursorShape.ClosedHandCursor

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


class Orbit(Gesture):
    """Goes around what is looked at; a click that ``lets_go`` chooses no thing any more."""

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


class Pan(Gesture):
    """Moves what is looked at."""

    cursor = Qt.CursorShape.SizeAllCursor

    def __init__(self, view: RobotView, at: QPointF) -> None:
        self._view, self._last = view, at

    def move(self, at: QPointF) -> None:
        """Move the room with the pointer."""
        way, self._last = at - self._last, at
        camera = self._view.camera
        m_per_px = camera.distance / self._view.lens.scale
        self._view.stay()
        self._view.look_through(camera.panned(-way.x() * m_per_px, way.y() * m_per_px))


class Touch(Gesture):
    """Touches a sensor as long as the button is pressed."""

    cursor = Qt.CursorShape.PointingHandCursor

    def __init__(self, view: RobotView, robot: str, sensor: str) -> None:
        self._view, self._robot, self._sensor = view, robot, sensor
        view.press(robot, sensor)

    def end(self) -> None:
        """Let go."""
        self._view.release(self._robot, self._sensor)


class MoveThing(Gesture):
    """Drags a thing over the floor."""

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


class DragLimb(Gesture):
    """Drags a limb of a robot that is being posed."""

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


# From where a scene is seen well: all of it, or the face of its first robot.

Array = NDArray[np.float64]
AIR = 0.1
NEAR_M = 1.6
"""Things that are so near to a robot are seen with it."""
FACE_BOX = np.array([(x, y, z) for x in (-0.4, 0.5) for y in (-0.62, 0.62) for z in (-0.56, 0.56)])
"""What is seen around the middle of a head, in its heights."""


def seeing_all(camera: Camera, scene: Scene, frame: Frame) -> Camera:
    """Return the camera moved so that all robots and what stands near them are seen."""
    placed = [robot.placed for robot in scene.robots]
    places = [robot.state.base[:2] for robot in scene.robots]
    placed += [
        placed_thing(thing)
        for thing in scene.things
        if any(math.dist(thing.place[:2], place) < NEAR_M for place in places)
    ]
    if not placed:
        return camera
    corners = np.concatenate([one.corners() for one in placed])
    return fitted(camera, corners, frame, AIR)


def at_face(camera: Camera, scene: Scene, frame: Frame) -> Camera:
    """Return the camera moved so that the first robot's head fills the picture."""
    if not scene.robots:
        return camera
    places = head_of(scene.robots[0]) + FACE_BOX * scene.robots[0].figure.top_m
    return fitted(camera, places, frame, AIR)


def ahead_of(scene: Scene) -> float:
    """Which way the first robot faces (rad)."""
    if not scene.robots:
        return 0.0
    torso = scene.robots[0].placed.links["torso"]
    return math.atan2(torso[1, 0], torso[0, 0])


def head_of(robot: SceneRobot) -> Array:
    """The middle of a robot's head, in the room."""
    frame = robot.placed.links[robot.figure.head]
    return frame[:3, 3] + frame[:3, 2] * robot.figure.top_m / 2
