"""Asks what is to be done when the last start failed, before anything of the person's is read."""

from __future__ import annotations

from PySide6.QtWidgets import QMessageBox, QPushButton

from nep_studio import safe_mode, settings
from nep_studio.ui import words
from nep_studio.ui.theme import load_fonts
from nep_studio.ui.words import tr


class AfterACrash(QMessageBox):
    """Safe mode, a usual start, or a report; it has no look of ours, which may be the reason."""

    def __init__(self) -> None:
        super().__init__()
        role = QMessageBox.ButtonRole
        self.setIcon(QMessageBox.Icon.Warning)
        self.setWindowTitle("NEP Studio")
        self.setText(tr("NEP Studio did not get through its last start."))
        self.setInformativeText(
            tr(
                "Safe mode leaves out your settings, snippets and own nodes, and the graphics"
                " card. Nothing of it is deleted."
            )
        )
        self.safe_button: QPushButton = self._button(tr("Start in safe mode"), role.AcceptRole)
        self.usual_button: QPushButton = self._button(tr("Start as usual"), role.AcceptRole)
        self.report_button: QPushButton = self._button(tr("Report for support…"), role.ActionRole)
        self.close_button: QPushButton = self._button(tr("Close"), role.RejectRole)
        self.setDefaultButton(self.safe_button)
        self.setEscapeButton(self.close_button)

    def _button(self, text: str, role: QMessageBox.ButtonRole) -> QPushButton:
        button = QPushButton(text)
        self.addButton(button, role)
        return button


def ask() -> bool:
    """Let the person choose; whether to start, in safe mode when they want it."""
    words.use_language(settings.system_language(words.available_languages()))
    load_fonts()  # some computers have no letters of the person's language
    while True:
        box = AfterACrash()
        box.exec()
        if box.clickedButton() is not box.report_button:
            break
        from nep_studio.ui.support.dialog import SupportDialog

        SupportDialog(None).exec()
    if box.clickedButton() is box.safe_button:
        safe_mode.begin()
    return box.clickedButton() in (box.safe_button, box.usual_button)
