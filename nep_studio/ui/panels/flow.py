"""Widgets beside each other, in as many rows as they need."""

from __future__ import annotations

from PySide6.QtCore import QSize
from PySide6.QtWidgets import QWidget

from nep_studio.ui.start_page_flow import Flow


class FlowLayout(Flow):
    """Asks for no more width than its widest widget: a panel may be narrow."""

    def __init__(self, parent: QWidget | None = None, gap: int = 4) -> None:
        super().__init__(parent, spacing=gap)

    def sizeHint(self) -> QSize:
        """As narrow as the widest of them."""
        return self.minimumSize()
