"""The command palette: type a few letters of what you want to do, press Enter."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from itertools import groupby
from typing import TYPE_CHECKING

from PySide6.QtCore import (
    QEvent,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    QPoint,
    QRect,
    QSize,
    QStringListModel,
    Qt,
)
from PySide6.QtGui import (
    QColor,
    QFont,
    QFontMetrics,
    QHideEvent,
    QIcon,
    QKeyEvent,
    QPainter,
    QShowEvent,
)
from PySide6.QtWidgets import (
    QApplication,
    QFrame,
    QLabel,
    QLineEdit,
    QListView,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QWidget,
)
from shiboken6 import isValid

from nep_studio.ui.labels import labelled, plain_tip
from nep_studio.ui.messages import announce
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import styled
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import count_words, tr

from .commands import NOT_IN_ITSELF, Command, Ranked, Source, ranked, sources_of

if TYPE_CHECKING:
    from .main_window import MainWindow


# How a command looks in the list: icon, words with what was typed in bold, kind, keys, reason.

RANKED = Qt.ItemDataRole.UserRole
Index = QModelIndex | QPersistentModelIndex


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
        gap = option.fontMetrics.height() // 2
        painter.save()
        painter.setFont(option.font)
        if is_current:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.colour("selection"))
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.drawRoundedRect(option.rect.adjusted(1, 1, -1, -1), gap / 2, gap / 2)
        ink = theme.colour("selection_text" if is_current else "text")
        pale = ink if is_current else theme.colour("muted")
        _paint_row(painter, option, ranked, ink, pale)
        painter.restore()


def _paint_row(
    painter: QPainter, option: QStyleOptionViewItem, ranked: Ranked, ink: QColor, pale: QColor
) -> None:
    command, line, flags = ranked.command, option.fontMetrics.height(), Qt.AlignmentFlag
    gap = line // 2

    def placed(rect: QRect) -> QRect:
        """Where it is that would be there if one read from the left."""
        return QStyle.visualRect(painter.layoutDirection(), option.rect, rect)

    room = option.rect.adjusted(gap, 0, -gap, 0)
    room.setHeight(round(line * 1.6))
    sign = icon("check", ink) if command.is_on else command.icon
    side = placed(QRect(room.left(), room.center().y() - line // 2, line, line))
    sign.paint(painter, side, mode=QIcon.Mode.Disabled if command.why_not else QIcon.Mode.Normal)
    room.setLeft(room.left() + line + gap)
    painter.setPen(pale)
    for words in (command.keys, "" if ranked.is_recent and command.keys else command.kind):
        width = option.fontMetrics.horizontalAdvance(words)
        if words and width <= room.width() // 2:
            painter.drawText(placed(room), flags.AlignRight | flags.AlignVCenter, words)
            room.setRight(room.right() - width - 2 * gap)
    painter.setPen(pale if command.why_not else ink)
    _paint_words(painter, ranked, placed(room))
    if command.why_not:
        below = QRect(room.left(), room.bottom() - gap // 2, 0, line)
        below.setRight(option.rect.right() - gap)
        painter.setPen(pale)
        shown = option.fontMetrics.elidedText(command.why_not, _ELIDE, below.width())
        painter.drawText(placed(below), flags.AlignLeft, shown)


_ELIDE = Qt.TextElideMode.ElideRight


def _ranked(index: Index) -> Ranked | None:
    ranked = index.data(RANKED)
    return ranked if isinstance(ranked, Ranked) else None


def _paint_words(painter: QPainter, ranked: Ranked, room: QRect) -> None:
    """Paint the words; the letters that were typed are bold and underlined."""
    plain, bold = QFont(painter.font()), QFont(painter.font())
    bold.setWeight(QFont.Weight.Bold)
    bold.setUnderline(True)
    words = ranked.command.words
    metrics = QFontMetrics(bold)
    shown = metrics.elidedText(words, _ELIDE, room.width())
    is_mirrored = painter.layoutDirection() == Qt.LayoutDirection.RightToLeft
    if is_mirrored or not ranked.letters:  # joined letters must not be torn apart
        painter.drawText(room, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter, shown)
        return
    x, base = float(room.left()), room.center().y() + (metrics.ascent() - metrics.descent()) / 2
    for text, is_found in _runs(shown, set(ranked.letters)):
        painter.setFont(bold if is_found else plain)
        painter.drawText(round(x), round(base), text)
        x += painter.fontMetrics().horizontalAdvance(text)
    painter.setFont(plain)


def _runs(text: str, found: set[int]) -> list[tuple[str, bool]]:
    """A text in pieces that are found or not."""
    runs = groupby(enumerate(text), key=lambda one: one[0] in found)
    return [("".join(letter for _, letter in run), is_found) for is_found, run in runs]


MOST_RECENT = 20
MOST_ROWS = 12
LETTERS = 70


class CommandPalette(QFrame):
    """Lies over the window; Enter does what is chosen, Esc goes back to where the person was."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self.setObjectName("command_palette")
        self._window = window
        self._sources = sources_of(window)
        self._commands: list[Command] = []
        self._before: QWidget | None = None
        self.rows: list[Ranked] = []
        self.line = labelled(
            QLineEdit(), placeholder="What do you want to do?", name="What do you want to do?"
        )
        self.line.setClearButtonEnabled(True)
        self.list = labelled(QListView(), name="Commands")
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setVerticalScrollMode(QListView.ScrollMode.ScrollPerPixel)
        self.list.setItemDelegate(RowPainter(window.look, self.list))
        self.model = CommandModel(self)
        self.list.setModel(self.model)
        self.hint = styled(QLabel(wordWrap=True), role="hint")
        in_column(self.line, self.list, self.hint, of=self)
        self.line.textChanged.connect(self._on_typed)
        self.line.installEventFilter(self)
        self.list.clicked.connect(lambda index: self.run(index.row()))
        window.look.theme_changed.connect(self._dress)
        self._dress()
        self.hide()

    def add_source(self, source: Source) -> None:
        """Offer these commands, too."""
        self._sources.append(source)

    def open(self, typed: str = "") -> None:
        """Show the palette; a second time, close it."""
        if self.isVisible():
            self.leave()
            return
        self._before = QApplication.focusWidget()
        self._commands = [command for source in self._sources for command in source()]
        self.line.setText(typed)
        self._on_typed(typed)
        self.show()
        self.raise_()
        self._place()
        self.line.setFocus(Qt.FocusReason.PopupFocusReason)
        self.line.selectAll()

    def leave(self) -> None:
        """Close it, and go back to where the person was."""
        self.hide()
        before, self._before = self._before, None
        if before is not None and isValid(before) and before.isVisible():  # a field may have gone
            before.setFocus(Qt.FocusReason.PopupFocusReason)

    def run(self, number: int) -> bool:
        """Do what is in a row; False, and said why, when that cannot be now."""
        if not 0 <= number < len(self.rows):
            return False
        command = self.rows[number].command
        if command.why_not:
            self.hint.setText(command.why_not)
            announce(self.line, command.why_not)
            return False
        self.leave()
        settings = self._window.settings
        others = [one for one in settings.recent_commands if one != command.id]
        settings.recent_commands = [command.id, *others][:MOST_RECENT]
        command.do()
        return True

    def showEvent(self, event: QShowEvent) -> None:
        """Follow the size of the window."""
        super().showEvent(event)
        self._window.installEventFilter(self)

    def hideEvent(self, event: QHideEvent) -> None:
        """Let the window go its own way."""
        super().hideEvent(event)
        self._window.removeEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Take the keys of the line, and stay in the middle of the window."""
        if watched is self.line and isinstance(event, QKeyEvent):
            return event.type() == QEvent.Type.KeyPress and self._press(event)
        if watched is self.line and event.type() == QEvent.Type.FocusOut:
            if not self.isAncestorOf(QApplication.focusWidget() or self._window):
                self.hide()
        elif watched is self._window and event.type() == QEvent.Type.Resize and self.isVisible():
            self._place()
        return super().eventFilter(watched, event)

    def _press(self, event: QKeyEvent) -> bool:
        step = _STEPS.get(Qt.Key(event.key()), 0)
        if event.key() == Qt.Key.Key_Escape:
            self.leave()
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.run(self.list.currentIndex().row())
        elif step and self.rows:
            here, last = self.list.currentIndex().row(), len(self.rows) - 1
            is_round = abs(step) == 1
            self._go((here + step) % (last + 1) if is_round else min(max(here + step, 0), last))
        else:
            return False
        return True

    def _go(self, number: int) -> None:
        index = self.model.index(number)
        self.list.setCurrentIndex(index)
        self.list.scrollTo(index)
        found = count_words(len(self.rows), "1 command", "{n} commands")
        usual = f"{found} · {tr('Enter does it, Esc closes.')}"
        self.hint.setText(self.rows[number].command.why_not or usual)
        announce(self.list, self.model.spoken(number))

    def _on_typed(self, typed: str) -> None:
        self.rows = ranked(self._commands, typed, self._window.settings.recent_commands)
        self.model.show_rows(self.rows)
        self._place()
        if self.rows:
            self._go(0)
        else:
            words = tr("Nothing is called like that. Try fewer letters.")
            self.hint.setText(words)
            announce(self.line, words)

    def _place(self) -> None:
        """Be as wide as a line of text can be, below the toolbar, in the middle."""
        window, line = self._window, self.fontMetrics().height()
        width = min(self.fontMetrics().averageCharWidth() * LETTERS, window.width() - 2 * line)
        sizes = (self.list.sizeHintForRow(row) for row in range(min(len(self.rows), MOST_ROWS)))
        rows = sum(sizes) + 2 * self.list.frameWidth()
        self.setFixedWidth(width)
        rest = self.line.sizeHint().height() + self.hint.heightForWidth(width) + 3 * line
        self.list.setFixedHeight(max(0, min(rows, window.height() - rest - 3 * line)))
        self.list.setVisible(bool(self.rows))
        self.adjustSize()
        area = window.centralWidget()
        top = area.mapTo(window, QPoint(0, 0)).y() if area is not None else 0
        top = min(top, max(0, window.height() - self.height()))
        self.move((window.width() - self.width()) // 2, top)

    def _dress(self) -> None:
        theme, line = self._window.look.theme, self.fontMetrics().height()
        ring = max(1, line // 9)
        self.setStyleSheet(
            f"#command_palette {{ background: {theme.colour('menu').name()};"
            f" border: {ring}px solid {theme.colour('focus').name()};"
            f" border-radius: {line // 2}px; }}"
            f"#command_palette QListView {{ background: transparent; border: none; }}"
        )
        column = self.layout()
        if column is not None:
            column.setContentsMargins(line // 2, line // 2, line // 2, line // 2)
            column.setSpacing(line // 3)


_STEPS = {
    Qt.Key.Key_Down: 1,
    Qt.Key.Key_Up: -1,
    Qt.Key.Key_Tab: 1,
    Qt.Key.Key_Backtab: -1,
    Qt.Key.Key_PageDown: MOST_ROWS - 1,
    Qt.Key.Key_PageUp: 1 - MOST_ROWS,
}


class CommandModel(QStringListModel):
    """The rows for the list, and for who cannot see it."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._rows: list[Ranked] = []

    def show_rows(self, rows: Iterable[Ranked]) -> None:
        """Show these."""
        self._rows = list(rows)
        self.setStringList([row.command.words for row in self._rows])

    def data(self, index: object, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        """A row, also as words to be spoken."""
        number = index.row()  # type: ignore[attr-defined]  # a model index of either kind
        if not 0 <= number < len(self._rows):
            return None
        if role == RANKED:
            return self._rows[number]
        if role == Qt.ItemDataRole.AccessibleTextRole:
            return self.spoken(number)
        if role == Qt.ItemDataRole.ToolTipRole:
            return plain_tip(self._rows[number].command.why_not) or None
        return super().data(index, role)  # type: ignore[arg-type]

    def spoken(self, number: int) -> str:
        """What a screen reader says of a row."""
        command = self._rows[number].command
        parts = (command.words, command.kind, command.keys, command.why_not)
        return ", ".join(part for part in parts if part)


def add_command_palette(window: MainWindow) -> CommandPalette:
    """Make the palette and the action that opens it."""
    palette, keys = CommandPalette(window), ("Ctrl+K", "Ctrl+Shift+P")
    add = partial(window.actions_by_name.add, menu=window.menus["view"])
    add(NOT_IN_ITSELF, "Find a command…", palette.open, icon_name="search", keys=keys)
    return palette
