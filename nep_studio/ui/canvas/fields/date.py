"""A date: a calendar, and the date as it is written."""

from __future__ import annotations

from datetime import date
from typing import TYPE_CHECKING

from PySide6.QtCore import QDate, Qt
from PySide6.QtGui import QTextCharFormat
from PySide6.QtWidgets import QCalendarWidget, QLineEdit, QWidget

from .field_edit import Editing
from .popup import FieldPopup

if TYPE_CHECKING:
    from .editors import FieldEditors


class DatePopup(FieldPopup):
    """Chooses a day."""

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        self.written = QLineEdit(str(edit.value or ""), self)
        self.written.setAccessibleName(title)
        self.written.setPlaceholderText(date.today().isoformat())
        self.written.selectAll()
        self.written.textEdited.connect(self._on_typed)
        self.calendar = QCalendarWidget(self)
        headers = QCalendarWidget.VerticalHeaderFormat
        self.calendar.setVerticalHeaderFormat(headers.NoVerticalHeader)
        self.calendar.setAccessibleName(title)
        self.calendar.setMinimumSize(15 * self.line, 13 * self.line)
        plain = QTextCharFormat()
        plain.setForeground(editors.canvas.theme.colour("text"))
        for day in (Qt.DayOfWeek.Saturday, Qt.DayOfWeek.Sunday):
            self.calendar.setWeekdayTextFormat(day, plain)
        self._show()
        self.calendar.clicked.connect(self._on_day)
        self.calendar.activated.connect(self._on_day)
        self.column.addWidget(self.written)
        self.column.addWidget(self.calendar)

    def first(self) -> QWidget:
        """The date as it is written has the keyboard."""
        return self.written

    def _on_typed(self, text: str) -> None:
        if self.try_set(text.strip()):
            self._show()

    def _on_day(self, day: QDate) -> None:
        if self.try_set(date(day.year(), day.month(), day.day()).isoformat()):
            self._editors.close()

    def _show(self) -> None:
        try:
            day = date.fromisoformat(str(self.edit.value or ""))
        except ValueError:
            return
        self.calendar.setSelectedDate(QDate(day.year, day.month, day.day))
