"""The dialog in which an operator arranges the cues: order, words, colours, keys, own ones."""

from __future__ import annotations

import msgspec
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor, QPixmap
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QFormLayout,
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QWidget,
)

from nep_studio.blocks.errors import EditRefused
from nep_studio.project.triggers import KEYS, Cue, own_cue
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

from .board import COLOURS, ICONS, colour_words, cue_words


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
        self.label = QLineEdit()
        self.colour = QComboBox()
        self.key = QComboBox()
        self.is_shown = QCheckBox(tr("Show its button"))
        self.up_button = _button(tr("Move up"), "arrow-up", theme)
        self.down_button = _button(tr("Move down"), "arrow-down", theme)
        self.remove_button = _button(tr("Take out"), "trash-2", theme)
        self.own = QLineEdit()
        self.add_state_button = _button(tr("Add a state"), "flag", theme)
        self.add_word_button = _button(tr("Add words"), "ear", theme)
        self.why_not = QLabel(wordWrap=True)
        self.why_not.setProperty("role", "hint")
        self.done_button = QPushButton(tr("Done"))
        self.cancel_button = QPushButton(tr("Cancel"))
        self._fill_choices()
        self._lay_out()
        self._connect()
        self._show(0)

    def select(self, cue: Cue) -> None:
        """Show a cue."""
        found = next((n for n, one in enumerate(self.cues) if one.id == cue.id), 0)
        self.list.setCurrentRow(found)

    def _fill_choices(self) -> None:
        side = self.fontMetrics().height()
        for colour in COLOURS:
            picture = QPixmap(side, side)
            picture.fill(QColor(colour) if colour else self._theme.colour("accent"))
            self.colour.addItem(picture, colour_words(colour), colour)
        self.key.addItem(tr("None"), "")
        for key in KEYS:
            self.key.addItem(key, key)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.own.setPlaceholderText(tr("Name of a state, or words that somebody says"))
        self.own.setAccessibleName(self.own.placeholderText())
        self.label.setPlaceholderText(tr("As it is"))
        order = in_column(self.up_button, self.down_button, self.remove_button, 1)
        top = in_row((self.list, 1), order)
        form = QFormLayout()
        form.addRow(tr("Words"), self.label)
        form.addRow(tr("Colour"), self.colour)
        form.addRow(tr("Key"), self.key)
        form.addRow("", self.is_shown)
        new = in_row((self.own, 1), self.add_state_button, self.add_word_button)
        end = in_row(1, self.cancel_button, self.done_button)
        self.done_button.setDefault(True)
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

    @property
    def _row(self) -> int:
        return self.list.currentRow()

    def _show(self, row: int) -> None:
        self.list.blockSignals(True)
        self.list.clear()
        for cue in self.cues:
            keys = f"  [{cue.key}]" if cue.key else ""
            hidden = f"  ({tr('not shown')})" if cue.is_hidden else ""
            item = QListWidgetItem(
                icon(ICONS[cue.kind], self._theme), cue_words(cue) + keys + hidden
            )
            self.list.addItem(item)
        self.list.setCurrentRow(min(row, len(self.cues) - 1))
        self.list.blockSignals(False)
        self._on_selected()

    def _on_selected(self) -> None:
        row = self._row
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
        row = self._row
        if 0 <= row < len(self.cues):
            self.cues[row] = msgspec.structs.replace(self.cues[row], **values)
            cursor = self.label.cursorPosition()
            self._show(row)
            self.label.setCursorPosition(cursor)

    def _on_key_chosen(self) -> None:
        """A key has one cue: the one that had it gives it away."""
        key, row = self.key.currentData(), self._row
        for number, cue in enumerate(self.cues):
            if key and cue.key == key and number != row:
                self.cues[number] = msgspec.structs.replace(cue, key="")
        self._change(key=key)

    def _move(self, step: int) -> None:
        row, to = self._row, self._row + step
        if 0 <= to < len(self.cues):
            self.cues[row], self.cues[to] = self.cues[to], self.cues[row]
            self._show(to)

    def _on_removed(self) -> None:
        del self.cues[self._row]
        self._show(self._row)

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
    button = QPushButton(icon(icon_name, theme), words, autoDefault=False)
    return button
