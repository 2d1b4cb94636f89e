"""The open project as panels hear of it: each change soon after, and its cues."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from nep_studio.blocks.edits.content import SetExtra
from nep_studio.project.triggers import KEY, Cue, arranged, cues_of, kept_cues, to_keep
from nep_studio.ui.edits import Edits, edits_of
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.blocks.editor import Editor
    from nep_studio.ui.document_files import Files
    from nep_studio.ui.documents import Document


class ProjectEar(QObject):
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


class ProjectCues(QObject):
    """``changed`` tells, soon after, that they may be others."""

    changed = Signal()

    def __init__(self, files: Files, parent: QObject) -> None:
        super().__init__(parent)
        self._ear = ProjectEar(files, self)
        self._ear.changed.connect(self.changed)

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
