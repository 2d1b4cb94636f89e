"""A project that is dragged onto the window is opened."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QEvent, QObject
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QWidget

from nep_studio.ui.documents import SUFFIX
from nep_studio.ui.documents_opening import PICTURES


class ProjectDrops(QObject):
    """Takes projects, and pictures with a project in them, for a window."""

    def __init__(self, window: QWidget, open_project: Callable[[Path], object]) -> None:
        super().__init__(window)
        self._open = open_project
        window.setAcceptDrops(True)
        window.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Take what can be opened."""
        if isinstance(event, QDragEnterEvent) and project_in(event) is not None:
            event.acceptProposedAction()
            return True
        if type(event) is QDropEvent and (path := project_in(event)) is not None:
            event.acceptProposedAction()
            self._open(path)
            return True
        return super().eventFilter(watched, event)


def project_in(event: QDropEvent) -> Path | None:
    """The project among what is dragged."""
    files = [Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()]
    return next((file for file in files if file.suffix.lower() in (SUFFIX, *PICTURES)), None)
