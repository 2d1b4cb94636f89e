"""The buttons of the cues, and the dialog in which an operator arranges them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import msgspec
from PySide6.QtCore import QEvent, QRect, QSignalBlocker, QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QColor,
    QFont,
    QFontMetrics,
    QKeyEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPixmap,
)
from PySide6.QtWidgets import (
    QAbstractButton,
    QCheckBox,
    QComboBox,
    QDialog,
    QFormLayout,
    QGridLayout,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QSizePolicy,
    QWidget,
)

from nep_studio.blocks.errors import EditRefused
from nep_studio.project.triggers import KEYS, Cue, own_cue
from nep_studio.ui.cue_style import ICONS, cue_words
from nep_studio.ui.labels import follow_words, labelled, plain_tip
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import icon, paint_icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import hint
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

# The colours of cues.

COLOURS = {
    "": "Usual colour",
    "#1f6f78": "Teal",
    "#3b6fc9": "Blue",
    "#7a4fb5": "Purple",
    "#a33b5e": "Raspberry",
    "#b3541e": "Orange",
    "#8a6d00": "Gold",
    "#2a6b3c": "Green",
}
"""What a person can choose, and what it is called; "" is the theme's own."""


def ink_on(colour: QColor) -> QColor:
    """Black or white, whichever is read better on a colour."""
    red, green, blue = colour.redF(), colour.greenF(), colour.blueF()
    light = sum(w * _linear(c) for w, c in ((0.2126, red), (0.7152, green), (0.0722, blue)))
    return QColor("black") if (light + 0.05) ** 2 > 1.05 * 0.05 else QColor("white")


def _linear(channel: float) -> float:
    return channel / 12.92 if channel <= 0.03928 else float(((channel + 0.055) / 1.055) ** 2.4)


FLASH_MS = 350
WIDTH_LINES, HEIGHT_LINES = 8.5, 4.2


