"""The suggestions of the insert bar, painted as the blocks that they are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QPoint, QPointF, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QFontInfo, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from nep_studio.blocks.operations.copying import Clip
from nep_studio.ui.canvas.block_painter import BlockPainter
from nep_studio.ui.canvas.boxes import Chain
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.index import Rect
from nep_studio.ui.canvas.layout import Layout
from nep_studio.ui.canvas.page import boxes_of
from nep_studio.ui.palette.accessible_list import make_list_accessible, tell_current
from nep_studio.ui.words import tr

SCALE = 0.85
"""How large blocks are in the list beside those of the canvas at its usual size."""

HIGHEST_ROW = 150.0
"""How much of a suggestion is shown, in units of the measures."""

EVERYWHERE = Rect(-1e6, -1e6, 2e6, 2e6)


@dataclass
class Row:
    """A suggestion: its blocks, laid out, and its sentence."""

    clip: Clip
    label: str
    chain: Chain
    y: float = 0.0
    height: float = 0.0


class SuggestionList(QWidget):
    """Shows suggestions, the best first; ``chosen`` says that one was clicked."""

    chosen = Signal(int)

    def __init__(self, canvas: Canvas, parent: QWidget) -> None:
        super().__init__(parent)
        self._canvas = canvas
        self.rows: list[Row] = []
        self._scale = SCALE
        self.current = 0
        self.accessible: object = None
        self.setMouseTracking(True)
        self.setAccessibleName(tr("Suggestions"))
        make_list_accessible(self, self)

    def show_clips(self, clips: Sequence[tuple[Clip, str]]) -> None:
        """Show these blocks with their sentences, and point at the first."""
        measures = self._canvas.measures
        self._painter = BlockPainter(
            self._canvas.theme, self._canvas.editor.language, measures, self._canvas.block_font
        )
        size = QFontInfo(self.font()).pixelSize() / QFontInfo(self._canvas.block_font).pixelSize()
        self._scale = SCALE * size
        self.rows, self.current = [], 0
        y, gap = 4.0, measures.line * 0.35
        for clip, label in clips:
            layout = Layout(clip.project, self._canvas.editor.language, measures)
            row = Row(clip, label, layout.chain(clip.roots[0]), y)
            whole = (row.chain.height + measures.notch_depth) * self._scale
            row.height = min(whole, HIGHEST_ROW * measures.unit * size) + gap
            y += row.height
            self.rows.append(row)
        self.updateGeometry()
        self.update()

    def sizeHint(self) -> QSize:
        """As large as the blocks."""
        widest = max((row.chain.width * self._scale for row in self.rows), default=200.0)
        last = self.rows[-1] if self.rows else None
        return QSize(round(widest) + 24, round(last.y + last.height + 4) if last else 0)

    def go(self, step: int) -> None:
        """Point at the next suggestion, or the one before."""
        if self.rows:
            self.current = (self.current + step) % len(self.rows)
            self.update()
            tell_current(self)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the rows."""
        theme, is_mirrored = self._canvas.theme, self._canvas.measures.is_mirrored
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            for number, row in enumerate(self.rows):
                rect = self._rect(row)
                if number == self.current:
                    painter.setPen(QPen(theme.colour("focus"), 2))
                    painter.setBrush(theme.colour("selection"))
                    painter.drawRoundedRect(rect.adjusted(2, 1, -2, -1), 7, 7)
                painter.save()
                painter.setClipRect(rect)
                x = rect.right() - 12 if is_mirrored else 12.0
                painter.translate(QPointF(x, row.y + 4))
                painter.scale(self._scale, self._scale)
                self._painter.paint(painter, boxes_of(row.chain, EVERYWHERE), self._scale)
                painter.restore()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Point at what is under the mouse."""
        number = self._row_at(event.position())
        if number >= 0 and number != self.current:
            self.current = number
            self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Choose what is clicked."""
        number = self._row_at(event.position())
        if number >= 0 and event.button() == Qt.MouseButton.LeftButton:
            self.chosen.emit(number)

    def event(self, event: QEvent) -> bool:
        """Show the whole sentence of a suggestion that is cut."""
        if event.type() == QEvent.Type.ToolTip and self.rows:
            self.setToolTip(self.rows[self.current].label)
        return super().event(event)

    def _rect(self, row: Row) -> QRectF:
        return QRectF(0, row.y, self.width(), row.height)

    def _row_at(self, point: QPointF) -> int:
        found = (n for n, row in enumerate(self.rows) if self._rect(row).contains(point))
        return next(found, -1)

    # For screen readers

    def item_count(self) -> int:
        """How many suggestions there are."""
        return len(self.rows)

    def item_text(self, number: int) -> str:
        """What a suggestion says."""
        return self.rows[number].label

    def item_rect(self, number: int) -> QRect:
        """Where a suggestion is on the screen."""
        rect = self._rect(self.rows[number]).toAlignedRect()
        return QRect(self.mapToGlobal(QPoint(rect.x(), rect.y())), rect.size())

    def current_item(self) -> int:
        """The suggestion that is pointed at, or -1."""
        return self.current if self.rows else -1
