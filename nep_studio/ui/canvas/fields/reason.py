"""Says below a field why what is typed in it does not fit."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QWidget

from nep_studio.ui.theme import Theme, icon_pixmap
from nep_studio.ui.words import tr


class ReasonBubble(QFrame):
    """An icon and a sentence in a red frame; hidden while there is no reason."""

    def __init__(self, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("reason")
        self._line = self.fontMetrics().height()
        error, text = theme.colour("error"), theme.colour("text").name()
        width = max(2, self._line // 9)
        self.setStyleSheet(
            f"#reason {{ background: {theme.colour('error_panel').name()};"
            f" border: {width}px solid {error.name()}; border-radius: {self._line // 3}px; }}"
            f"#reason QLabel {{ color: {text}; background: transparent; border: none; }}"
        )
        sign = QLabel(self)
        sign.setPixmap(icon_pixmap("circle-alert", error, self._line, self.devicePixelRatioF()))
        self.words = QLabel(self)
        self.words.setWordWrap(True)
        row = QHBoxLayout(self)
        row.setContentsMargins(*(self._line // 3,) * 4)
        row.addWidget(sign, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(self.words, 1)
        self.hide()

    @property
    def text(self) -> str:
        """The sentence that is shown, or nothing."""
        return self.words.text() if not self.isHidden() else ""

    def tell(self, reason: str) -> None:
        """Show a sentence; an empty one takes the bubble away."""
        reason = tr(reason)
        self.words.setText(reason)
        self.setAccessibleName(reason)
        self.setVisible(bool(reason))
        if reason:
            widest = 16 * self._line
            needed = self.words.fontMetrics().horizontalAdvance(reason) + self._line
            self.words.setMinimumWidth(min(widest, needed))
            self.words.setMinimumHeight(self.words.heightForWidth(min(widest, needed)))
            self.adjustSize()
