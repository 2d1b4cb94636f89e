"""A file: its path, and a button that looks for it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QLineEdit, QPushButton, QWidget

from nep_studio.ui.theme.icons import icon
from nep_studio.ui.words import tr

from .field_edit import Editing
from .popup import FieldPopup

if TYPE_CHECKING:
    from .editors import FieldEditors


def short_path(path: Path, folder: Path | None) -> str:
    """A path as seen from the project's folder when it is inside it, always with slashes."""
    if folder is not None and path.is_relative_to(folder):
        path = path.relative_to(folder)
    return path.as_posix()


class FilePopup(FieldPopup):
    """A path to type or to look for."""

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        self.path = QLineEdit(str(edit.value or ""), self)
        self.path.setAccessibleName(title)
        self.path.setMinimumWidth(16 * self.line)
        self.path.selectAll()
        self.path.textEdited.connect(lambda text: self.try_set(text.strip()))
        self.browse = QPushButton(tr("Browse…"), self)
        self.browse.setIcon(icon("folder-open", editors.canvas.theme))
        self.browse.clicked.connect(self._on_browse)
        row = QHBoxLayout()
        row.addWidget(self.path, 1)
        row.addWidget(self.browse)
        self.column.addLayout(row)

    def first(self) -> QWidget:
        """The path has the keyboard."""
        return self.path

    def _on_browse(self) -> None:
        """Ask for the file once the popup is away: it would cover the dialog."""
        editors, place, title = (
            self._editors,
            (self.edit.block, self.edit.key),
            self.accessibleName(),
        )
        editors.close()
        QTimer.singleShot(0, editors, lambda: browse(editors, *place, title))


def browse(editors: FieldEditors, block: str, key: str, title: str) -> None:
    """Let a person look for the file of a field."""
    edit = editors.edit_of(block, key)
    if edit is None:
        return
    folder = editors.project_folder
    start = Path(str(edit.value or ""))
    if folder is not None:
        start = folder / start
    found, _ = QFileDialog.getOpenFileName(editors.canvas, title, str(start))
    if found:
        reason = edit.set(short_path(Path(found), folder))
        edit.end()
        if reason:
            editors.canvas.refused.emit(reason)
