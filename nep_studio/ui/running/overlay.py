"""What a running program draws over the blocks: the glow, pauses, counts and values."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen

from nep_studio.ui.canvas.index import Rect
from nep_studio.ui.canvas.overlay import ring
from nep_studio.ui.canvas.page import Placed
from nep_studio.ui.canvas.view import PageView
from nep_studio.ui.words import tr

from .marks import Marks

HALO = ((14.0, 40), (9.0, 80), (4.0, 255))
"""Width in pixels and opacity of each line of the glow, the widest first."""

REACH = 260.0
"""How far beside a block its chips may reach, in canvas units of a line of text of 18."""


class RunOverlay:
    """Draws the marks of the blocks in view; ``names`` give each variable's Python name by id."""

    def __init__(self) -> None:
        self.marks = Marks()
        self.breakpoints: frozenset[str] = frozenset()
        self.names: dict[str, str] = {}

    def paint(self, painter: QPainter, view: PageView) -> None:
        """Draw them."""
        marks = self.marks
        for block in marks.around:
            ring(painter, view, block, _faded(view.theme.colour("glow"), 150), _px(view, 2.5))
        for block in marks.glowing:
            _glow(painter, view, block)
        known = (marks.counts, marks.values, marks.results, marks.paused)
        if not (self.breakpoints or any(known)):
            return
        paused = frozenset(marks.paused.values())
        for placed in view.page_layout.boxes(view.visible_page_rect()):
            block = placed.box.block
            if block in self.breakpoints:
                _dot(painter, view, placed, is_here=block in paused)
            elif block in paused:
                _pause_sign(painter, view, placed)
            if words := self._chip(view, block):
                _chip(painter, view, placed, words)

    def _chip(self, view: PageView, block: str) -> str:
        """The words beside a block: how often it fired, what its reporters or variable gave."""
        if (count := self.marks.counts.get(block, 0)) > 0:
            return tr("{n}\N{MULTIPLICATION SIGN}", n=count)
        if results := self.marks.results.get(block):
            return "   ".join(results.values())
        made = view.editor.project.blocks.get(block)
        if made is None or not self.marks.values or not made.type.startswith("variable."):
            return ""
        if made.type == "variable.get":
            return ""
        name = self.names.get(str(made.fields.get("variable", "")), "")
        return self.marks.values.get(name, "")


def touched(view: PageView, blocks: Iterable[str], *, with_chips: bool = False) -> None:
    """Let blocks with the glow around them be painted again, perhaps with what stands beside."""
    reach = REACH * view.measures.unit if with_chips else 20.0
    for block in blocks:
        placed = view.page_layout.placed(block)
        if placed is not None:
            x, y, width, height = placed.rect
            view.update_page(Rect(x - reach, y - 16, width + 2 * reach, height + 32))


def _glow(painter: QPainter, view: PageView, block: str) -> None:
    colour = view.theme.colour("glow")
    for width, opacity in HALO:
        ring(painter, view, block, _faded(colour, opacity), _px(view, width))


def _dot(painter: QPainter, view: PageView, placed: Placed, *, is_here: bool) -> None:
    """A breakpoint: a dot before the block, with a ring while the program waits there."""
    centre, size = _before(view, placed), 6.5 * view.measures.unit
    painter.setPen(QPen(view.theme.colour("canvas"), 1.5 * view.measures.unit))
    painter.setBrush(view.theme.colour("stop"))
    painter.drawEllipse(centre, size, size)
    if is_here:
        _bars(painter, view, centre, view.theme.colour("stop_text"))


def _pause_sign(painter: QPainter, view: PageView, placed: Placed) -> None:
    """The program waits here: two bars in a disc."""
    centre, size = _before(view, placed), 8 * view.measures.unit
    painter.setPen(QPen(view.theme.colour("canvas"), 1.5 * view.measures.unit))
    painter.setBrush(view.theme.colour("warning"))
    painter.drawEllipse(centre, size, size)
    _bars(painter, view, centre, view.theme.colour("canvas"))


def _bars(painter: QPainter, view: PageView, centre: QPointF, colour: QColor) -> None:
    unit = view.measures.unit
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    for side in (-1, 1):
        middle = centre.x() + side * 2 * unit
        painter.drawRect(QRectF(middle - unit * 0.9, centre.y() - 3 * unit, unit * 1.8, 6 * unit))


def _before(view: PageView, placed: Placed) -> QPointF:
    """The place before the first row of a block, where reading begins."""
    unit = view.measures.unit
    way = 12 * unit
    x = placed.x + placed.box.width + way if placed.box.is_mirrored else placed.x - way
    return QPointF(x, _first_row(placed, unit))


def _first_row(placed: Placed, unit: float) -> float:
    """The height of the middle of the first words of a block; those of a hat are below its cap."""
    if placed.box.outline == "hat":
        return placed.y + placed.box.height - 18 * unit
    return placed.y + 15 * unit


def _chip(painter: QPainter, view: PageView, placed: Placed, words: str) -> None:
    """A small label after the first row of a block."""
    unit = view.measures.unit
    metrics = QFontMetricsF(view.badge_font)
    wide = min(metrics.horizontalAdvance(words), (REACH - 40) * unit)
    height = metrics.height() + 4 * unit
    width = wide + 14 * unit
    gap = 10 * unit
    after = placed.x - gap - width if placed.box.is_mirrored else placed.x + placed.box.width + gap
    rect = QRectF(after, _first_row(placed, unit) - height / 2, width, height)
    painter.setPen(QPen(view.theme.colour("field_line"), unit))
    painter.setBrush(view.theme.colour("menu"))
    painter.drawRoundedRect(rect, height / 2, height / 2)
    painter.setPen(view.theme.colour("text"))
    painter.setFont(view.badge_font)
    shown = metrics.elidedText(words, Qt.TextElideMode.ElideRight, wide + unit)
    painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, shown)


def _px(view: PageView, width: float) -> float:
    """A width in pixels of the screen, in canvas units."""
    return width / view.camera.scale


def _faded(colour: QColor, opacity: int) -> QColor:
    faded = QColor(colour)
    faded.setAlpha(opacity)
    return faded
