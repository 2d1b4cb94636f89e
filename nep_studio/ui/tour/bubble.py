"""The bubble of the tour: what a step says, where one is, and the buttons to go on."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRect, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from nep_studio.ui.start_page_flow import begin_where_reading_begins
from nep_studio.ui.theme import Look
from nep_studio.ui.tour.steps import Step
from nep_studio.ui.words import tr

WIDE_LINES = 19.0
"""How wide it is, in lines of text, where the window has the room."""


class Dots(QWidget):
    """A dot for each step; the present one is filled."""

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self._look = look
        self._number = self._count = 0

    def show_place(self, number: int, count: int) -> None:
        """Say which step of how many this is, from 0."""
        self._number, self._count = number, count
        self.setAccessibleName(tr("Step {number} of {count}", number=number + 1, count=count))
        self.updateGeometry()
        self.update()

    def sizeHint(self) -> QSize:
        """All dots in a row."""
        side = self.fontMetrics().height()
        return QSize(round(side * 0.8 * self._count), side)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the dots, the first where reading begins."""
        side = self.fontMetrics().height()
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        colour = self._look.theme.colour("accent")
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QPen(colour, max(1.0, side / 11)))
            for number in range(self._count):
                x = (number + 0.5) * side * 0.8
                centre = QPoint(round(self.width() - x if is_mirrored else x), self.height() // 2)
                is_filled = number == self._number
                painter.setBrush(colour if is_filled else Qt.BrushStyle.NoBrush)
                radius = round(side * (0.27 if is_filled else 0.2))
                painter.drawEllipse(centre, radius, radius)


class Bubble(QFrame):
    """Says a step; ``forth``, ``back`` and ``left`` are its buttons and keys."""

    forth = Signal()
    back = Signal()
    left = Signal()

    def __init__(self, look: Look, window: QWidget) -> None:
        super().__init__(window)
        self.setProperty("kind", "card")
        self.setAutoFillBackground(True)
        self._title, self._text = QLabel(), QLabel()
        self._dots = Dots(look, self)
        self.next_button, self.back_button = QPushButton(), QPushButton()
        self.leave_button = QPushButton()
        self._arrange()
        self.next_button.clicked.connect(self.forth)
        self.back_button.clicked.connect(self.back)
        self.leave_button.clicked.connect(self.left)
        self.hide()

    def _arrange(self) -> None:
        line = self.fontMetrics().height()
        self._title.setProperty("role", "title")
        for label in (self._title, self._text):
            label.setWordWrap(True)
        self.next_button.setProperty("kind", "primary")
        self.leave_button.setProperty("kind", "quiet")
        row = QHBoxLayout()
        row.setSpacing(line // 3)
        row.addWidget(self.leave_button)
        row.addStretch(1)
        row.addWidget(self.back_button)
        row.addWidget(self.next_button)
        self._box = QVBoxLayout(self)
        self._box.setSpacing(line // 2)
        self._box.setContentsMargins(line, line * 3 // 4, line, line * 3 // 4)
        self._box.addWidget(self._title)
        self._box.addWidget(self._text)
        self._box.addWidget(self._dots)
        self._box.addLayout(row)

    def say(self, step: Step, number: int, count: int) -> None:
        """Show a step, ``number`` of ``count`` from 0."""
        self._title.setText(step.title)
        self._text.setText(step.text)
        for label in (self._title, self._text):
            begin_where_reading_begins(label)
        self._dots.show_place(number, count)
        self.leave_button.setText(tr("End the tour"))
        self.back_button.setText(tr("Back"))
        self.back_button.setEnabled(number > 0)
        self.next_button.setText(tr("Done") if number == count - 1 else tr("Next"))
        self.leave_button.setVisible(number < count - 1)
        self.setAccessibleName(f"{self._dots.accessibleName()}. {step.title}. {step.text}")

    def sit_beside(self, place: QRect, room: QRect) -> None:
        """Take a place beside what is shown, wholly in the room; in its corner if need be."""
        line = self.fontMetrics().height()
        buttons = self._box.minimumSize().width()
        width = min(max(round(line * WIDE_LINES), buttons), room.width() - line)
        self.resize(width, self._box.totalHeightForWidth(width))
        inner = room.adjusted(line // 2, line // 2, -line // 2, -line // 2)
        self.move(self._best_place(place, inner, line).topLeft())

    def _best_place(self, place: QRect, inner: QRect, gap: int) -> QRect:
        size = self.size()
        corner = QRect(inner.bottomRight() - QPoint(size.width(), size.height()), size)
        if self.layoutDirection() == Qt.LayoutDirection.RightToLeft:
            corner.moveLeft(inner.left())
        if place.isEmpty():
            return corner
        middle = QRect(QPoint(0, 0), size)
        middle.moveCenter(place.center())
        sides = [
            middle.translated(0, place.bottom() + gap - middle.top()),
            middle.translated(place.right() + gap - middle.left(), 0),
            middle.translated(place.left() - gap - middle.right(), 0),
            middle.translated(0, place.top() - gap - middle.bottom()),
        ]
        pushed = [_pushed_into(side, inner) for side in sides]
        return next((side for side in pushed if not side.intersects(place)), corner)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc ends the tour."""
        if event.key() == Qt.Key.Key_Escape:
            self.left.emit()
        else:
            super().keyPressEvent(event)


def _pushed_into(rect: QRect, room: QRect) -> QRect:
    x = min(max(rect.x(), room.x()), max(room.x(), room.right() - rect.width()))
    y = min(max(rect.y(), room.y()), max(room.y(), room.bottom() - rect.height()))
    return QRect(QPoint(x, y), rect.size())
