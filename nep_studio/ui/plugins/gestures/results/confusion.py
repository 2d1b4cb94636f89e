"""What was taken for what, as a table: rows are made, columns are recognised."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from PySide6.QtCore import (
    QAbstractTableModel,
    QEvent,
    QModelIndex,
    QObject,
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

from nep_studio.ui.labels import follow_words, labelled, plain_tip
from nep_studio.ui.theme.colours import mixed
from nep_studio.ui.theme.look import Look
from nep_studio.ui.words import tr

from .findings import NOTHING, Findings
from .labels import legible

Index = QModelIndex | QPersistentModelIndex
SHARE = int(Qt.ItemDataRole.UserRole)
"""The role that gives which part of its row a cell is, from 0 to 1."""
_TOP = QModelIndex()


class Confusion(QAbstractTableModel):
    """The pairs of some findings; *nothing* is a class as the gestures are, the last."""

    def __init__(self, title: Callable[[str], str], parent: QObject) -> None:
        super().__init__(parent)
        self._title = title
        self._findings = Findings({}, {})
        self.names: tuple[str, ...] = ()

    def show(self, findings: Findings | None) -> None:
        """Show the pairs of these findings; of None, none."""
        self.beginResetModel()
        self._findings = findings or Findings({}, {})
        self.names = (*self._findings.names, NOTHING) if self._findings.names else ()
        self.endResetModel()

    def title(self, name: str) -> str:
        """What a class is called."""
        return self._title(name) if name != NOTHING else tr("nothing")

    def pair(self, index: Index) -> tuple[str, str]:
        """What was made and what was recognised, of a cell."""
        return self.names[index.row()], self.names[index.column()]

    def is_right(self, index: Index) -> bool:
        """Whether a cell counts what was recognised as what it was."""
        return index.row() == index.column()

    def count(self, index: Index) -> int:
        """How often it was so."""
        return self._findings.confusion.get(self.pair(index), 0)

    def rowCount(self, parent: Index = _TOP) -> int:
        """What was made."""
        return 0 if parent.isValid() else len(self.names)

    def columnCount(self, parent: Index = _TOP) -> int:
        """What was recognised."""
        return 0 if parent.isValid() else len(self.names)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """The number of a cell, and what it says."""
        if not index.isValid():
            return None
        match role:
            case Qt.ItemDataRole.DisplayRole:
                return self._number(index)
            case Qt.ItemDataRole.AccessibleTextRole:
                return self.sentence(index)
            case Qt.ItemDataRole.ToolTipRole:
                return plain_tip(self.sentence(index))
            case Qt.ItemDataRole.TextAlignmentRole:
                return Qt.AlignmentFlag.AlignCenter
            case _ if role == SHARE:
                made = self._findings.made_of(self.pair(index)[0])
                return self.count(index) / made if made else 0.0
        return None

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        """What the classes are called."""
        if not 0 <= section < len(self.names):
            return None
        title = self.title(self.names[section])
        match role:
            case Qt.ItemDataRole.DisplayRole:
                return title
            case Qt.ItemDataRole.ToolTipRole if orientation == Qt.Orientation.Horizontal:
                return plain_tip(tr("Recognised: {gesture}", gesture=title))
            case Qt.ItemDataRole.ToolTipRole:
                return plain_tip(tr("Made: {gesture}", gesture=title))
        return None

    def sentence(self, index: Index) -> str:
        """What a cell says, in words."""
        made, found = self.pair(index)
        count, all_made = self.count(index), self._findings.made_of(made)
        values = {"made": self.title(made), "found": self.title(found), "all": all_made}
        if made == found == NOTHING:
            return tr("Nothing was made and nothing was recognised: that is not counted.")
        if made == NOTHING:
            one = tr("Nothing was made, but “{found}” was recognised once", **values)
            many = tr("Nothing was made, but “{found}” was recognised {n} times", n=count, **values)
        elif found == NOTHING:
            one = tr("“{made}” was missed once in {all}", **values)
            many = tr("“{made}” was missed {n} times in {all}", n=count, **values)
        elif made == found:
            one = tr("“{made}” was recognised once in {all}", **values)
            many = tr("“{made}” was recognised {n} times in {all}", n=count, **values)
        else:
            one = tr("“{made}” was taken for “{found}” once in {all}", **values)
            many = tr("“{made}” was taken for “{found}” {n} times in {all}", n=count, **values)
        return one if count == 1 else many

    def _number(self, index: Index) -> str:
        if self.pair(index) == (NOTHING, NOTHING):
            return "\N{EN DASH}"
        count = self.count(index)
        return str(count) if count else ""


# Draws what was taken for what: a number and a shade in each cell, headings at a slant.

SLANT_DEGREES = 50.0
CELL_LINES, LEAST_CELL_LINES = 1.9, 1.4
"""How wide a cell is, in lines of text; narrower before the table has to be scrolled."""
MOST_HEADING_LINES = 7.0
MOST_ROWS_SHOWN = 12
_WEAKEST, _STRONGEST = 0.12, 0.85


class ConfusionView(QTableView):
    """``cell_chosen`` gives what was made and what was recognised: its takes are wanted."""

    cell_chosen = Signal(str, str)

    def __init__(self, title: Callable[[str], str], look: Look) -> None:
        super().__init__()
        self._look = look
        self.confusion = Confusion(title, self)
        self.setModel(self.confusion)
        self.headings = SlantedHeader(self)
        self.setHorizontalHeader(self.headings)
        self.setItemDelegate(_Cell(look, self))
        labelled(self, name="What was taken for what: rows are made, columns recognised")
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
        follow_words(self, self._fit)

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

    def _fit(self) -> None:
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
            # A corner, so that a mistake is not told by its colour alone
            size = max(4, rect.height() // 5)
            corner = rect.topRight()
            painter.save()
            painter.setBrush(painter.pen().color())
            painter.drawPolygon([corner, corner - QPoint(size, 0), corner + QPoint(0, size)])
            painter.restore()
        painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, str(index.data() or ""))
        if self._view.hasFocus() and self._view.currentIndex() == index:
            wide = max(2, self._view.fontMetrics().height() // 8)
            painter.setPen(QPen(theme.colour("focus"), wide))
            painter.drawRect(rect.adjusted(1, 1, -1, -1))
        painter.restore()
