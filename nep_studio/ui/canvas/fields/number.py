"""Popups with a number to type and something to point at: a slider, or times to choose."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QSignalBlocker, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QLineEdit, QPushButton, QSlider
from PySide6.QtWidgets import QWidget as Widget

from nep_studio.blocks.arithmetic import ArithmeticRefused, number_of, number_text, typed_number
from nep_studio.ui.widgets.layouts import in_row
from nep_studio.ui.words import tr

from .field_edit import Editing
from .line_editor import result_text, stepped
from .popup import FieldPopup

if TYPE_CHECKING:
    from .editors import FieldEditors

QUICK_SECONDS = (0.5, 1, 2, 3, 5, 10, 30, 60)
_STEPS = 200


class NumberPopup(FieldPopup):
    """A number in a line, with its unit behind it and what arithmetic comes to."""

    unit = ""

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        self.number = QLineEdit(number_text(edit.value), self)
        self.number.setAccessibleName(title)
        self.number.selectAll()
        self.number.textEdited.connect(self._on_typed)
        self.number.installEventFilter(self)
        self.result = QLabel(result_text(self.number.text()), self)
        self.column.addLayout(in_row((self.number, 1), QLabel(self.unit, self), self.result))

    def first(self) -> Widget:
        """The number has the keyboard."""
        return self.number

    @property
    def now(self) -> float:
        """The number that the field holds."""
        try:
            return float(number_of(self.edit.value))
        except (ArithmeticRefused, TypeError):
            return 0.0

    def point(self, value: float) -> None:
        """Take a number that was pointed at."""
        number = typed_number(f"{value:.10g}")
        if self.try_set(number):
            self.number.setText(number_text(number))
            self.result.setText("")
            self.show_number()

    def show_number(self) -> None:
        """Let what is pointed at follow the number."""

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Up and Down count, with Shift by ten."""
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            step = {Qt.Key.Key_Up: 1, Qt.Key.Key_Down: -1}.get(Qt.Key(event.key()))
            if step is not None:
                by = 10 if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else 1
                self.point(self.limited(float(stepped(self.edit.value, step * by))))
                return True
        return super().eventFilter(watched, event)

    def limited(self, value: float) -> float:
        """A number that the slot takes."""
        slot = self.edit.slot
        if slot.low is not None and slot.high is not None:
            return min(max(value, slot.low), slot.high)
        return max(value, slot.kind.lowest)

    def _on_typed(self, text: str) -> None:
        self.result.setText(result_text(text))
        if self.try_set(typed_number(text)):
            self.show_number()


class SliderPopup(NumberPopup):
    """A number between two ends, on a slider."""

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        self._low = edit.slot.low if edit.slot.low is not None else 0.0
        self._high = edit.slot.high if edit.slot.high is not None else 100.0
        span = self._high - self._low
        self._steps = round(span) if span >= 20 and span.is_integer() else _STEPS
        self.slider = QSlider(Qt.Orientation.Horizontal, self)
        self.slider.setRange(0, self._steps)
        self.slider.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.slider.setAccessibleName(title)
        self.slider.setMinimumWidth(14 * self.line)
        self.show_number()
        self.slider.valueChanged.connect(self._on_slid)
        low, high = (QLabel(number_text(end), self) for end in (self._low, self._high))
        self.column.addLayout(in_row(low, (self.slider, 1), high))

    def show_number(self) -> None:
        """Put the slider where the number is."""
        share = (self.now - self._low) / (self._high - self._low)
        with QSignalBlocker(self.slider):
            self.slider.setValue(round(share * self._steps))

    def _on_slid(self, step: int) -> None:
        self.point(self._low + (self._high - self._low) * step / self._steps)


class DurationPopup(NumberPopup):
    """A time in seconds, with times that are often wanted."""

    unit = "s"

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        grid = QGridLayout()
        grid.setSpacing(self.line // 3)
        self.quick: list[QPushButton] = []
        for place, seconds in enumerate(QUICK_SECONDS):
            shown = tr("1 min") if seconds == 60 else f"{seconds:g} s"
            button = QPushButton(shown, self)
            button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            button.setAccessibleName(tr("{n} seconds", n=f"{seconds:g}"))
            button.clicked.connect(lambda _=False, s=seconds: self._on_quick(s))
            grid.addWidget(button, place // 4, place % 4)
            self.quick.append(button)
        self.column.addLayout(grid)

    def _on_quick(self, seconds: float) -> None:
        self.point(seconds)
        self._editors.close()


NUMBERS: dict[str, type[FieldPopup]] = {"slider": SliderPopup, "duration": DurationPopup}
"""The editors of this file, by the kind of field."""
