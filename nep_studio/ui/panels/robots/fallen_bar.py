"""Says that a robot has fallen, and offers to help it up."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton

from nep_studio.ui.theme import Look, icon, icon_pixmap
from nep_studio.ui.words import tr

from .facts import wrapped


class FallenBar(QFrame):
    """A sign, a word and a button; seen only while the robot lies there."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.setProperty("kind", "warning")
        self.sign = QLabel()
        self.words = QLabel(tr("It has fallen."))
        self.words.setWordWrap(True)
        self.words.setSizePolicy(wrapped())
        self.help_button = QPushButton(tr("Help it up"))
        self.help_button.setToolTip(tr("Let it stand up again"))
        row = QHBoxLayout(self)
        line = self.fontMetrics().height()
        row.setContentsMargins(line // 3, line // 4, line // 3, line // 4)
        row.addWidget(self.sign, 0, Qt.AlignmentFlag.AlignVCenter)
        row.addWidget(self.words, 1)
        row.addWidget(self.help_button)
        self.hide()
        look.theme_changed.connect(self._dress)
        self._dress()

    def _dress(self) -> None:
        theme, line = self._look.theme, self.fontMetrics().height()
        colour = theme.colour("warning")
        ratio = self.devicePixelRatioF()
        self.sign.setPixmap(icon_pixmap("triangle-alert", colour, line, ratio))
        self.help_button.setIcon(icon("arrow-up", theme))
