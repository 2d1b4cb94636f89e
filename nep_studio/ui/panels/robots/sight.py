"""Keeps robots in sight that fall or are put elsewhere, as long as nobody looks closer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

if TYPE_CHECKING:
    from nep_studio.ui.robot_view.view import RobotView

LOOK_MS = 600
Looking = tuple[float, float, float]


class Sight(QObject):
    """Looks now and then whether all that was seen is seen still; if not, all is seen again.

    What a person has zoomed into, or turned away from, stays as it is.
    """

    def __init__(self, view: RobotView) -> None:
        super().__init__(view)
        self._view = view
        self._seen_by: Looking | None = None
        self._timer = QTimer(self, singleShot=True, interval=LOOK_MS)
        self._timer.timeout.connect(self.look)

    def look_soon(self) -> None:
        """Something may have moved."""
        if not self._timer.isActive():
            self._timer.start()

    def look(self) -> None:
        """See all again if a robot has left the picture by itself."""
        view = self._view
        if self._is_all_seen():
            self._seen_by = self._looking()
        elif view.follows and self._seen_by == self._looking():
            view.fit()
            self._seen_by = self._looking()

    def _looking(self) -> Looking:
        camera = self._view.camera
        return camera.yaw, camera.pitch, camera.distance

    def _is_all_seen(self) -> bool:
        view = self._view
        for robot in view.room.scene().robots:
            pixels = view.lens.project(robot.placed.corners())
            low, high = pixels.min(axis=0), pixels.max(axis=0)
            if min(low) < 0 or high[0] > view.width() or high[1] > view.height():
                return False
        return True