class CueButton(QAbstractButton):
    """One cue: icon, words, key; it lights up for a moment when it was sent."""

    def __init__(self, cue: Cue, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self.cue, self._look = cue, look
        self.is_heard = True
        self._flash = QTimer(self, singleShot=True, interval=FLASH_MS)
        self._flash.timeout.connect(self.update)
        self.setToolTip(plain_tip(cue.state))
        follow_words(self, self._say)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)

    def _say(self) -> None:
        self.setText(cue_words(self.cue))
        keys = tr("key {key}", key=self.cue.key) if self.cue.key else ""
        self.setAccessibleName(", ".join(filter(None, (self.text(), keys))))

    def flash(self) -> None:
        """Show that it was sent."""
        self._flash.start()
        self.update()

    def sizeHint(self) -> QSize:
        """Large enough for a finger."""
        line = self.fontMetrics().height()
        return QSize(round(line * WIDTH_LINES), round(line * HEIGHT_LINES))

    minimumSizeHint = sizeHint  # noqa: N815 - as Qt calls it

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the button."""
        theme, line = self._look.theme, self.fontMetrics().height()
        fill = QColor(self.cue.colour) if self.cue.colour else theme.colour("accent")
        if self._flash.isActive():
            fill = theme.colour("glow")
        elif not self.is_heard:
            fill = theme.colour("panel_alt")
        elif self.isDown() or self.underMouse():
            fill = fill.lighter(115) if fill.lightnessF() < 0.5 else fill.darker(110)
        ink = ink_on(fill)
        ring = max(2, line // 7)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            edge = theme.colour("focus") if self.hasFocus() else theme.colour("field_line")
            painter.setPen(QPen(edge, ring if self.hasFocus() else max(1, ring // 2)))
            painter.setBrush(fill)
            half = ring / 2
            box = self.rect().toRectF().adjusted(half, half, -half, -half)
            painter.drawRoundedRect(box, line * 0.45, line * 0.45)
            self._paint_words(painter, ink, line)

    def _paint_words(self, painter: QPainter, ink: QColor, line: int) -> None:
        gap = line // 2
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        start = self.width() - gap - line if is_mirrored else gap
        end = gap if is_mirrored else self.width() - gap - line
        place = QRect(start, gap, line, line).toRectF()
        paint_icon(painter, place, ICONS[self.cue.kind], ink)
        painter.setPen(ink)
        if self.cue.key:
            key = QRect(end, gap, line, line)
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(key.toRectF(), gap / 2, gap / 2)
            painter.drawText(key, Qt.AlignmentFlag.AlignCenter, self.cue.key)
        room = self.rect().adjusted(gap, gap + line, -gap, -gap // 2)
        flags = Qt.TextFlag.TextWordWrap.value | Qt.AlignmentFlag.AlignCenter.value
        painter.setFont(_fitting(self.text(), room, self.font(), flags))
        painter.drawText(room, flags, self.text())


def _fitting(text: str, room: QRect, font: QFont, flags: int) -> QFont:
    """The font, up to half as large again, as large as the words still fit."""
    for percent in (150, 130, 115, 100, 85, 70):
        sized = QFont(font)
        sized.setPointSizeF(font.pointSizeF() * percent / 100)
        sized.setWeight(QFont.Weight.DemiBold)
        needed = QFontMetrics(sized).boundingRect(room, flags, text)
        if needed.width() <= room.width() and needed.height() <= room.height():
            break
    return sized


class CueBoard(QWidget):
    """All buttons. ``chosen`` gives the cue that was pressed; keys 1 to 9 press theirs."""

    chosen = Signal(object)
    change_asked = Signal(object)

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self._is_heard = True
        self.buttons: list[CueButton] = []
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        labelled(self, name="Cues")
        look.theme_changed.connect(self.update)

    def show_cues(self, cues: Iterable[Cue]) -> None:
        """Show these, those that are hidden left out."""
        shown = [cue for cue in cues if not cue.is_hidden]
        if shown == [button.cue for button in self.buttons]:
            return
        focused = next((b.cue.id for b in self.buttons if b.hasFocus()), None)
        for button in self.buttons:
            self._grid.removeWidget(button)
            button.hide()
            button.deleteLater()
        self.buttons = [self._button(cue) for cue in shown]
        self._arrange()
        for button in self.buttons:
            button.show()
            if button.cue.id == focused:
                button.setFocus()

    def set_heard(self, is_heard: bool) -> None:
        """Show whether somebody would hear."""
        self._is_heard = is_heard
        for button in self.buttons:
            button.is_heard = is_heard
            button.update()

    def flash(self, cue: Cue) -> None:
        """Show that a cue was sent."""
        for button in self.buttons:
            if button.cue.id == cue.id:
                button.flash()

    def press(self, key: str) -> bool:
        """Press the button of a key; whether there is one."""
        found = next((one for one in self.buttons if key and one.cue.key == key), None)
        if found is not None:
            found.click()
        return found is not None

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Keys press buttons, arrows go from one to the next."""
        if event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier or not self.press(event.text()):
            super().keyPressEvent(event)

    def minimumSizeHint(self) -> QSize:
        """Room for one beside no other: else a board of two columns could not become narrower."""
        one = max((button.minimumSizeHint().width() for button in self.buttons), default=0)
        return QSize(one, super().minimumSizeHint().height())

    def resizeEvent(self, event: QEvent) -> None:
        """As many in a row as fit."""
        self._arrange()

    def _button(self, cue: Cue) -> CueButton:
        button = CueButton(cue, self._look, self)
        button.is_heard = self._is_heard
        button.clicked.connect(lambda: self.chosen.emit(cue))
        button.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        button.customContextMenuRequested.connect(lambda: self.change_asked.emit(cue))
        return button

    def _arrange(self) -> None:
        columns = columns_for(self.buttons, self.width(), self._grid.horizontalSpacing())
        for number, button in enumerate(self.buttons):
            self._grid.addWidget(button, *divmod(number, columns))  # moves one that is there
        for column in range(self._grid.columnCount()):
            self._grid.setColumnStretch(column, 1 if column < columns else 0)


