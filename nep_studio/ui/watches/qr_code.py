"""A QR code, drawn in whole pixels of the screen so that every camera reads it."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRect, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

QUIET = 4
"""So many modules of white are around a code: the standard asks for them."""
LINES_WIDE = 13
FEWEST_PIXELS = 3
"""A module of fewer pixels is hard to read from a screen."""

Modules = Sequence[Sequence[int]]


class QrCode(QWidget):
    """Black on white in every theme: cameras do not all read a code in other colours."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.url = ""
        self._modules: Modules = ()
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)

    def show_url(self, url: str) -> None:
        """Show the code of an address; "" shows none."""
        if url == self.url:
            return
        self.url = url
        self._modules = modules_of(url) if url else ()
        self.setAccessibleName(url)
        self.setToolTip(url)
        self.updateGeometry()
        self.update()

    def sizeHint(self) -> QSize:
        """Large enough for a camera that is an arm's length away."""
        side = max(self.fontMetrics().height() * LINES_WIDE, self.minimumSizeHint().width())
        return QSize(side, side)

    def minimumSizeHint(self) -> QSize:
        """What can still be read."""
        side = (len(self._modules) + 2 * QUIET) * FEWEST_PIXELS
        return QSize(side, side)

    def module_pixels(self) -> int:
        """How many pixels of the screen one module is wide."""
        pixels = min(self.width(), self.height()) * self.devicePixelRatioF()
        return max(1, int(pixels / (len(self._modules) + 2 * QUIET)))

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw it in the middle."""
        if not self._modules:
            return
        painter = QPainter(self)
        ratio = self.devicePixelRatioF()
        painter.scale(1 / ratio, 1 / ratio)
        module = self.module_pixels()
        side = (len(self._modules) + 2 * QUIET) * module
        left = (round(self.width() * ratio) - side) // 2
        top = (round(self.height() * ratio) - side) // 2
        painter.fillRect(QRect(left, top, side, side), Qt.GlobalColor.white)
        for y, row in enumerate(self._modules, QUIET):
            for x, is_dark in enumerate(row, QUIET):
                if is_dark:
                    place = QRect(left + x * module, top + y * module, module, module)
                    painter.fillRect(place, Qt.GlobalColor.black)
        painter.end()


def modules_of(url: str) -> Modules:
    """The modules of the code of an address, row by row; 1 is dark."""
    import segno

    return [list(row) for row in segno.make(url, error="m", micro=False).matrix]
