"""The cues of the project that is open in a window, as they are at the moment."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.program import Changes
from nep_studio.project.triggers import KEY, Cue, arranged, cues_of, kept_cues, to_keep
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.blocks.editor import Editor
    from nep_studio.ui.document_files import Files
    from nep_studio.ui.documents import Document


SOON_MS = 200


class _Ear:
    """Hears the changes of one editor at a time; it can be left after its owner is gone."""

    def __init__(self) -> None:
        self.editor: Editor | None = None
        self.soon: QTimer | None = None

    def follow(self, editor: Editor | None) -> None:
        self.leave()
        self.editor = editor
        if editor is not None:
            editor.history.listen(self._on_changes)

    def leave(self) -> None:
        if self.editor is not None:
            self.editor.history.unlisten(self._on_changes)
            self.editor = None

    def _on_changes(self, _changes: Changes) -> None:
        if self.soon is not None:
            self.soon.start()


class ProjectCues(QObject):
    """``changed`` tells, soon after, that they may be others."""

    changed = Signal()

    def __init__(self, files: Files, parent: QObject) -> None:
        super().__init__(parent)
        self._files = files
        self._soon = QTimer(self, singleShot=True, interval=SOON_MS)
        self._soon.timeout.connect(self.changed)
        self._ear = _Ear()
        self._ear.soon = self._soon
        self.destroyed.connect(_leaver(self._ear))
        files.document_changed.connect(self._on_document_changed)
        self._on_document_changed(files.document)

    @property
    def is_open(self) -> bool:
        """Whether there is a project."""
        return self._ear.editor is not None

    def cues(self) -> list[Cue]:
        """The cues, arranged, hidden ones too."""
        editor = self._ear.editor
        if editor is None:
            return []
        return arranged(cues_of(editor.project, editor.language), kept_cues(editor.project))

    def keep(self, cues: list[Cue]) -> None:
        """Keep how they are arranged in the project; can be taken back."""
        editor = self._ear.editor
        if editor is not None:
            editor.apply(SetExtra(KEY, to_keep(cues)), tr("arrange the cues"))

    def _on_document_changed(self, document: Document | None) -> None:
        self._ear.follow(None if document is None else document.editor)
        self.changed.emit()


def _leaver(ear: _Ear) -> object:
    """What is called when the owner is gone: it must not hold it."""

    def leave() -> None:
        ear.soon = None
        ear.leave()

    return leave


# Hears each change of the project that is open in a window, whichever that is.

HEAR_SOON_MS = 50


class ProjectEar(QObject):
    """``changed`` tells, soon after, that the project may be another, or was edited."""

    changed = Signal()

    def __init__(self, files: Files, parent: QObject) -> None:
        super().__init__(parent)
        soon = QTimer(self, singleShot=True, interval=HEAR_SOON_MS)
        soon.timeout.connect(self.changed)
        self._followed = _Followed(soon.start)
        self.destroyed.connect(_ear_leaver(self._followed))
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


def _ear_leaver(followed: _Followed) -> Callable[[], None]:
    """What is called when the owner is gone: it must not hold it."""

    def leave() -> None:
        followed.tell = None
        followed.follow(None)

    return leave
