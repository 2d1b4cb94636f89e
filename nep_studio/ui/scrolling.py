"""Pages that scroll when there is no room for all of them."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QScrollArea, QWidget


def scrolled(page: QWidget) -> QScrollArea:
    """Put a page into an area that scrolls up and down."""
    area = QScrollArea()
    area.setWidgetResizable(True)
    area.setFrameShape(QFrame.Shape.NoFrame)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    area.setWidget(page)
    return area


def show_top(area: QScrollArea, shown: QWidget) -> None:
    """Scroll so far that something is seen, of what is too high its beginning."""
    page = area.widget()
    if page is None or not page.isAncestorOf(shown):
        return
    room = area.viewport().height()
    top = shown.mapTo(page, shown.rect().topLeft()).y()
    bar, margin = area.verticalScrollBar(), area.fontMetrics().height() // 2
    bottom = top + shown.height()
    if top < bar.value() or bottom > bar.value() + room:
        is_too_high = shown.height() + margin > room
        bar.setValue(top - margin if is_too_high else bottom + margin - room)
