"""Asks for files: recordings to play, places for what is exported."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QWidget

from nep_studio.ui.words import tr

OnChosen = Callable[[Path], object]


class SensorFiles:
    """Asks with the system's dialogs; nothing is called when the person thinks better of it."""

    def choose_recording(self, parent: QWidget, folder: Path, on_chosen: OnChosen) -> None:
        """Ask which recording to play."""
        dialog = QFileDialog(parent, tr("Replay a recording"), str(folder))
        dialog.setNameFilters([tr("Recordings (*.csv)"), tr("All files (*)")])
        dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
        _open(dialog, on_chosen)

    def choose_place(
        self, parent: QWidget, suggested: Path, kind: str, on_chosen: OnChosen
    ) -> None:
        """Ask where a file is to be kept; ``kind`` says in words what it is."""
        dialog = QFileDialog(parent, tr("Export"), str(suggested.parent))
        dialog.setNameFilters([f"{kind} (*{suggested.suffix})", tr("All files (*)")])
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix(suggested.suffix.removeprefix("."))
        dialog.selectFile(suggested.name)
        _open(dialog, on_chosen)

    def choose_folder(self, parent: QWidget, folder: Path, on_chosen: OnChosen) -> None:
        """Ask for the folder of recordings."""
        dialog = QFileDialog(parent, tr("Choose a folder for recordings"), str(folder))
        dialog.setFileMode(QFileDialog.FileMode.Directory)
        dialog.setOption(QFileDialog.Option.ShowDirsOnly)
        _open(dialog, on_chosen)


def _open(dialog: QFileDialog, on_chosen: OnChosen) -> None:
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.fileSelected.connect(lambda name: on_chosen(Path(name)))
    dialog.open()
