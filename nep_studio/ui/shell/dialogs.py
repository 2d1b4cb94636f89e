"""The dialogs that the main window's actions open; none of them is loaded before."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio import settings
from nep_studio.support import safe_mode

if TYPE_CHECKING:
    from .main_window import MainWindow


def open_settings(window: MainWindow) -> None:
    """Show the settings."""
    from .settings_dialog import SettingsDialog

    document = window.files.document
    project = document.path if document is not None else None
    dialog = SettingsDialog(window.studio, window, project=project)
    dialog.reset_button.clicked.connect(window.reset_panels)
    dialog.open()


def show_shortcuts(window: MainWindow) -> None:
    """Show what the keys do."""
    from nep_studio.ui.actions import on_the_canvas, shortcuts_of

    from .help_dialogs import ShortcutsDialog

    rows = [*shortcuts_of(window.actions_by_name.by_name.values()), *on_the_canvas()]
    ShortcutsDialog(rows, window).open()


def show_about(window: MainWindow) -> None:
    """Say what this program is."""
    from .help_dialogs import AboutDialog

    AboutDialog(window).open()


def show_report(window: MainWindow) -> None:
    """Show what can be sent to those who help."""
    from .support import SupportDialog

    window.settings.write()  # the report reads the file
    SupportDialog(window, folder=window.settings.last_folder).open()


def offer_recovery(window: MainWindow) -> None:
    """Offer work that was not saved when the program ended without warning."""
    folder = settings.journal_folder()
    if safe_mode.is_on():
        return  # reading it may be what ends the program; the next usual start offers it
    if not any(folder.glob("*-*")):
        return
    from nep_studio.project.journal import recover

    found = recover(folder, window.studio.language)
    if found:
        from .support import RecoveryDialog

        RecoveryDialog(found, window.studio, window.files.restore, window).open()
