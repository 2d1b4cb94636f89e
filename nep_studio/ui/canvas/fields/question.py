"""A question inside a popup: a name to type, or something to agree to."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QPushButton, QVBoxLayout, QWidget

from nep_studio.ui.words import tr


class Question(QWidget):
    """Words, a line to type in where a name is asked for, and two buttons."""

    def __init__(
        self,
        words: str,
        yes: str,
        *,
        answered: Callable[[str], None],
        refused: Callable[[], None],
        name: str | None = None,
    ) -> None:
        super().__init__()
        self._answered, self._refused = answered, refused
        self.words = words
        label = QLabel(words, self)
        label.setWordWrap(True)
        width = 15 * self.fontMetrics().height()
        label.setFixedWidth(width)
        label.setFixedHeight(label.heightForWidth(width))
        self.name = QLineEdit(name or "", self)
        self.name.setAccessibleName(words)
        self.name.setVisible(name is not None)
        self.name.selectAll()
        self.yes, self.no = QPushButton(yes, self), QPushButton(tr("Cancel"), self)
        self.yes.setProperty("kind", "primary" if name is not None else "stop")
        self.yes.clicked.connect(self._on_yes)
        self.no.clicked.connect(refused)
        buttons = QHBoxLayout()
        buttons.addStretch(1)
        buttons.addWidget(self.no)
        buttons.addWidget(self.yes)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(label)
        column.addWidget(self.name)
        column.addLayout(buttons)

    def first(self) -> QWidget:
        """The widget that has the keyboard at the start."""
        return self.no if self.name.isHidden() else self.name

    def focusNextPrevChild(self, forward: bool) -> bool:
        """Tab goes round inside the question."""
        order = [w for w in (self.name, self.no, self.yes) if not w.isHidden()]
        here = self.focusWidget()
        at = order.index(here) if here in order else 0
        order[(at + (1 if forward else -1)) % len(order)].setFocus(Qt.FocusReason.TabFocusReason)
        return True

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter agrees (or presses the button it is on), Esc does not."""
        if event.key() == Qt.Key.Key_Escape:
            self._refused()
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            if self.no.hasFocus():
                self._refused()
            else:
                self._on_yes()
        else:
            super().keyPressEvent(event)

    def _on_yes(self) -> None:
        self._answered(self.name.text())
