"""The view follows the block that runs: it glides there when nobody is busy on the canvas."""

from __future__ import annotations

import time
from collections.abc import Collection
from typing import TYPE_CHECKING

from PySide6.QtCore import QEasingCurve, QObject, QPointF, QTimer, QVariantAnimation

from .layout.index import Rect
from .layout.page import Placed

if TYPE_CHECKING:
    from .host import CanvasHost

GLIDE_MS = 260
"""How long the view is on its way."""

REST_MS = 700
"""How long it stays there at least: blocks may run faster than anybody can look."""

QUIET_S = 3.0
"""How long a person who has moved the view is left alone."""

MARGIN = 0.2
"""How much of the view is left around a block that it goes to: the next ones are seen, too."""


class Following(QObject):
    """Moves the view of one canvas to running blocks that are out of sight.

    Not while a person drags, types in a field, or has just moved the view.
    """

    def __init__(self, host: CanvasHost) -> None:
        super().__init__(host.area)
        self.is_on = True
        """Whether a person wants it."""
        self._host = host
        self._blocks: Collection[str] = ()
        self._quiet_until_s = 0.0
        self._is_ours = False
        self._start = self._end = QPointF()
        self._glide = QVariantAnimation(self, startValue=0.0, endValue=1.0, duration=GLIDE_MS)
        self._glide.setEasingCurve(QEasingCurve.Type.InOutCubic)
        self._glide.valueChanged.connect(self._on_glide)
        self._rest = QTimer(self, singleShot=True, interval=GLIDE_MS + REST_MS)
        self._rest.timeout.connect(self._go)
        host.news.view_changed.connect(self._on_view_changed)

    def follow(self, blocks: Collection[str]) -> None:
        """These blocks run now; none does when there are none."""
        self._blocks = blocks
        if not self._rest.isActive():
            self._go()

    def _go(self) -> None:
        """Begin to glide, if no running block is seen and nobody is busy."""
        host = self._host
        if not self.is_on or not self._blocks or not host.area.isVisible():
            return
        if self._is_busy():
            self._rest.start()  # perhaps it runs still when the person rests
            return
        found = [placed for one in self._blocks if (placed := host.page_layout.placed(one))]
        seen = host.sight.visible_page_rect()
        if not found or any(_is_inside(self._head(placed), seen) for placed in found):
            return
        camera, rect = host.sight.camera, self._head(found[0])
        self._start = QPointF(camera.x, camera.y)
        self._end = self._start + QPointF(
            _way(seen.x, seen.width, rect.x, rect.width),
            _way(seen.y, seen.height, rect.y, rect.height),
        )
        self._glide.start()
        self._rest.start()

    def _is_busy(self) -> bool:
        host = self._host
        is_typing = host.fields.place is not None or host.notes.writing is not None
        is_quiet = time.monotonic() < self._quiet_until_s
        return is_quiet or is_typing or host.pointing.gesture is not None

    def _head(self, placed: Placed) -> Rect:
        """The first row of a block, which is what a person looks for."""
        x, y, width, height = placed.rect
        return Rect(x, y, width, min(height, self._host.look.measures.row_height))

    def _on_glide(self, share: float) -> None:
        if self._host.pointing.gesture is not None:
            self._glide.stop()
            return
        at = self._start + (self._end - self._start) * share
        self._is_ours = True
        self._host.sight.move_camera(at.x(), at.y())
        self._is_ours = False

    def _on_view_changed(self) -> None:
        if not self._is_ours:
            self._glide.stop()
            self._quiet_until_s = time.monotonic() + QUIET_S


def _is_inside(rect: Rect, seen: Rect) -> bool:
    """Whether the beginning of a row is seen, at its left or, of a mirrored one, at its right."""
    is_high = seen.y <= rect.y and rect.bottom <= seen.bottom
    return is_high and rect.x < seen.right and seen.x < rect.right


def _way(low: float, length: float, start: float, size: float) -> float:
    """How far a view moves to what is out of it: so that some of what follows is seen, too."""
    margin = min(MARGIN * length, max(0.0, (length - size) / 2))
    if start < low or size > length:
        return start - margin - low
    is_out = start + size > low + length
    return start + size + margin - low - length if is_out else 0.0
