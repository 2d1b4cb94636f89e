"""What can be dropped onto the window: a project, or a picture with one in it."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtGui import QDropEvent

from nep_studio.ui.documents_choosing import PICTURES, SUFFIX


def project_in(event: QDropEvent) -> Path | None:
    """The project among what is dragged; the event is then taken."""
    files = [Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()]
    found = next((file for file in files if file.suffix.lower() in (SUFFIX, *PICTURES)), None)
    if found is not None:
        event.acceptProposedAction()
    return found
