"""The page of an open network: the code, who is let in, who was not."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QPushButton, QWidget

from nep_studio.sharing import Sharing
from nep_studio.ui.theme import Look
from nep_studio.ui.watches.questions import column_in, hint
from nep_studio.ui.watches.steps_list import CopyLine
from nep_studio.ui.words import tr

from .closed_page import words_label
from .code_view import CodeView
from .people import ComputersList, RefusedList


class OpenPage(QWidget):
    """``begin_anew_asked``: connections of a removed computer are to end."""

    begin_anew_asked = Signal()

    def __init__(self, sharing: Sharing, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._sharing = sharing
        self.code = CodeView(sharing, look)
        self.command = CopyLine(look, tr("Copy"), is_long=True)
        self.command.text.setAccessibleName(tr("The command for a terminal"))
        self.found_by = words_label("")
        self.computers, self.refused = ComputersList(), RefusedList()
        self.removed = words_label("")
        self.anew_button = QPushButton(tr("Start everything anew"))
        self.anew_button.setAutoDefault(False)
        self.keep = QCheckBox(tr("Open it again whenever NEP Studio starts"))
        self._lay_out()
        self.computers.remove_asked.connect(self._on_remove)
        self.anew_button.clicked.connect(self.begin_anew_asked)
        sharing.changed.connect(self.refresh)
        self.refresh()

    def _lay_out(self) -> None:
        box = column_in(self)
        box.setSpacing(self.fontMetrics().height() // 2)
        box.addWidget(words_label(tr("The network is open"), "title"))
        box.addWidget(
            words_label(
                tr(
                    "On the other computer open this window too, choose “Join another computer…”"
                    " there, and type this code:"
                )
            )
        )
        box.addWidget(self.code)
        box.addWidget(self.found_by)
        box.addWidget(hint(tr("Where there is no NEP Studio, this does it in a terminal:")))
        box.addWidget(self.command)
        box.addWidget(words_label(tr("Computers that are let in"), "heading"))
        for widget in (self.computers, self.removed, self.anew_button, self.refused, self.keep):
            box.addWidget(widget)
        box.setAlignment(self.anew_button, Qt.AlignmentFlag.AlignLeading)
        box.addStretch(1)

    def refresh(self) -> None:
        """Show how it is now."""
        sharing = self._sharing
        if sharing.opening is None:
            self.removed.hide()
            self.anew_button.hide()
            return
        code = sharing.code
        self.found_by.setText(
            tr("The address of this computer is {address}.", address=sharing.address)
        )
        self.command.show_text(f"nep pair {sharing.address} {code.text}" if code else "")
        self.command.setEnabled(code is not None)
        self.computers.show_computers(sharing.computers)
        self.refused.show_refusals(sharing.refusals.newest_first, sharing.key_path)

    def clear_removed(self) -> None:
        """Nothing is left of computers that were removed."""
        self.removed.hide()
        self.anew_button.hide()

    def _on_remove(self, name: str) -> None:
        self._sharing.remove(name)
        self.removed.setText(
            tr(
                "“{name}” comes in no more. What it is connected with now ends when everything"
                " is started anew.",
                name=name,
            )
        )
        self.removed.show()
        self.anew_button.show()
        self.anew_button.setFocus()
