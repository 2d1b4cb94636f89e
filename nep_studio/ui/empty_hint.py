"""What an empty page says: what belongs there, and how one begins."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtWidgets import QLabel, QWidget

from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.words import tr

WIDEST_LINES = 22
"""How wide the words may be, in lines of text."""


class EmptyHint(QLabel):
    """Words in the middle of a page on which there is nothing yet; the mouse goes through."""

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas.viewport())
        self._canvas = canvas
        self.setWordWrap(True)
        self.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.setProperty("role", "hint")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        canvas.layout_changed.connect(self._show_or_hide)
        canvas.page_changed.connect(self.refresh)
        canvas.viewport().installEventFilter(self)
        self.refresh()

    def refresh(self) -> None:
        """Take the words for the page that is shown."""
        project, page = self._canvas.editor.project, self._canvas.page
        belongs = {
            "robots": tr("Here you say which robots take part."),
            "nodes": tr("Here you say which nodes run. The program finds most by itself."),
        }
        first = belongs.get(project.kind_of_page(page), "")
        how = tr("Drag a block here, or press / and type what should happen.")
        self.setText(f"{first}\n{how}".strip())
        self._show_or_hide()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Stay in the middle."""
        if event.type() == QEvent.Type.Resize:
            self._take_place()
        return super().eventFilter(watched, event)

    def _show_or_hide(self) -> None:
        project, page = self._canvas.editor.project, self._canvas.page
        has_notes = any(note.page == page for note in project.notes.values())
        self.setVisible(not project.pages.get(page) and not has_notes)
        self._take_place()

    def _take_place(self) -> None:
        view: QWidget = self._canvas.viewport()
        wide = min(self.fontMetrics().height() * WIDEST_LINES, view.width() - 16)
        self.resize(wide, self.heightForWidth(wide))
        self.move((view.width() - wide) // 2, max(0, view.height() * 2 // 5 - self.height() // 2))
