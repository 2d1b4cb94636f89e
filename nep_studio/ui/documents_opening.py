"""Reads a project from a file: a large one beside the window's work, so that nothing freezes."""

from __future__ import annotations

import logging
import threading
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from nep_studio.blocks.errors import BlocksError, ProjectFileError
from nep_studio.blocks.files import load
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.blocks.reading import from_bytes
from nep_studio.ui.documents_choosing import PICTURES
from nep_studio.ui.picture.reading import project_bytes_from

log = logging.getLogger(__name__)

LARGE_BYTES = 400_000
"""What is smaller is read in less than a tenth of a second."""

SLOW_MS = 500
"""After this time the person is shown that the file is being read, and can stop it."""


class Opening(QObject):
    """One file that is being read. Exactly one of ``opened`` and ``failed`` comes, or neither
    when it is cancelled."""

    opened = Signal(object)  # the Project
    failed = Signal(object)  # the BlocksError
    became_slow = Signal()
    _read = Signal(object)

    def __init__(self, path: Path, language: Language, parent: QObject) -> None:
        super().__init__(parent)
        self.path = path
        self._language = language
        self._is_over = False
        self._slow = QTimer(self, singleShot=True, interval=SLOW_MS)
        self._slow.timeout.connect(self.became_slow)
        self._read.connect(self._on_read)

    def start(self) -> None:
        """Read it; a small file is there at once."""
        if not _is_large(self.path):
            self._on_read(_result(self.path, self._language))
            return
        self._slow.start()
        threading.Thread(target=self._work, name="opening", daemon=True).start()

    def cancel(self) -> None:
        """Do not open it: what is still being read is forgotten."""
        self._end()

    def _work(self) -> None:
        result = _result(self.path, self._language)
        try:
            self._read.emit(result)
        except RuntimeError:
            log.info("The window has gone before %s was read.", self.path)

    def _on_read(self, result: Project | BlocksError) -> None:
        if self._is_over:
            return
        self._end()
        if isinstance(result, BlocksError):
            self.failed.emit(result)
        else:
            self.opened.emit(result)

    def _end(self) -> None:
        self._is_over = True
        self._slow.stop()


def _result(path: Path, language: Language) -> Project | BlocksError:
    try:
        return (
            _project_in_picture(path, language)
            if path.suffix.lower() in PICTURES
            else load(path, language)
        )
    except BlocksError as error:
        return error


def _project_in_picture(path: Path, language: Language) -> Project:
    """The project inside a picture that this program has made; raises ProjectFileError."""
    data = project_bytes_from(path)
    if data is None:
        raise ProjectFileError(
            f"There is no project in the picture {path.name}.",
            checklist=("Choose a picture that was exported with the program inside.",),
        )
    return from_bytes(data, path.name, language)


def _is_large(path: Path) -> bool:
    try:
        return path.stat().st_size > LARGE_BYTES
    except OSError:
        return False
