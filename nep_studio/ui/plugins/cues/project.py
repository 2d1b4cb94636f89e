"""The cues of the project that is open, as they are at the moment."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from nep_studio.blocks.edits.content import SetExtra
from nep_studio.project.triggers import KEY, Cue, arranged, cues_of, kept_cues, to_keep
from nep_studio.ui.open_project import OpenProject
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.document_files import Files

SOON_MS = 200


class ProjectCues(QObject):
    """``changed`` tells, soon after, that they may be others."""

    changed = Signal()

    def __init__(self, files: Files, parent: QObject) -> None:
        super().__init__(parent)
        self._project = OpenProject(files, self, SOON_MS)
        self._project.changed.connect(self.changed)

    @property
    def is_open(self) -> bool:
        """Whether there is a project."""
        return self._project.editor is not None

    def cues(self) -> list[Cue]:
        """The cues, arranged, hidden ones too."""
        editor = self._project.editor
        if editor is None:
            return []
        return arranged(cues_of(editor.project, editor.language), kept_cues(editor.project))

    def keep(self, cues: list[Cue]) -> None:
        """Keep how they are arranged in the project; can be taken back."""
        editor = self._project.editor
        if editor is not None:
            editor.apply(SetExtra(KEY, to_keep(cues)), tr("arrange the cues"))
