"""Draws what was taken for what: a number and a shade in each cell, headings at a slant."""

from __future__ import annotations

import math
from collections.abc import Callable

from PySide6.QtCore import (
    QEvent,
    QModelIndex,
    QPersistentModelIndex,
    QPoint,
    QRect,
    QSize,
    Qt,
    Signal,
)
from PySide6.QtGui import QPainter, QPaintEvent, QPen, QResizeEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QSizePolicy,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableView,
    QWidget,
)

from nep_studio.ui.theme import Look
from nep_studio.ui.trainer.results.confusion import SHARE, Confusion
from nep_studio.ui.trainer.results.findings import Findings
from nep_studio.ui.trainer.results.shades import legible, mixed
from nep_studio.ui.words import tr

SLANT_DEGREES = 50.0
CELL_LINES, LEAST_CELL_LINES = 1.9, 1.4
"""How wide a cell is, in lines of text; narrower before the table has to be scrolled."""
MOST_HEADING_LINES = 7.0
MOST_ROWS_SHOWN = 12
_WEAKEST, _STRONGEST = 0.12, 0.85


class ConfusionView(QTableView):
    """``cell_chosen`` gives what was made and what was recognised: its takes are wanted."""

    cell_chosen = Signal(str, str)

    def __init__(
        self, title: Callable[[str], str], look: Look, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._look = look
        self.confusion = Confusion(title, self)
        self.setModel(self.confusion)
        self.headings = SlantedHeader(self)
        self.setHorizontalHeader(self.headings)
        self.setItemDelegate(_Cell(look, self))
        self.setAccessibleName(tr("What was taken for what: rows are made, columns recognised"))
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setTabKeyNavigation(False)  # Tab goes on to what follows, arrows go from cell to cell
        self.setShowGrid(False)
        self.setCornerButtonEnabled(False)
        self.clicked.connect(self._on_chosen)
        self.activated.connect(self._on_chosen)
        look.theme_changed.connect(self._fit)
        self._fit()

    def show_findings(self, findings: Findings | None) -> None:
        """Show the pairs of these findings."""
        self.confusion.show(findings)
        self._fit()

    def sizeHint(self) -> QSize:
        """High enough for its rows, up to a dozen of them."""
        rows = min(self.confusion.rowCount(), MOST_ROWS_SHOWN)
        cell = self._cell()
        bar = self.horizontalScrollBar().sizeHint().height()
        height = self.headings.sizeHint().height() + rows * cell + bar + 2 * self.frameWidth()
        return QSize(cell * 8, height)

    def minimumSizeHint(self) -> QSize:
        """As high, and rather narrow."""
        return QSize(self._cell() * 4, self.sizeHint().height())

    def changeEvent(self, event: QEvent) -> None:
        """Take another font."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self._fit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Make the columns as wide as there is room."""
        super().resizeEvent(event)
        self._fit_columns()

    def _cell(self) -> int:
        return round(self.fontMetrics().height() * CELL_LINES)

    def _fit_columns(self) -> None:
        line, count = self.fontMetrics().height(), max(1, self.confusion.columnCount())
        room = (self.viewport().width() - line) / count
        wide = round(min(max(room, line * LEAST_CELL_LINES), line * CELL_LINES))
        if self.headings.defaultSectionSize() != wide:
            self.headings.setMinimumSectionSize(wide)
            self.headings.setDefaultSectionSize(wide)

    def _fit(self, _theme: object = None) -> None:
        cell, rows = self._cell(), self.verticalHeader()
        for header in (self.headings, rows):
            header.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        rows.setMinimumSectionSize(cell)
        rows.setDefaultSectionSize(cell)
        self._fit_columns()
        widest = round(self.fontMetrics().height() * MOST_HEADING_LINES)
        rows.setMaximumWidth(widest)
        rows.setTextElideMode(Qt.TextElideMode.ElideRight)
        rows.setDefaultAlignment(Qt.AlignmentFlag.AlignLeading | Qt.AlignmentFlag.AlignVCenter)
        self.updateGeometry()
        self.viewport().update()

    def _on_chosen(self, index: QModelIndex) -> None:
        if index.isValid() and self.confusion.count(index):
            self.cell_chosen.emit(*self.confusion.pair(index))


class SlantedHeader(QHeaderView):
    """Headings that lean over the next ones: long words need no wide columns."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.setSectionsClickable(False)
        self.setHighlightSections(False)

    def sizeHint(self) -> QSize:
        """As high as the longest heading, within reason."""
        metrics = self.fontMetrics()
        widths = [metrics.horizontalAdvance(self._words(at)) for at in range(self.count())]
        most = metrics.height() * MOST_HEADING_LINES
        longest = min(max(widths, default=0), most)
        height = longest * math.sin(math.radians(SLANT_DEGREES)) + metrics.height() * 1.4
        return QSize(super().sizeHint().width(), round(height))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint all headings; each reaches over those after it."""
        painter = QPainter(self.viewport())
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.viewport().rect(), self.palette().window())
        painter.setPen(self.palette().windowText().color())
        metrics, is_mirrored = self.fontMetrics(), self.isRightToLeft()
        most = round(metrics.height() * MOST_HEADING_LINES)
        for at in range(self.count()):
            words = metrics.elidedText(self._words(at), Qt.TextElideMode.ElideRight, most)
            middle = self.sectionViewportPosition(at) + self.sectionSize(at) / 2
            painter.save()
            painter.translate(middle, self.height() - metrics.height() * 0.4)
            painter.rotate(SLANT_DEGREES if is_mirrored else -SLANT_DEGREES)
            wide = metrics.horizontalAdvance(words)
            painter.drawText(-wide if is_mirrored else 0, round(metrics.ascent() / 3), words)
            painter.restore()
        painter.end()

    def _words(self, section: int) -> str:
        return str(self.model().headerData(section, self.orientation()) or "")


