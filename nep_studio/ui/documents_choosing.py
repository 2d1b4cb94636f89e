"""Lets a person choose where a project is, or is to be."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QWidget

from nep_studio.ui.words import tr

SUFFIX = ".nep"
PICTURES = (".png", ".svg")
"""The pictures that may have a project in them."""

OnChosen = Callable[[Path], object]


class FileChooser(Protocol):
    """Asks for a file; nothing is called when the person thinks better of it."""

    def choose_to_open(self, parent: QWidget, folder: Path, on_chosen: OnChosen) -> None:
        """Ask which project to open."""

    def choose_to_save(self, parent: QWidget, suggested: Path, on_chosen: OnChosen) -> None:
        """Ask where to save a project."""


class SystemFileChooser:
    """Asks with the system's own dialog."""

    def choose_to_open(self, parent: QWidget, folder: Path, on_chosen: OnChosen) -> None:
        """Ask which project to open."""
        dialog = _dialog(parent, tr("Open a project"), folder)
        dialog.setNameFilters(
            [tr("Projects, and pictures with one (*.nep *.png *.svg)"), tr("All files (*)")]
        )
        dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
        dialog.fileSelected.connect(lambda name: on_chosen(Path(name)))
        dialog.open()

    def choose_to_save(self, parent: QWidget, suggested: Path, on_chosen: OnChosen) -> None:
        """Ask where to save a project."""
        dialog = _dialog(parent, tr("Save the project as"), suggested.parent)
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix(SUFFIX.removeprefix("."))
        dialog.selectFile(suggested.name)
        dialog.fileSelected.connect(lambda name: on_chosen(Path(name)))
        dialog.open()


def _dialog(parent: QWidget, title: str, folder: Path) -> QFileDialog:
    dialog = QFileDialog(parent, title, str(folder))
    dialog.setNameFilters([tr("NEP Studio projects (*.nep)"), tr("All files (*)")])
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    return dialog
