"""The bubble at a block's badge: what is not right there, what to try, a button that helps."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRect, Qt, Signal
from PySide6.QtGui import QKeyEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QPushButton,
    QStyle,
    QStyleOption,
    QVBoxLayout,
    QWidget,
)

from nep_studio.blocks.checks import Problem
from nep_studio.ui.messages import Message
from nep_studio.ui.messages_card import MessageText
from nep_studio.ui.screens import room_around
from nep_studio.ui.words import tr

from .looks import fix_button

WIDTH_LETTERS = 38


class ProblemBubble(QFrame):
    """Shows the problems of one block; a click elsewhere or Esc takes it away."""

    fix_asked = Signal(object)

    def __init__(self, problems: list[Problem], parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setAttribute(Qt.WidgetAttribute.WA_TranslucentBackground)
        self.setProperty("kind", problems[0].severity)
        self.setAccessibleName(" ".join(tr(problem.sentence) for problem in problems))
        self.setFixedWidth(self.fontMetrics().averageCharWidth() * WIDTH_LETTERS)
        self.buttons: list[QPushButton] = []
        box = self._box = QVBoxLayout(self)
        for problem in problems:
            checklist = tuple(map(tr, problem.checklist))
            box.addWidget(
                MessageText(Message(problem.severity, tr(problem.sentence), "", checklist))
            )
            self._add_fix(problem, box)

    def show_at(self, badge: QRect) -> None:
        """Show it below a badge, given on the screen, but never outside of the screen."""
        width = self.width()
        height = max(self._box.totalHeightForWidth(width), self.minimumSizeHint().height())
        self.resize(width, height)
        room = room_around(self.parentWidget())
        x = min(max(badge.left(), room.left()), room.right() - width)
        below, above = badge.bottom() + 6, badge.top() - height - 6
        self.move(QPoint(x, below if below + height <= room.bottom() else above))
        self.show()
        (self.buttons[0] if self.buttons else self).setFocus(Qt.FocusReason.PopupFocusReason)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the rounded panel: Qt leaves it out of a window whose corners are see-through."""
        option = QStyleOption()
        option.initFrom(self)
        with QPainter(self) as painter:
            self.style().drawPrimitive(QStyle.PrimitiveElement.PE_Widget, option, painter, self)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc takes it away."""
        if event.key() == Qt.Key.Key_Escape:
            self.close()
        else:
            super().keyPressEvent(event)

    def _add_fix(self, problem: Problem, box: QVBoxLayout) -> None:
        button = fix_button(problem)
        if button is None:
            return
        button.clicked.connect(self.close)
        button.clicked.connect(lambda: self.fix_asked.emit(problem))
        self.buttons.append(button)
        row = QHBoxLayout()
        row.addWidget(button)
        row.addStretch(1)
        box.addLayout(row)
