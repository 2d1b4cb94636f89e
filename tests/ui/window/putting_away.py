"""How the tests close a main window."""

from __future__ import annotations

from PySide6.QtWidgets import QDialog

from nep_studio.ui.shell.main_window import MainWindow


def put_away(window: MainWindow) -> None:
    """Keep nothing of what is not saved: the window then closes without a question."""
    for dialog in window.findChildren(QDialog):
        dialog.blockSignals(True)
        dialog.close()
    window.hide()  # nobody waits for what it would still paint
    window.workbench.canvas.fields.close()
    window.running.close()
    window.workbench.retire()
    if window.files.document is not None:
        window.files.document.close()
        window.files.document = None
