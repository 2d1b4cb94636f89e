"""The keys of a robot view: looking around, and touching without a mouse."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent

from .camera import PRESETS
from .scene import Marked

if TYPE_CHECKING:
    from .view import RobotView

STEP_RAD = math.radians(8)
ZOOM = 1.15
ARROWS = {
    Qt.Key.Key_Left: (1, 0),
    Qt.Key.Key_Right: (-1, 0),
    Qt.Key.Key_Up: (0, 1),
    Qt.Key.Key_Down: (0, -1),
}
ZOOMS = {Qt.Key.Key_Plus: ZOOM, Qt.Key.Key_Equal: ZOOM, Qt.Key.Key_Minus: 1 / ZOOM}
PRESET_KEYS = dict(
    zip(
        (Qt.Key.Key_1, Qt.Key.Key_2, Qt.Key.Key_3, Qt.Key.Key_4, Qt.Key.Key_5), PRESETS, strict=True
    )
)
TOUCHES = (Qt.Key.Key_Space, Qt.Key.Key_Return, Qt.Key.Key_Enter)


def key_pressed(view: RobotView, event: QKeyEvent) -> bool:
    """Do what a key says; whether it says anything."""
    key = Qt.Key(event.key())
    if key in ARROWS:
        right, up = ARROWS[key]
        view.look_through(view.camera.orbited(right * STEP_RAD, up * STEP_RAD))
    elif key in ZOOMS:
        view.zoom(ZOOMS[key])
    elif key in PRESET_KEYS:
        view.look_from(PRESET_KEYS[key])
    elif key == Qt.Key.Key_Home:
        view.fit()
    elif key in TOUCHES and view.room.marked.sensor:
        marked = view.room.marked
        if not event.isAutoRepeat():
            view.press(marked.robot, marked.sensor)
    elif key == Qt.Key.Key_Escape and view.room.marked != Marked():
        view.mark(Marked())
    else:
        return False
    return True


def key_released(view: RobotView, event: QKeyEvent) -> bool:
    """Let go of what a key touches; whether it did."""
    marked = view.room.marked
    if event.key() not in TOUCHES or event.isAutoRepeat() or not marked.is_pressed:
        return False
    view.release(marked.robot, marked.sensor)
    return True


def next_mark(view: RobotView, step: int) -> Marked | None:
    """The next thing to touch on the way of the Tab key; None past the last."""
    stops = [
        Marked(robot.name, sensor)
        for robot in view.room.scene().robots
        if view.room.can_touch(robot.name)
        for sensor in robot.figure.sensors
    ]
    now = Marked(view.room.marked.robot, view.room.marked.sensor)
    if not stops:
        return None
    number = stops.index(now) + step if now in stops else (0 if step > 0 else len(stops) - 1)
    return stops[number] if 0 <= number < len(stops) else None