class _Cell(QStyledItemDelegate):
    """Right ones blue, wrong ones orange with a mark: the stronger, the more of the row."""

    def __init__(self, look: Look, parent: QTableView) -> None:
        super().__init__(parent)
        self._look, self._view = look, parent

    def paint(
        self,
        painter: QPainter,
        option: QStyleOptionViewItem,
        index: QModelIndex | QPersistentModelIndex,
    ) -> None:
        """Paint a cell."""
        confusion, theme = index.model(), self._look.theme
        assert isinstance(confusion, Confusion)
        rect = QRect(option.rect).adjusted(1, 1, -1, -1)
        share, is_right = float(index.data(SHARE)), confusion.is_right(index)
        field = theme.colour("panel_alt" if is_right else "field")
        fill = field
        if share > 0:
            part = _WEAKEST + (_STRONGEST - _WEAKEST) * min(share, 1.0)
            fill = mixed(field, theme.colour("plot_1" if is_right else "plot_2"), part)
        painter.save()
        painter.fillRect(rect, fill)
        painter.setPen(QPen(theme.colour("line"), 1))
        painter.drawRect(rect)
        painter.setPen(legible(fill, theme.colour("text"), theme.colour("field")))
        if share > 0 and not is_right:
            self._mark(painter, rect)
        painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, str(index.data() or ""))
        if self._view.hasFocus() and self._view.currentIndex() == index:
            wide = max(2, self._view.fontMetrics().height() // 8)
            painter.setPen(QPen(theme.colour("focus"), wide))
            painter.drawRect(rect.adjusted(1, 1, -1, -1))
        painter.restore()

    def _mark(self, painter: QPainter, rect: QRect) -> None:
        """A corner, so that a mistake is not told by its colour alone."""
        size = max(4, rect.height() // 5)
        corner = rect.topRight()
        painter.save()
        painter.setBrush(painter.pen().color())
        painter.drawPolygon([corner, corner - QPoint(size, 0), corner + QPoint(0, size)])
        painter.restore()