def columns_for(buttons: Sequence[QWidget], width: int, gap: int) -> int:
    """How many columns there is room for."""
    if not buttons:
        return 1
    one = max(button.sizeHint().width() for button in buttons) + max(gap, 0)
    return max(1, min(len(buttons), (width + max(gap, 0)) // one))


# The dialog in which an operator arranges the cues: order, words, colours, keys, own ones.


class ArrangeDialog(QDialog):
    """Shows all cues, hidden ones too; ``arranged`` gives the list that is to be kept."""

    arranged = Signal(list)

    def __init__(self, cues: list[Cue], theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Arrange the cues"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.cues, self._theme = list(cues), theme
        self.list = QListWidget()
        self.list.setAccessibleName(tr("Cues"))
        self.label = QLineEdit(placeholderText=tr("As it is"))
        self.colour, self.key = QComboBox(), QComboBox()
        self.is_shown = QCheckBox(tr("Show its button"))
        self.up_button = _button(tr("Move up"), "arrow-up", theme)
        self.down_button = _button(tr("Move down"), "arrow-down", theme)
        self.remove_button = _button(tr("Take out"), "trash-2", theme)
        self.own = QLineEdit()
        self.add_state_button = _button(tr("Add a state"), "flag", theme)
        self.add_word_button = _button(tr("Add words"), "ear", theme)
        self.why_not = hint("")
        self.done_button = QPushButton(tr("Done"), default=True)
        self.cancel_button = QPushButton(tr("Cancel"))
        side = self.fontMetrics().height()
        for colour, words in COLOURS.items():
            picture = QPixmap(side, side)
            picture.fill(QColor(colour) if colour else self._theme.colour("accent"))
            self.colour.addItem(picture, tr(words), colour)
        self.key.addItem(tr("None"), "")
        for key in KEYS:
            self.key.addItem(key, key)
        self._lay_out()
        self._connect()
        self._show(0)

    def select(self, cue: Cue) -> None:
        """Show a cue."""
        found = next((n for n, one in enumerate(self.cues) if one.id == cue.id), 0)
        self.list.setCurrentRow(found)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.own.setPlaceholderText(tr("Name of a state, or words that somebody says"))
        self.own.setAccessibleName(self.own.placeholderText())
        order = in_column(self.up_button, self.down_button, self.remove_button, 1)
        top = in_row((self.list, 1), order)
        form = QFormLayout()
        form.addRow(tr("Words"), self.label)
        form.addRow(tr("Colour"), self.colour)
        form.addRow(tr("Key"), self.key)
        form.addRow("", self.is_shown)
        new = in_row((self.own, 1), self.add_state_button, self.add_word_button)
        end = in_row(1, self.cancel_button, self.done_button)
        in_column(top, form, new, self.why_not, end, of=self, margins=line)
        self.resize(line * 30, line * 30)

    def _connect(self) -> None:
        self.list.currentRowChanged.connect(self._on_selected)
        self.label.textEdited.connect(lambda text: self._change(label=text.strip()))
        self.colour.activated.connect(lambda: self._change(colour=self.colour.currentData()))
        self.key.activated.connect(self._on_key_chosen)
        self.is_shown.clicked.connect(lambda is_on: self._change(is_hidden=not is_on))
        self.up_button.clicked.connect(lambda: self._move(-1))
        self.down_button.clicked.connect(lambda: self._move(1))
        self.remove_button.clicked.connect(self._on_removed)
        self.add_state_button.clicked.connect(lambda: self._add(is_word=False))
        self.add_word_button.clicked.connect(lambda: self._add(is_word=True))
        self.cancel_button.clicked.connect(self.reject)
        self.done_button.clicked.connect(self._on_done)

    def _show(self, row: int) -> None:
        with QSignalBlocker(self.list):
            self.list.clear()
            for cue in self.cues:
                keys = f"  [{cue.key}]" if cue.key else ""
                hidden = f"  ({tr('not shown')})" if cue.is_hidden else ""
                words = cue_words(cue) + keys + hidden
                self.list.addItem(QListWidgetItem(icon(ICONS[cue.kind], self._theme), words))
            self.list.setCurrentRow(min(row, len(self.cues) - 1))
        self._on_selected()

    def _on_selected(self) -> None:
        row = self.list.currentRow()
        is_one = 0 <= row < len(self.cues)
        for widget in (self.label, self.colour, self.key, self.is_shown, self.remove_button):
            widget.setEnabled(is_one)
        self.up_button.setEnabled(row > 0)
        self.down_button.setEnabled(is_one and row < len(self.cues) - 1)
        if not is_one:
            return
        cue = self.cues[row]
        self.remove_button.setEnabled(cue.is_own)
        self.label.setText(cue.label)
        self.label.setPlaceholderText(cue_words(msgspec.structs.replace(cue, label="")))
        self.colour.setCurrentIndex(max(0, self.colour.findData(cue.colour)))
        self.key.setCurrentIndex(max(0, self.key.findData(cue.key)))
        self.is_shown.setChecked(not cue.is_hidden)

    def _change(self, **values: object) -> None:
        row = self.list.currentRow()
        if 0 <= row < len(self.cues):
            self.cues[row] = msgspec.structs.replace(self.cues[row], **values)
            cursor = self.label.cursorPosition()
            self._show(row)
            self.label.setCursorPosition(cursor)

    def _on_key_chosen(self) -> None:
        """A key has one cue: the one that had it gives it away."""
        key, row = self.key.currentData(), self.list.currentRow()
        for number, cue in enumerate(self.cues):
            if key and cue.key == key and number != row:
                self.cues[number] = msgspec.structs.replace(cue, key="")
        self._change(key=key)

    def _move(self, step: int) -> None:
        row = self.list.currentRow()
        to = row + step
        if 0 <= to < len(self.cues):
            self.cues[row], self.cues[to] = self.cues[to], self.cues[row]
            self._show(to)

    def _on_removed(self) -> None:
        row = self.list.currentRow()
        del self.cues[row]
        self._show(row)

    def _add(self, *, is_word: bool) -> None:
        try:
            cue = own_cue(self.own.text(), is_word=is_word)
        except EditRefused as refused:
            self.why_not.setText(tr(refused.sentence))
            return
        if any(one.id == cue.id for one in self.cues):
            self.why_not.setText(tr("There is a cue for this already."))
            return
        self.why_not.clear()
        self.own.clear()
        self.cues.append(cue)
        self._show(len(self.cues) - 1)

    def _on_done(self) -> None:
        self.arranged.emit(self.cues)
        self.accept()


def _button(words: str, icon_name: str, theme: Theme) -> QPushButton:
    return QPushButton(icon(icon_name, theme), words, autoDefault=False)
