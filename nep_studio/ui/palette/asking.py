"""A small window that asks for a name, or whether something is to be done."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QFrame, QVBoxLayout, QWidget

from nep_studio.blocks.errors import EditRefused
from nep_studio.ui.canvas.fields.question import Question
from nep_studio.ui.canvas.fields.reason import ReasonBubble
from nep_studio.ui.screens import room_around
from nep_studio.ui.theme import Theme


class Asking(QFrame):
    """Asks over a widget; what the answer does may refuse it, and the window says why."""

    def __init__(
        self,
        over: QWidget,
        theme: Theme,
        words: str,
        yes: str,
        answer: Callable[[str], object],
        name: str | None = None,
    ) -> None:
        super().__init__(over, Qt.WindowType.Popup)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setAccessibleName(words)
        self.setObjectName("asking")
        self.setStyleSheet(
            f"#asking {{ background: {theme.colour('menu').name()};"
            f" border: 1px solid {theme.colour('field_line').name()}; }}"
        )
        self._answer = answer
        self.question = Question(
            words, yes, answered=self._on_answered, refused=self._on_refused, name=name
        )
        self.reason = ReasonBubble(theme, self)
        column = QVBoxLayout(self)
        column.addWidget(self.question)
        column.addWidget(self.reason)
        self.setMinimumWidth(self.fontMetrics().averageCharWidth() * 38)

    def show_at(self, place: QPoint) -> None:
        """Show at a place of the screen, inside the screen."""
        self.adjustSize()
        room = room_around(self.parentWidget())
        x = min(max(place.x(), room.left()), room.right() - self.width())
        y = min(max(place.y(), room.top()), room.bottom() - self.height())
        self.move(x, y)
        self.show()
        self.question.first().setFocus(Qt.FocusReason.PopupFocusReason)

    def _on_refused(self) -> None:
        self.close()

    def _on_answered(self, name: str) -> None:
        try:
            self._answer(name)
        except EditRefused as refusal:
            self.reason.tell(refusal.sentence)
            self.adjustSize()
            return
        self.close()
