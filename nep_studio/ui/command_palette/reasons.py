"""Why an action cannot be used now, in a sentence that says what to do."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtGui import QAction

from nep_studio.ui.actions_edit import NEEDS_SELECTION
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow

WHY_NOT = "why_not"
"""An action may carry its own sentence in this property of Qt."""


def why_not(window: MainWindow, action: QAction) -> str:
    """Why an action cannot be used now, "" when it can."""
    if action.isEnabled():
        return ""
    own = action.property(WHY_NOT)
    if isinstance(own, str) and own:
        return own
    name = action.objectName()
    if window.files.document is None:
        return tr("Open a project first.")
    if name in NEEDS_SELECTION:
        return tr("Select a block first.")
    return _reasons().get(name) or tr("There is nothing to do for it now.")


def _reasons() -> dict[str, str]:
    return {
        "undo": tr("Nothing has been changed yet."),
        "redo": tr("Nothing has been taken back."),
        "paste": tr("Copy something first."),
        "compare": tr("The project is saved as it is now."),
        "stop": tr("Nothing runs now."),
        "pause": tr("Nothing runs now."),
        "step": tr("Pause the program first."),
        "run": tr("The program runs already."),
    }
