"""Labels and signs as the results use them."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QLabel, QSizePolicy, QWidget

from nep_studio.ui.theme import Look, icon_pixmap


class Words(QLabel):
    """Plain words that wrap; ``role`` is heading, hint, or none."""

    def __init__(self, text: str = "", role: str = "", parent: QWidget | None = None) -> None:
        super().__init__(text, parent)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setWordWrap(True)
        self.setMinimumWidth(1)
        if role:
            self.setProperty("role", role)


class Sign(QLabel):
    """An icon in a colour of the theme, as large as the text."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look, self._icon, self._colour = look, "", "text"
        look.theme_changed.connect(self._draw)

    def show_icon(self, name: str, colour: str) -> None:
        """Show this icon; with an empty name, none."""
        if (name, colour) != (self._icon, self._colour):
            self._icon, self._colour = name, colour
            self._draw()

    def _draw(self, _theme: object = None) -> None:
        self.setVisible(bool(self._icon))
        if self._icon:
            size = round(self.fontMetrics().height() * 1.2)
            colour = self._look.theme.colour(self._colour)
            self.setPixmap(icon_pixmap(self._icon, colour, size, self.devicePixelRatioF()))


def card(parent: QWidget | None = None) -> QFrame:
    """A frame around what belongs together."""
    frame = QFrame(parent)
    frame.setProperty("kind", "card")
    frame.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
    return frame
