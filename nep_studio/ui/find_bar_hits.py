"""The overlay that marks what was found."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtGui import QPainter

from nep_studio.ui.canvas.overlay import ring
from nep_studio.ui.canvas.view import PageView


class HitOverlay:
    """A broad line around each found block in view, and a broader one around the current."""

    def __init__(self) -> None:
        self._ids: frozenset[str] = frozenset()
        self._current = ""

    def show(self, ids: Sequence[str], current: str) -> None:
        """Mark these."""
        self._ids, self._current = frozenset(ids), current

    def paint(self, painter: QPainter, view: PageView) -> None:
        """Draw the lines; only blocks in view are looked at, however many were found."""
        if not self._ids:
            return
        colour = view.theme.colour("search_hit")
        pixel = 1 / view.camera.scale
        shown = [placed.box.block for placed in view.page_layout.boxes(view.visible_page_rect())]
        for block in shown:
            if block in self._ids:
                ring(painter, view, block, colour, 4 * pixel)
        if self._current in self._ids:
            ring(painter, view, self._current, view.theme.colour("focus"), 9 * pixel)
            ring(painter, view, self._current, colour, 5 * pixel)
