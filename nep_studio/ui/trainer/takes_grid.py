"""Where the takes of one gesture are: their places in rows, and the way of the arrow keys."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPoint, QRect, Qt

WIDE_LINES, HIGH_LINES, GAP_LINES = 4.6, 3.4, 0.35


@dataclass(frozen=True)
class Grid:
    """Cells for ``count`` takes in a room so many pixels wide."""

    count: int
    width: int
    line: int
    is_mirrored: bool = False

    @property
    def gap(self) -> int:
        """The room between two cells."""
        return max(2, round(self.line * GAP_LINES))

    @property
    def cell(self) -> tuple[int, int]:
        """How large a cell is; a narrow room has narrow cells."""
        wide = min(round(self.line * WIDE_LINES), max(1, self.width - 2 * self.gap))
        return wide, round(self.line * HIGH_LINES)

    @property
    def columns(self) -> int:
        """How many are beside each other."""
        return max(1, (self.width - self.gap) // (self.cell[0] + self.gap))

    @property
    def height(self) -> int:
        """How high all rows are."""
        rows = -(-self.count // self.columns)
        return rows * (self.cell[1] + self.gap) + self.gap if rows else 0

    def rect(self, number: int) -> QRect:
        """Where a take is."""
        wide, high = self.cell
        column, row = number % self.columns, number // self.columns
        x = self.gap + column * (wide + self.gap)
        if self.is_mirrored:
            x = self.width - x - wide
        return QRect(x, self.gap + row * (high + self.gap), wide, high)

    def at(self, place: QPoint) -> int:
        """The take at a place, or -1."""
        return next((n for n in range(self.count) if self.rect(n).contains(place)), -1)

    def beside(self, number: int, key: Qt.Key) -> int:
        """The take that an arrow key leads to from another; -1 where there is none."""
        forth = -1 if self.is_mirrored else 1
        steps = {
            Qt.Key.Key_Right: forth,
            Qt.Key.Key_Left: -forth,
            Qt.Key.Key_Down: self.columns,
            Qt.Key.Key_Up: -self.columns,
        }
        if key not in steps or not self.count:
            return -1
        if number < 0:
            return 0
        reached = number + steps[key]
        return reached if 0 <= reached < self.count else -1
