"""Paints a line of what happens: when, the sign and name of who, and what."""

from __future__ import annotations

from functools import lru_cache

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QPointF, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPixmap
from PySide6.QtWidgets import QStyle, QStyledItemDelegate, QStyleOptionViewItem

from nep_studio.ui.panels.nodes.looks import TYPE_COLOURS, TYPE_ICONS
from nep_studio.ui.theme import Look, icon_pixmap

from .lines import LINE, RUN, Line

WHO_LETTERS = 16
"""Longer names end in …"""


class LinePainter(QStyledItemDelegate):
    """Draws in columns, from the right where one writes from the right."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look

    def sizeHint(
        self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> QSize:
        """One line of text, with air."""
        height = option.fontMetrics.height()
        return QSize(height * 10, round(height * 1.5))

    def paint(
        self,
        painter: QPainter,
        option: QStyleOptionViewItem,
        index: QModelIndex | QPersistentModelIndex,
    ) -> None:
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
        if line.who:
            who = columns.take(option.fontMetrics.averageCharWidth() * WHO_LETTERS)
            _write(painter, bold, text, who, line.who, end)
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
