"""The one-time code, large, with the time for which it still holds."""

from __future__ import annotations

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QFont, QFontMetrics, QHideEvent, QShowEvent
from PySide6.QtWidgets import QFrame, QPushButton, QVBoxLayout, QWidget

from nep_studio.sharing import Sharing
from nep_studio.ui.messages import announce
from nep_studio.ui.theme import Look
from nep_studio.ui.watches.questions import hint
from nep_studio.ui.watches.steps_list import CopyLine
from nep_studio.ui.words import tr

LOOK_MS = 500
TIMES_LARGER = 2.2


class CodeView(QFrame):
    """``is_over`` comes when the code is used, used up, or too old; a new one is asked for here."""

    is_over = Signal()

    def __init__(self, sharing: Sharing, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._sharing = sharing
        self._shown = ""
        self.setProperty("kind", "card")
        self.line = CopyLine(look, tr("Copy the code"))
        self.line.text.setAccessibleName(tr("Code"))
        self.left = hint("")
        self.new_button = QPushButton(tr("New code"))
        self.new_button.setAutoDefault(False)
        self._lay_out()
        self._looking = QTimer(self, interval=LOOK_MS)
        self._looking.timeout.connect(self.refresh)
        self.new_button.clicked.connect(sharing.new_code)
        sharing.changed.connect(self.refresh)
        self.refresh()

    def _lay_out(self) -> None:
        font = QFont(self.font())
        font.setPixelSize(round(self.fontMetrics().height() * TIMES_LARGER * 0.75))
        font.setBold(True)
        self.line.text.setFont(font)
        high = round(QFontMetrics(font).height() * 1.15)
        self.line.text.setStyleSheet(f"min-height: {high}px")  # else the theme wins
        line = self.fontMetrics().height()
        box = QVBoxLayout(self)
        box.setContentsMargins(line, line // 2, line, line // 2)
        for widget in (self.line, self.left, self.new_button):
            box.addWidget(widget)
        box.setAlignment(self.new_button, Qt.AlignmentFlag.AlignLeading)

    def refresh(self) -> None:
        """Show the code that holds now, and how long it still does."""
        code = self._sharing.code
        text = code.text if code is not None else ""
        if text != self._shown:
            is_end = bool(self._shown)
            self._shown = text
            self.line.show_text(text)
            self.line.setEnabled(bool(text))
            announce(self, text)
            if is_end and not text:
                self.is_over.emit()
        if code is None:
            self.left.setText(tr("No code holds now. Make a new one for the next computer."))
            return
        left_s = max(0, round(code.left_s))
        clock = f"{left_s // 60}:{left_s % 60:02}"
        self.left.setText(tr("It is for one computer, and holds for {time} more.", time=clock))

    def showEvent(self, event: QShowEvent) -> None:
        """Count down."""
        super().showEvent(event)
        self.refresh()
        self._looking.start()

    def hideEvent(self, event: QHideEvent) -> None:
        """Nobody looks."""
        super().hideEvent(event)
        self._looking.stop()
