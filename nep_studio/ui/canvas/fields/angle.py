"""An angle: a dial to turn, and the number of degrees."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.words import tr

from .field_edit import Editing
from .number import NumberPopup

if TYPE_CHECKING:
    from .editors import FieldEditors

SNAP_DEGREES = 15


def angle_at(x: float, y: float, *, is_free: bool) -> float:
    """The degrees of a place around the middle of a dial: 0 is ahead (up), left is positive.

    Angles are from -180 to 180, in steps of 15 unless ``is_free``.
    """
    degrees = math.degrees(math.atan2(-x, -y))
    step = 1 if is_free else SNAP_DEGREES
    snapped = round(degrees / step) * step
    return 180 if snapped == -180 else snapped


class Dial(QWidget):
    """A circle with a hand that is turned with the mouse."""

    def __init__(self, theme: Theme, side: int, turned: Callable[[float], None]) -> None:
        super().__init__()
        self._theme, self._side, self._turned = theme, side, turned
        self._degrees = 0.0
        self.setFixedSize(QSize(side, side))
        self.setCursor(Qt.CursorShape.CrossCursor)

    def show_angle(self, degrees: float) -> None:
        """Turn the hand."""
        self._degrees = degrees
        self.setAccessibleName(tr("{n} degrees", n=f"{degrees:g}"))
        self.update()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Turn the hand to where it was pressed."""
        self.mouseMoveEvent(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Turn the hand with the mouse: in steps of 15 degrees, with Shift freely."""
        from_middle = event.position() - QPointF(self._side / 2, self._side / 2)
        is_free = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        if math.hypot(from_middle.x(), from_middle.y()) > 3:
            self._turned(angle_at(from_middle.x(), from_middle.y(), is_free=is_free))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the circle, its marks, the angle as a slice, and the hand."""
        side, theme = self._side, self._theme
        edge = side / 40
        circle = QRectF(edge, edge, side - 2 * edge, side - 2 * edge)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QPen(theme.colour("field_line"), edge))
            painter.setBrush(theme.colour("field"))
            painter.drawEllipse(circle)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.colour("selection"))
            shown = math.copysign(min(abs(self._degrees), 360), self._degrees)
            painter.drawPie(circle.adjusted(edge, edge, -edge, -edge), 90 * 16, round(shown * 16))
            painter.setPen(QPen(self._theme.colour("field_line"), edge / 2))
            for degrees in range(0, 360, SNAP_DEGREES):
                length = 0.12 if degrees % 90 == 0 else 0.06
                painter.drawLine(self._at(degrees, 0.93 - length), self._at(degrees, 0.93))
            colour = self._theme.colour("accent")
            painter.setPen(QPen(colour, 1.6 * edge, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
            end = self._at(self._degrees, 0.78)
            painter.drawLine(QPointF(self._side / 2, self._side / 2), end)
            painter.setBrush(colour)
            painter.drawEllipse(end, 2.6 * edge, 2.6 * edge)

    def _at(self, degrees: float, share: float) -> QPointF:
        radius, angle = self._side / 2 * share, math.radians(degrees)
        middle = self._side / 2
        return QPointF(middle - radius * math.sin(angle), middle - radius * math.cos(angle))


class AnglePopup(NumberPopup):
    """Degrees, typed or turned."""

    unit = "°"

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        self.dial = Dial(editors.canvas.look.theme, 8 * self.line, self.point)
        self.column.addWidget(self.dial, 0, Qt.AlignmentFlag.AlignHCenter)
        self.show_number()

    def show_number(self) -> None:
        """Turn the hand to the number."""
        self.dial.show_angle(self.now)
