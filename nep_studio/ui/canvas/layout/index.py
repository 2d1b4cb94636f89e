"""Which stacks are near a place: a grid of squares, each with the stacks that touch it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import hypot
from typing import NamedTuple

from PySide6.QtCore import QPointF, QRectF

SQUARE = 512.0
"""How wide a square of the grid is, in canvas units."""

MOST_SQUARES = 400
"""A stack that touches more squares is kept apart, and looked at each time."""


class Rect(NamedTuple):
    """A rectangle in canvas units."""

    x: float
    y: float
    width: float
    height: float

    @property
    def right(self) -> float:
        """Its right side."""
        return self.x + self.width

    @property
    def bottom(self) -> float:
        """Its lower side."""
        return self.y + self.height

    def touches(self, other: Rect) -> bool:
        """Whether the two have a point in common."""
        x, y, width, height = other
        return (
            self.x <= x + width
            and x <= self.x + self.width
            and self.y <= y + height
            and y <= self.y + self.height
        )

    def holds(self, x: float, y: float) -> bool:
        """Whether a point is inside."""
        return self.x <= x <= self.right and self.y <= y <= self.bottom

    def distance(self, x: float, y: float) -> float:
        """How far a point is from it: 0 inside."""
        dx, dy = max(self.x - x, 0.0, x - self.right), max(self.y - y, 0.0, y - self.bottom)
        return hypot(dx, dy)

    def grown(self, by: float) -> Rect:
        """This rectangle with a margin on all sides."""
        return Rect(self.x - by, self.y - by, self.width + 2 * by, self.height + 2 * by)

    def intersected(self, other: Rect) -> Rect:
        """What both have in common; they must touch."""
        x, y = max(self.x, other.x), max(self.y, other.y)
        right, bottom = min(self.right, other.right), min(self.bottom, other.bottom)
        return Rect(x, y, right - x, bottom - y)

    def united(self, other: Rect) -> Rect:
        """The smallest rectangle around both."""
        x, y = min(self.x, other.x), min(self.y, other.y)
        right = max(self.x + self.width, other.x + other.width)
        bottom = max(self.y + self.height, other.y + other.height)
        return Rect(x, y, right - x, bottom - y)


Square = tuple[int, int]


class GridIndex:
    """Rectangles by name."""

    def __init__(self) -> None:
        self.rects: dict[str, Rect] = {}
        """To be read: ``set`` and ``remove`` change it."""
        self._squares: dict[Square, dict[str, None]] = {}
        self._large: dict[str, None] = {}

    def clear(self) -> None:
        """Forget all."""
        self.rects.clear()
        self._squares.clear()
        self._large.clear()

    def set(self, name: str, rect: Rect) -> None:
        """Put a rectangle in, or put it elsewhere."""
        self.remove(name)
        self.rects[name] = rect
        squares = _squares(rect)
        if len(squares) > MOST_SQUARES:
            self._large[name] = None
            return
        for square in squares:
            self._squares.setdefault(square, {})[name] = None

    def remove(self, name: str) -> None:
        """Take a rectangle out, if it is there."""
        rect = self.rects.pop(name, None)
        if rect is None:
            return
        if name in self._large:
            del self._large[name]
            return
        for square in _squares(rect):
            names = self._squares[square]
            del names[name]
            if not names:
                del self._squares[square]

    def near(self, rect: Rect) -> Iterator[str]:
        """The names whose rectangles touch this one."""
        found = dict(self._large)
        squares = _squares(rect)
        if len(squares) > len(self._squares):
            found.update(dict.fromkeys(self.rects))
        else:
            for square in squares:
                found.update(self._squares.get(square, {}))
        return (name for name in found if self.rects[name].touches(rect))

    def bounds(self) -> Rect | None:
        """The rectangle around all of them, or None when there is none."""
        rects = self.rects.values()
        if not rects:
            return None
        x, y = min(r.x for r in rects), min(r.y for r in rects)
        right, bottom = max(r.x + r.width for r in rects), max(r.y + r.height for r in rects)
        return Rect(x, y, right - x, bottom - y)


def _squares(rect: Rect) -> list[Square]:
    first_x, last_x = int(rect.x // SQUARE), int((rect.x + rect.width) // SQUARE)
    first_y, last_y = int(rect.y // SQUARE), int((rect.y + rect.height) // SQUARE)
    if (last_x - first_x + 1) * (last_y - first_y + 1) > 2 * MOST_SQUARES:
        last_y = first_y + 2 * MOST_SQUARES  # enough to be seen as large
        last_x = first_x
    return [(x, y) for x in range(first_x, last_x + 1) for y in range(first_y, last_y + 1)]


# Where the person looks: which part of the page is in the view, and how large.

SMALLEST, LARGEST = 0.1, 4.0
"""How far out and in a person can zoom."""


@dataclass
class Camera:
    """``x`` and ``y`` are the canvas place at the view's top left corner."""

    x: float = 0.0
    y: float = 0.0
    scale: float = 1.0

    def to_page(self, point: QPointF) -> QPointF:
        """A point of the view, in pixels, on the page."""
        return QPointF(point.x() / self.scale + self.x, point.y() / self.scale + self.y)

    def to_view(self, x: float, y: float) -> QPointF:
        """A point of the page in the view."""
        return QPointF((x - self.x) * self.scale, (y - self.y) * self.scale)

    def view_rect(self, rect: Rect) -> QRectF:
        """A rectangle of the page in the view."""
        x, y, width, height = rect
        scale = self.scale
        return QRectF((x - self.x) * scale, (y - self.y) * scale, width * scale, height * scale)

    def page_rect(self, rect: QRectF) -> Rect:
        """A rectangle of the view on the page."""
        scale = self.scale
        x, y = rect.x() / scale + self.x, rect.y() / scale + self.y
        return Rect(x, y, rect.width() / scale, rect.height() / scale)

    def zoom_at(self, point: QPointF, scale: float) -> None:
        """Zoom so that what is under a point of the view stays there."""
        before = self.to_page(point)
        self.scale = min(max(scale, SMALLEST), LARGEST)
        self.x = before.x() - point.x() / self.scale
        self.y = before.y() - point.y() / self.scale

    def align(self, ratio: float) -> None:
        """Put the corner on a whole device pixel, so that a scrolled picture stays sharp."""
        step = self.scale * ratio
        self.x = round(self.x * step) / step
        self.y = round(self.y * step) / step
