"""How a command looks in the list: icon, words with what was typed in bold, kind, keys, reason."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRect, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontMetrics, QIcon, QPainter
from PySide6.QtWidgets import QStyle, QStyledItemDelegate, QStyleOptionViewItem, QWidget

from nep_studio.ui.theme import Look, icon

from .ranking import Ranked

RANKED = Qt.ItemDataRole.UserRole
Index = QModelIndex | QPersistentModelIndex


@dataclass(frozen=True)
class _Row:
    """The measures of a row, all from the font."""

    rect: QRect
    metrics: QFontMetrics

    @property
    def line(self) -> int:
        return self.metrics.height()

    @property
    def gap(self) -> int:
        return self.line // 2


class RowPainter(QStyledItemDelegate):
    """Paints one command a row; what cannot be used now says why below its words."""

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self._look = look

    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:
        """Two lines where there is a reason to be told."""
        ranked = _ranked(index)
        line = option.fontMetrics.height()
        lines = 2.6 if ranked is not None and ranked.command.why_not else 1.6
        return QSize(line * 10, round(line * lines))

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        """Paint a row."""
        ranked = _ranked(index)
        if ranked is None:
            return
        theme = self._look.theme
        is_current = bool(option.state & QStyle.StateFlag.State_Selected)
        row = _Row(option.rect, option.fontMetrics)
        painter.save()
        painter.setFont(option.font)
        if is_current:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.colour("selection"))
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.drawRoundedRect(row.rect.adjusted(1, 1, -1, -1), row.gap / 2, row.gap / 2)
        ink = theme.colour("selection_text" if is_current else "text")
        pale = ink if is_current else theme.colour("muted")
        self._paint_row(painter, row, ranked, ink, pale)
        painter.restore()

    def _paint_row(
        self, painter: QPainter, row: _Row, ranked: Ranked, ink: QColor, pale: QColor
    ) -> None:
        command, is_mirrored = ranked.command, painter.layoutDirection() == _RIGHT_TO_LEFT
        top = QRect(row.rect.left(), row.rect.top(), row.rect.width(), round(row.line * 1.6))
        room = top.adjusted(row.gap, 0, -row.gap, 0)
        sign = icon("check", ink) if command.is_on else command.icon
        room = _paint_icon(painter, sign, room, row, is_mirrored, is_off=bool(command.why_not))
        painter.setPen(pale)
        ends = [command.keys, "" if ranked.is_recent and command.keys else command.kind]
        for words in filter(None, ends):
            room = _paint_end(painter, words, room, row, is_mirrored)
        painter.setPen(pale if command.why_not else ink)
        _paint_words(painter, ranked, room, is_mirrored)
        if command.why_not:
            below = QRect(room.left(), top.bottom() - row.gap // 2, room.width(), row.line)
            below.setWidth(row.rect.right() - row.gap - below.left())
            if is_mirrored:
                below = QRect(
                    row.rect.left() + row.gap, below.y(), room.right() - row.gap, row.line
                )
            painter.setPen(pale)
            side = Qt.AlignmentFlag.AlignRight if is_mirrored else Qt.AlignmentFlag.AlignLeft
            shown = row.metrics.elidedText(command.why_not, _ELIDE, below.width())
            painter.drawText(below, side | Qt.AlignmentFlag.AlignAbsolute, shown)


_RIGHT_TO_LEFT = Qt.LayoutDirection.RightToLeft
_ELIDE = Qt.TextElideMode.ElideRight


def _ranked(index: Index) -> Ranked | None:
    ranked = index.data(RANKED)
    return ranked if isinstance(ranked, Ranked) else None


def _paint_icon(
    painter: QPainter, sign: QIcon, room: QRect, row: _Row, is_mirrored: bool, *, is_off: bool
) -> QRect:
    """Paint the icon where reading begins; the room that is left."""
    side = row.line
    left = room.right() - side if is_mirrored else room.left()
    place = QRect(left, room.center().y() - side // 2, side, side)
    sign.paint(painter, place, mode=QIcon.Mode.Disabled if is_off else QIcon.Mode.Normal)
    used = side + row.gap
    return room.adjusted(0, 0, -used, 0) if is_mirrored else room.adjusted(used, 0, 0, 0)


def _paint_end(painter: QPainter, words: str, room: QRect, row: _Row, is_mirrored: bool) -> QRect:
    """Paint words where reading ends, if there is room; what is left."""
    width = row.metrics.horizontalAdvance(words)
    if width > room.width() // 2:
        return room
    side = Qt.AlignmentFlag.AlignLeft if is_mirrored else Qt.AlignmentFlag.AlignRight
    middle = Qt.AlignmentFlag.AlignVCenter
    painter.drawText(room, side | middle | Qt.AlignmentFlag.AlignAbsolute, words)
    used = width + 2 * row.gap
    return room.adjusted(used, 0, 0, 0) if is_mirrored else room.adjusted(0, 0, -used, 0)


def _paint_words(painter: QPainter, ranked: Ranked, room: QRect, is_mirrored: bool) -> None:
    """Paint the words; the letters that were typed are bold and underlined."""
    plain, bold = QFont(painter.font()), QFont(painter.font())
    bold.setWeight(QFont.Weight.Bold)
    bold.setUnderline(True)
    words = ranked.command.words
    metrics = QFontMetrics(bold)
    shown = metrics.elidedText(words, _ELIDE, room.width())
    if is_mirrored or not ranked.letters:  # joined letters must not be torn apart
        side = Qt.AlignmentFlag.AlignRight if is_mirrored else Qt.AlignmentFlag.AlignLeft
        middle = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignAbsolute
        painter.drawText(room, side | middle, shown)
        return
    x, base = float(room.left()), room.center().y() + (metrics.ascent() - metrics.descent()) / 2
    for text, is_found in _runs(shown, set(ranked.letters)):
        painter.setFont(bold if is_found else plain)
        painter.drawText(round(x), round(base), text)
        x += painter.fontMetrics().horizontalAdvance(text)
    painter.setFont(plain)


def _runs(text: str, found: set[int]) -> list[tuple[str, bool]]:
    """A text in pieces that are found or not."""
    runs: list[tuple[str, bool]] = []
    for place, letter in enumerate(text):
        is_found = place in found
        if runs and runs[-1][1] == is_found:
            runs[-1] = (runs[-1][0] + letter, is_found)
        else:
            runs.append((letter, is_found))
    return runs
