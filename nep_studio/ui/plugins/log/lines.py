"""The lines of what happens: who, what and when; bounded, filtered, and searched."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from operator import attrgetter

from PySide6.QtCore import (
    QAbstractListModel,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    QPointF,
    QRect,
    QRectF,
    QSize,
    Qt,
)
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPixmap
from PySide6.QtWidgets import QStyle, QStyledItemDelegate, QStyleOptionViewItem

from nep_core.wire import messages as m
from nep_studio.ui.labels import plain_tip
from nep_studio.ui.node_style import TYPE_COLOURS, TYPE_ICONS
from nep_studio.ui.theme.icons import icon_pixmap
from nep_studio.ui.theme.look import Look
from nep_studio.ui.words import tr

MOST_LINES = 2000
"""The oldest of more lines go."""

RUN = "run"
LINE = Qt.ItemDataRole.UserRole
SAYING = attrgetter("part", "source", "what")
Index = QModelIndex | QPersistentModelIndex


@dataclass(slots=True)
class Line:
    """One thing that happened; ``count`` times, one after the other, ``elapsed_s`` into the run.

    ``part`` is the type of the node that tells it, or "run" for the beginning of a run.
    """

    elapsed_s: float
    part: str
    source: str
    what: str
    count: int = 1

    @property
    def words(self) -> str:
        """All of it, for the clipboard, files, and screen readers."""
        times = tr(" ({count} times)", count=self.count) if self.count > 1 else ""
        source = f"{self.source}: " if self.source else ""
        return f"{self.elapsed_s:.2f} s  {source}{self.what}{times}"


def part_of(message: object) -> str:
    """The type of the node that a message is told of."""
    match message:
        case m.NodeState():
            return message.type
        case m.HumanBehavior():
            return "perceptual"
        case m.ProgramState():
            return "cognitive"
    return "action"


class LinesModel(QAbstractListModel):
    """The last lines that are of the chosen part and have the words that are looked for."""

    def __init__(self, parent: QObject | None = None, most: int = MOST_LINES) -> None:
        super().__init__(parent)
        self._all: deque[Line] = deque(maxlen=most)
        self._shown: list[Line] = []
        self._part = self._words = ""
        self._most = most

    def add(self, lines: Iterable[Line]) -> None:
        """Add lines at the end; one that says the same as the one before it is counted."""
        new: list[Line] = []
        for line in lines:
            last = self._all[-1] if self._all else None
            if last is not None and SAYING(last) == SAYING(line):
                last.count += 1
                last.elapsed_s = line.elapsed_s
                continue
            self._all.append(line)
            if self._fits(line):
                new.append(line)
        if self._shown:  # it may say now that it came again
            last_shown = self.index(len(self._shown) - 1)
            self.dataChanged.emit(last_shown, last_shown)
        new = new[-self._most :]
        surplus = len(self._shown) + len(new) - self._most
        if surplus > 0:
            self.beginRemoveRows(QModelIndex(), 0, surplus - 1)
            del self._shown[:surplus]
            self.endRemoveRows()
        if new:
            first = len(self._shown)
            self.beginInsertRows(QModelIndex(), first, first + len(new) - 1)
            self._shown += new
            self.endInsertRows()

    def show_part(self, part: str) -> None:
        """Show the lines of a type of node only; "" shows all."""
        self._part = part
        self._refilter()

    def search(self, words: str) -> None:
        """Show the lines only that have these words, in any case."""
        self._words = words.strip().casefold()
        self._refilter()

    def clear(self) -> None:
        """Forget all lines."""
        self._all.clear()
        self._refilter()

    @property
    def total(self) -> int:
        """How many lines there are, shown or not."""
        return len(self._all)

    def lines(self) -> list[Line]:
        """The lines that are shown."""
        return list(self._shown)

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008 Qt's own signature
        """How many lines are shown."""
        return 0 if parent.isValid() else len(self._shown)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        """The words of a line, or the line."""
        if not index.isValid() or index.row() >= len(self._shown):
            return None
        line = self._shown[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return line.words
        if role == Qt.ItemDataRole.ToolTipRole:
            return plain_tip(line.words)
        return line if role == LINE else None

    def _fits(self, line: Line) -> bool:
        if self._part and line.part not in (self._part, RUN):
            return False
        return not self._words or self._words in f"{line.source} {line.what}".casefold()

    def _refilter(self) -> None:
        self.beginResetModel()
        self._shown = [line for line in self._all if self._fits(line)]
        self.endResetModel()


# Paints a line of what happens: when, the sign and name of who, and what.

WHO_LETTERS = 16
"""Longer names end in …"""


class LinePainter(QStyledItemDelegate):
    """Draws in columns, from the right where one writes from the right."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look

    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:
        """One line of text, with air."""
        height = option.fontMetrics.height()
        return QSize(height * 10, round(height * 1.5))

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        """Draw one line."""
        line: Line = index.data(LINE)
        style = option.widget.style()
        style.drawPrimitive(QStyle.PrimitiveElement.PE_PanelItemViewItem, option, painter)
        theme = self._look.theme
        is_chosen = bool(option.state & QStyle.StateFlag.State_Selected)
        text = theme.colour("selection_text" if is_chosen else "field_text")
        muted = text if is_chosen else theme.colour("muted")
        font, bold = QFont(option.font), QFont(option.font)
        bold.setWeight(QFont.Weight.DemiBold)
        columns = _Columns(option.rect, option.direction, option.fontMetrics)
        end = Qt.AlignmentFlag.AlignRight if columns.is_mirrored else Qt.AlignmentFlag.AlignLeft
        when = columns.take(option.fontMetrics.horizontalAdvance("00000.00"))
        numbers = Qt.AlignmentFlag.AlignRight
        _write(painter, font, muted, when, f"{line.elapsed_s:.2f}", numbers)
        self._draw_sign(painter, columns.take(option.fontMetrics.height()), line)
        if line.source:
            source = columns.take(option.fontMetrics.averageCharWidth() * WHO_LETTERS)
            _write(painter, bold, text, source, line.source, end)
        if line.count > 1:
            times = f"×{line.count}"  # noqa: RUF001 the sign for times is meant
            room = columns.take(option.fontMetrics.horizontalAdvance(f"{times} "))
            _write(painter, font, muted, room, times, end)
        _write(painter, bold if line.part == RUN else font, text, columns.rest(), line.what, end)

    def _draw_sign(self, painter: QPainter, rect: QRect, line: Line) -> None:
        theme, side = self._look.theme, rect.width()
        square = QRectF(rect.x(), rect.center().y() - side / 2 + 0.5, side, side)
        colours = theme.block(TYPE_COLOURS.get(line.part, "control"))
        is_run = line.part == RUN
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(theme.colour("run") if is_run else colours.fill)
        painter.drawRoundedRect(square, side / 4, side / 4)
        ink = theme.colour("run_text") if is_run else colours.text
        name = "play" if is_run else TYPE_ICONS.get(line.part, "bot")
        air = side * 0.14
        sign = _sign(name, ink.rgb(), side - 2 * air, painter.device().devicePixelRatio())
        painter.drawPixmap(square.topLeft() + QPointF(air, air), sign)
        painter.restore()


