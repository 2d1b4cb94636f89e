"""The project that is open, whichever that is, for who wants to hear each of its changes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from .edits import Edits, edits_of

if TYPE_CHECKING:
    from nep_studio.blocks.editor import Editor
    from nep_studio.ui.document_files import Files
    from nep_studio.ui.documents import Document


class OpenProject(QObject):
    """``changed`` tells that the open project is another, or, soon after, that it was edited."""

    changed = Signal()

    def __init__(self, files: Files, parent: QObject) -> None:
        super().__init__(parent)
        self._edits: Edits | None = None
        self.editor: Editor | None = None
        """What edits the open project; None when there is none."""
        files.document_changed.connect(self._on_document_changed)
        self._on_document_changed(files.document)

    def _on_document_changed(self, document: Document | None) -> None:
        if self._edits is not None:
            self._edits.settled.disconnect(self.changed)
        self.editor = None if document is None else document.editor
        self._edits = None if self.editor is None else edits_of(self.editor)
        if self._edits is not None:
            self._edits.settled.connect(self.changed)
        self.changed.emit()
