"""The page of the settings about privacy: what the program never does, and updates if wanted."""

from __future__ import annotations

from PySide6.QtWidgets import (
    QCheckBox,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from nep_studio.settings import Settings
from nep_studio.ui.support.asking import Asking
from nep_studio.ui.words import tr
from nep_studio.updates import Newest, UpdateChoice, is_usable


class PrivacyPage(QWidget):
    """Updates are looked for only if a person wants that, at the address that stands here."""

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        self._choice = UpdateChoice(settings)
        self.check = QCheckBox(tr("Ask once a day which version of NEP Studio is the newest"))
        self.address = QLineEdit(self._choice.address)
        self.address.setPlaceholderText("https://")
        self.address.setAccessibleName(tr("Address"))
        self.ask_button = QPushButton(tr("Ask now"))
        self.ask_button.setAutoDefault(False)
        self.state = self._words("")
        hint = tr(
            "NEP Studio tells its own version there, and nothing else. It never changes itself."
        )
        self.hint = self._words(hint, "hint")
        self.unknown = self._words(
            tr(
                "New versions are where you got NEP Studio: it knows no address yet that tells of"
                " them. If you were given one, write it here."
            )
        )
        self._asking = Asking(self)
        self._lay_out()
        self.address.textEdited.connect(self._on_address_edited)
        self.check.toggled.connect(self._on_toggled)
        self.ask_button.clicked.connect(self._on_ask)
        self._asking.answered.connect(self._on_answered)
        self._show()

    def _lay_out(self) -> None:
        box = QVBoxLayout(self)
        line = self.fontMetrics().height()
        box.setContentsMargins(line, line, line, line)
        for words in (
            tr("NEP Studio sends nothing by itself: projects, recordings and logs stay here."),
            tr("What it does on the network is talking to your robots, watches and nodes."),
        ):
            box.addWidget(self._words(words))
        box.addSpacing(line // 2)
        box.addWidget(self.check)
        box.addWidget(self.unknown)
        row = QHBoxLayout()
        label = QLabel(tr("Address"))
        label.setBuddy(self.address)
        row.addWidget(label)
        row.addWidget(self.address, 1)
        row.addWidget(self.ask_button)
        box.addLayout(row)
        box.addWidget(self.hint)
        box.addWidget(self.state)
        box.addStretch(1)

    def _show(self) -> None:
        """Where no address is known, there is nothing to choose, and it says so."""
        has_address = is_usable(self.address.text().strip())
        self.check.blockSignals(True)
        self.check.setChecked(has_address and self._choice.is_wanted)
        self.check.blockSignals(False)
        for part in (self.check, self.ask_button, self.hint):
            part.setVisible(has_address)
        self.unknown.setVisible(not has_address)
        self.ask_button.setEnabled(has_address)
        self.state.clear()

    def _on_address_edited(self, words: str) -> None:
        self._asking.cancel()
        self._choice.address = words
        self._show()

    def _on_toggled(self, is_on: bool) -> None:
        self._choice.is_wanted = is_on

    def _on_ask(self) -> None:
        self.ask_button.setEnabled(False)
        self.state.setText(tr("Asking…"))
        self._choice.note_asked()
        self._asking.begin(self._choice.address)

    def _on_answered(self, newest: Newest | None) -> None:
        self.ask_button.setEnabled(True)
        if newest is None:
            told = tr("No version is told there. Is the address right, and the internet there?")
        elif newest.is_newer:
            told = tr("There is a new version of NEP Studio: {version}", version=newest.version)
        else:
            told = tr("This is the newest version.")
        self.state.setText(told)

    @staticmethod
    def _words(words: str, role: str = "") -> QLabel:
        label = QLabel(words)
        label.setProperty("role", role)
        label.setWordWrap(True)
        return label