class _Columns:
    """Takes room for one column after the other from where reading begins."""

    def __init__(self, rect: QRect, direction: Qt.LayoutDirection, metrics: QFontMetrics) -> None:
        self.is_mirrored = direction == Qt.LayoutDirection.RightToLeft
        self._gap = metrics.height() // 2
        self._left = rect.adjusted(self._gap, 0, -self._gap, 0)
        self._rect = QRect(self._left)
        self._direction = direction

    def take(self, width: int) -> QRect:
        """The next column, this wide."""
        column = QRect(self._left)
        column.setWidth(min(width, self._left.width()))
        self._left.setLeft(column.right() + self._gap)
        return QStyle.visualRect(self._direction, self._rect, column)

    def rest(self) -> QRect:
        """What is left of the room."""
        return QStyle.visualRect(self._direction, self._rect, self._left)


def _write(
    painter: QPainter, font: QFont, ink: QColor, rect: QRect, words: str, side: Qt.AlignmentFlag
) -> None:
    painter.setFont(font)
    painter.setPen(ink)
    shown = QFontMetrics(font).elidedText(words, Qt.TextElideMode.ElideRight, rect.width())
    painter.drawText(rect, side | Qt.AlignmentFlag.AlignVCenter, shown)


@lru_cache(maxsize=64)
def _sign(name: str, ink: int, size: float, ratio: float) -> QPixmap:
    """A sign in a colour, drawn once."""
    return icon_pixmap(name, QColor(ink), size, ratio)
