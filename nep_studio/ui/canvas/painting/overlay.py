"""What is drawn over the blocks and changes often: selection, focus, hits, glow, badges."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen

from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.ui.canvas.layout.boxes import Box
from nep_studio.ui.canvas.layout.page import Placed

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


FEW = 4
"""Up to so many blocks it is faster to look for each than through all that can be seen."""

MANY = 300
"""Selected blocks in view from which on their outlines are not followed."""


STACKED = ("statement", "hat")
"""Below blocks of these outlines others can be."""


class Overlay(Protocol):
    """Something drawn over the page each time the view is painted, in canvas units."""

    def paint(self, painter: QPainter, view: CanvasHost) -> None:
        """Draw it."""


class SelectionOverlay:
    """One line around all selected blocks that follow each other, and around the keyboard's.

    The keyboard's block is selected most of the time: then the same line says both.
    """

    def __init__(self) -> None:
        self._places: list[tuple[float, float]] = []
        self._boxes: list[Box] = []
        self._path = QPainterPath()

    def paint(self, painter: QPainter, view: CanvasHost) -> None:
        """Draw the lines, for the blocks in view."""
        pixel, colour = 1.0 / view.sight.camera.scale, view.look.theme.colour("focus")
        selected, layout = view.selection, view.page_layout
        if len(selected.ids) <= FEW:
            shown = (layout.placed(i) for i in selected.ids if i not in layout.layout.hidden)
            blocks = [placed for placed in shown if placed is not None]
        else:  # of many only those that can be seen
            seen = layout.boxes(view.sight.visible_page_rect())
            blocks = [placed for placed in seen if placed.box.block in selected]
        if len(blocks) <= MANY:
            painter.setPen(QPen(colour, 2.5 * pixel))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawPath(self._outline(view, blocks))
        else:
            rings(painter, view, blocks, colour, 2.5 * pixel)
        is_apart = selected.cursor not in selected and view.area.hasFocus()
        placed = layout.placed(selected.cursor) if is_apart else None
        if placed is not None:
            painter.setPen(QPen(colour, 2 * pixel, Qt.PenStyle.DashLine))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            around = QRectF(*placed.rect.grown(5 * pixel))
            painter.drawRoundedRect(around, 6 * pixel, 6 * pixel)

    def _outline(self, view: CanvasHost, blocks: list[Placed]) -> QPainterPath:
        """The outline of blocks together: made again when one of them has changed or moved."""
        known = [(placed.x, placed.y) for placed in blocks]
        is_same = known == self._places and all(
            placed.box is box for placed, box in zip(blocks, self._boxes, strict=True)
        )
        if not is_same:
            self._places, self._boxes = known, [placed.box for placed in blocks]
            self._path = _together(view, blocks)
        return self._path


def _together(view: CanvasHost, blocks: list[Placed]) -> QPainterPath:
    """The outline of blocks, without lines where one follows on another."""
    outlines, corner = view.look.block_painter.outlines, view.look.measures.corner
    path = QPainterPath()
    path.setFillRule(Qt.FillRule.WindingFill)
    tops = {_at(placed, placed.y): placed for placed in blocks}
    for placed in blocks:
        path.addPath(outlines.of(placed.box).translated(placed.x, placed.y))
        below = tops.get(_at(placed, placed.y + placed.box.height))
        if below is not None and placed.box.outline in STACKED:
            # A bridge over the seam, which is a line without width
            width = min(placed.box.width, below.box.width)
            left = placed.x + placed.box.width - width if placed.box.is_mirrored else placed.x
            path.addRect(QRectF(left, below.y - corner, width, 2 * corner))
    return path.simplified() if len(blocks) > 1 else path


def _at(placed: Placed, y: float) -> tuple[float, float]:
    """A height at the side where the blocks of a chain begin."""
    x = placed.x + placed.box.width if placed.box.is_mirrored else placed.x
    return round(x, 1), round(y, 1)


def rings(
    painter: QPainter, view: CanvasHost, blocks: list[Placed], colour: QColor, width: float
) -> None:
    """Lines around blocks; around very many, which are small then, plain rectangles."""
    painter.setPen(QPen(colour, width))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    if len(blocks) <= MANY:
        for placed in blocks:
            painter.translate(placed.x, placed.y)
            painter.drawPath(view.look.block_painter.outlines.of(placed.box))
            painter.translate(-placed.x, -placed.y)
        return
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    painter.drawRects([QRectF(*placed.rect) for placed in blocks])
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)


class ProblemOverlay:
    """A badge at the corner of every block that has a problem."""

    def __init__(self) -> None:
        self.problems: Mapping[str, Diagnostic] = {}

    def show(self, problems: Iterable[Diagnostic]) -> None:
        """Show these; of several at a block, the worst."""
        order = {"info": 0, "warning": 1, "error": 2}
        worst: dict[str, Diagnostic] = {}
        for problem in problems:
            known = worst.get(problem.block)
            if problem.block and (known is None or order[known.severity] < order[problem.severity]):
                worst[problem.block] = problem
        self.problems = worst

    def paint(self, painter: QPainter, view: CanvasHost) -> None:
        """Draw the badges of the blocks in view."""
        if not self.problems:
            return
        for placed in view.page_layout.boxes(view.sight.visible_page_rect()):
            problem = self.problems.get(placed.box.block)
            if problem is not None:
                _badge(painter, badge_rect(placed, view), problem, view)


def badge_rect(placed: Placed, view: CanvasHost) -> QRectF:
    """Where the badge of a block is: at its far upper corner, half outside."""
    size = 20 * view.look.measures.unit
    is_mirrored = placed.box.is_mirrored
    x = placed.x - size / 2 if is_mirrored else placed.x + placed.box.width - size / 2
    return QRectF(x, placed.y - size / 3, size, size)


_SIGNS = {"error": "!", "warning": "!", "info": "i"}


def _badge(painter: QPainter, rect: QRectF, problem: Diagnostic, view: CanvasHost) -> None:
    """A round, a pointed or a square badge: the shape says how bad it is."""
    painter.setPen(QPen(view.look.theme.colour("canvas"), 1.5 * view.look.measures.unit))
    painter.setBrush(view.look.theme.colour(problem.severity))
    if problem.severity == "warning":
        top = QPointF(rect.center().x(), rect.top())
        painter.drawPolygon([top, rect.bottomRight(), rect.bottomLeft()])
    elif problem.severity == "error":
        painter.drawEllipse(rect)
    else:
        painter.drawRoundedRect(rect, 4, 4)
    painter.setPen(view.look.theme.colour("canvas"))
    sign = rect.adjusted(0, rect.height() * 0.15 * (problem.severity == "warning"), 0, 0)
    painter.setFont(view.look.badge_font)
    painter.drawText(sign, Qt.AlignmentFlag.AlignCenter, _SIGNS[problem.severity])
