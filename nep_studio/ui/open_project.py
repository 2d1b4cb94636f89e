"""The project that is open, whichever that is, for who wants to hear each of its changes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

from nep_studio.blocks.program import Changes

if TYPE_CHECKING:
    from nep_studio.blocks.editor import Editor
    from nep_studio.ui.document_files import Files
    from nep_studio.ui.documents import Document

SOON_MS = 50


class OpenProject(QObject):
    """``changed`` tells, ``soon_ms`` after, that the project may be another, or was edited."""

    changed = Signal()

    def __init__(self, files: Files, parent: QObject, soon_ms: int = SOON_MS) -> None:
        super().__init__(parent)
        soon = QTimer(self, singleShot=True, interval=soon_ms)
        soon.timeout.connect(self.changed)
        self._followed = _Followed(soon.start)
        self.destroyed.connect(_leaver(self._followed))
        files.document_changed.connect(self._on_document_changed)
        self._on_document_changed(files.document)

    @property
    def editor(self) -> Editor | None:
        """What edits the open project; None when there is none."""
        return self._followed.editor

    def _on_document_changed(self, document: Document | None) -> None:
        self._followed.follow(None if document is None else document.editor)
        self.changed.emit()


class _Followed:
    """One editor at a time; it can be left after its owner is gone."""

    def __init__(self, tell: Callable[[], object]) -> None:
        self.editor: Editor | None = None
        self.tell: Callable[[], object] | None = tell

    def follow(self, editor: Editor | None) -> None:
        if self.editor is not None:
            self.editor.history.unlisten(self._on_changes)
        self.editor = editor
        if editor is not None:
            editor.history.listen(self._on_changes)

    def _on_changes(self, _changes: Changes) -> None:
        if self.tell is not None:
            self.tell()


def _leaver(followed: _Followed) -> Callable[[], None]:
    """What is called when the owner is gone: it must not hold it."""

    def leave() -> None:
        followed.tell = None
        followed.follow(None)

    return leave
