"""Asks where a text is to be kept, and tells when it cannot be."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QWidget

from nep_studio.settings import usual_folder
from nep_studio.ui.messages import Message, Messages
from nep_studio.ui.words import tr


def save_text(
    window: QWidget,
    messages: Messages,
    name: str,
    save: Callable[[Path], object],
    then: Callable[[Path], object] | None = None,
) -> QFileDialog:
    """Ask for a file, first called ``name``, and ``save`` it; ``then`` follows when it is there."""
    dialog = QFileDialog(window, tr("Save as"), str(usual_folder("projects")))
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
    dialog.setDefaultSuffix(Path(name).suffix.removeprefix("."))
    dialog.selectFile(name)

    def on_chosen(chosen: str) -> None:
        path = Path(chosen)
        if _is_saved(messages, path, save) and then is not None:
            then(path)

    dialog.fileSelected.connect(on_chosen)
    dialog.open()
    return dialog


def _is_saved(messages: Messages, path: Path, save: Callable[[Path], object]) -> bool:
    try:
        save(path)
    except OSError as error:
        reason = tr((error.strerror or str(error)).lower())
        steps = (tr("Is there room on the disk?"), tr("May you write into this folder?"))
        words = tr("{name}: {reason}.", name=path.name, reason=reason)
        title = tr("The file could not be saved")
        messages.tell(Message("error", title, words, steps, str(error)))
        return False
    return True
