"""A part of a panel with a heading, which can be folded away."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSizePolicy, QToolButton, QVBoxLayout, QWidget

from nep_studio.ui.actions_icons import icon_room
from nep_studio.ui.theme import Look, icon
from nep_studio.ui.words import tr


class Section(QWidget):
    """A heading that folds, and a box below it."""

    def __init__(self, title: str, look: Look, *, is_open: bool = True) -> None:
        super().__init__()
        self._look, self.is_open = look, is_open
        self.heading = QToolButton()
        self.heading.setText(title)
        self.heading.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.heading.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.body = QWidget()
        self.box = QVBoxLayout(self.body)
        line = self.fontMetrics().height()
        self.box.setContentsMargins(line // 2, 0, 0, line // 2)
        self.box.setSpacing(line // 3)
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.setSpacing(line // 6)
        outer.addWidget(self.heading)
        outer.addWidget(self.body)
        self.heading.clicked.connect(lambda: self.open(not self.is_open))
        look.theme_changed.connect(self._dress)
        self.open(is_open)

    def open(self, is_open: bool) -> None:
        """Show or fold away what is in it."""
        self.is_open = is_open
        self.body.setVisible(is_open)
        self.heading.setAccessibleDescription(tr("open") if is_open else tr("folded"))
        self._dress()

    def _dress(self) -> None:
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        folded = "chevron-left" if is_mirrored else "chevron-right"
        name = "chevron-down" if self.is_open else folded
        font = self.font()
        font.setBold(True)
        self.heading.setFont(font)
        self.heading.setIcon(icon(name, self._look.theme))
        self.heading.setIconSize(icon_room(self.fontMetrics().height()))
