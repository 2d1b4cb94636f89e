"""Edits of a program as Qt tells them: each at once, and all together once the person pauses."""

from __future__ import annotations

from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary, finalize

from PySide6.QtCore import QCoreApplication, QObject, QTimer, Signal

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Changes

if TYPE_CHECKING:
    from nep_studio.ui.document_files import Files
    from nep_studio.ui.documents import Document


PAUSE_MS = 120
"""Nothing is edited for so long: the person looks at what comes of it."""

LATEST_MS = 400
"""Who edits without a pause sees it all the same."""


class Edits(QObject):
    """What is edited in one program; those who are slow wait together, on one timer.

    ``edited`` gives the Changes of a step at once; ``settled`` those of all steps since the last
    time, when the person pauses.
    """

    edited = Signal(object)
    settled = Signal(object)

    def __init__(self, editor: Editor) -> None:
        super().__init__(QCoreApplication.instance())
        self._gathered = Changes()
        self._pause = QTimer(self, singleShot=True, interval=PAUSE_MS)
        self._latest = QTimer(self, singleShot=True, interval=LATEST_MS)
        self._pause.timeout.connect(self.settle)
        self._latest.timeout.connect(self.settle)
        editor.history.listen(self._on_changes)

    @property
    def is_settled(self) -> bool:
        """Whether everybody knows of everything."""
        return not self._pause.isActive()

    def settle(self) -> None:
        """Tell of all that was edited since the last time, now."""
        self._pause.stop()
        self._latest.stop()
        changes, self._gathered = self._gathered, Changes()
        if changes:
            self.settled.emit(changes)

    def _on_changes(self, changes: Changes) -> None:
        self._gathered.add(changes)
        self.edited.emit(changes)
        self._pause.start()
        if not self._latest.isActive():
            self._latest.start()


_EDITS: WeakKeyDictionary[Editor, Edits] = WeakKeyDictionary()


def edits_of(editor: Editor) -> Edits:
    """The edits of a program; the same for everybody, as long as its editor lives."""
    found = _EDITS.get(editor)
    if found is None:
        found = _EDITS[editor] = Edits(editor)
        # garbage may be collected in any thread: a QObject must not go in another one than its own
        finalize(editor, found.deleteLater).atexit = False
    return found


# The project that is open, whichever that is, for who wants to hear each of its changes.


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
