"""What is drawn over the blocks and changes often: selection, focus, hits, glow, badges."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.ui.canvas.layout.page import Placed

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


FEW = 4
"""Up to so many blocks it is faster to look for each than through all that can be seen."""

MANY = 300
"""Selected blocks in view from which on their outlines are not followed."""


class Overlay(Protocol):
    """Something drawn over the page each time the view is painted, in canvas units."""

    def paint(self, painter: QPainter, view: CanvasHost) -> None:
        """Draw it."""


class SelectionOverlay:
    """A line around every selected block, and a second one around the keyboard's."""

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
        rings(painter, view, blocks, colour, 2.5 * pixel)
        placed = layout.placed(selected.cursor) if view.area.hasFocus() else None
        if placed is not None:
            painter.setPen(QPen(colour, 2 * pixel, Qt.PenStyle.DashLine))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            around = QRectF(*placed.rect.grown(5 * pixel))
            painter.drawRoundedRect(around, 6 * pixel, 6 * pixel)


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
