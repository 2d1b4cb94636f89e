"""Moves the chosen thing with keys, and notices when one that was dragged is put down."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt, QTimer, Signal
from PySide6.QtGui import QKeyEvent

from nep_core.messages import Thing
from nep_studio.surroundings import moved, turned

if TYPE_CHECKING:
    from nep_studio.ui.robot_view.view import RobotView

STEP_M, SMALL_STEP_M = 0.1, 0.02
STEP_RAD = math.radians(15)
ARROWS = {
    Qt.Key.Key_Left: math.pi / 2,
    Qt.Key.Key_Right: -math.pi / 2,
    Qt.Key.Key_Up: 0.0,
    Qt.Key.Key_Down: math.pi,
}
"""Where keys move a thing, from the direction in which one looks."""
REMOVING = (Qt.Key.Key_Delete, Qt.Key.Key_Backspace)


TURNING = {Qt.Key.Key_Comma: STEP_RAD, Qt.Key.Key_Period: -STEP_RAD}
MEANT = (*ARROWS, *REMOVING, *TURNING, Qt.Key.Key_Escape)
"""The keys that are for the chosen thing."""


class StageKeys(QObject):
    """Watches a view: ``changed`` gives a thing as it is after a key, ``removed``, ``left``.

    ``put_down`` tells that a mouse button was let go.
    """

    changed = Signal(object)
    removed = Signal()
    left = Signal()
    put_down = Signal()

    def __init__(self, view: RobotView) -> None:
        super().__init__(view)
        self._view = view
        self.chosen: Thing | None = None
        view.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Take keys that are meant for the chosen thing."""
        if event.type() == QEvent.Type.MouseButtonRelease:
            QTimer.singleShot(0, self, self.put_down.emit)  # after the view has seen it
        if isinstance(event, QKeyEvent) and self.chosen is not None and self._take(event):
            return True
        return super().eventFilter(watched, event)

    def _take(self, event: QKeyEvent) -> bool:
        """Take a key for the chosen thing; whether it is meant for that."""
        if self.chosen is None or event.key() not in MEANT or _is_command(event):
            return False
        if event.type() == QEvent.Type.ShortcutOverride:
            event.accept()  # else Delete would delete blocks
        elif event.type() == QEvent.Type.KeyPress:
            self._press(self.chosen, event)
        return True

    def _press(self, thing: Thing, event: QKeyEvent) -> None:
        key, is_small = Qt.Key(event.key()), event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        if key in ARROWS:
            way_m = SMALL_STEP_M if is_small else STEP_M
            angle = self._view.camera.yaw + math.pi + ARROWS[key]
            x, y = (
                thing.place[0] + way_m * math.cos(angle),
                thing.place[1] + way_m * math.sin(angle),
            )
            self.changed.emit(moved(thing, x, y))
        elif key in TURNING:
            self.changed.emit(turned(thing, thing.heading + TURNING[key]))
        elif key in REMOVING:
            self.removed.emit()
        else:
            self.left.emit()


def _is_command(event: QKeyEvent) -> bool:
    """Whether a key is a shortcut of the window, such as Ctrl and a key."""
    plain = Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.KeypadModifier
    return bool(event.modifiers() & ~plain)
