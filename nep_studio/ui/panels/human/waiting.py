"""What the open program waits for: a button for each."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtWidgets import QLabel, QVBoxLayout, QWidget

from nep_core.words import plain
from nep_studio.happenings import Happening
from nep_studio.ui.panels.flow import FlowLayout
from nep_studio.ui.theme import Look

from .buttons import HappeningButton
from .words import words_of


class WaitingBoard(QWidget):
    """Buttons in rows; what needs no hand is said in words below them."""

    def __init__(
        self,
        look: Look,
        begin: Callable[[Happening], bool],
        end: Callable[[Happening], None],
        nothing: str,
    ) -> None:
        super().__init__()
        self._look, self._begin, self._end, self._nothing = look, begin, end, nothing
        self._shown: list[Happening] | None = None
        self.buttons: list[HappeningButton] = []
        self._rows = QWidget()
        self._flow = FlowLayout(self._rows, self.fontMetrics().height() // 3)
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.words.setProperty("role", "hint")
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addWidget(self._rows)
        box.addWidget(self.words)

    def show_happenings(self, happenings: list[Happening], here: dict[str, str]) -> None:
        """Show these; ``here`` are the visitors that are there now, with their names."""
        if happenings != self._shown:
            self._shown = happenings
            self._make_buttons([one for one in happenings if one.kind != "idle"])
            idle = [words_of(one) for one in happenings if one.kind == "idle"]
            nothing = "" if happenings else self._nothing
            self.words.setText("\n".join([*idle, *filter(None, [nothing])]))
            self.words.setVisible(bool(self.words.text()))
        for button in self.buttons:
            if button.isCheckable():
                button.setChecked(_is_here(button.happening, here))

    def _make_buttons(self, happenings: list[Happening]) -> None:
        for button in self.buttons:
            button.let_go()
            self._flow.removeWidget(button)
            button.hide()
            button.deleteLater()
        self.buttons = [
            HappeningButton(one, self._look, self._begin, self._end) for one in happenings
        ]
        for button in self.buttons:
            self._flow.addWidget(button)
            button.show()  # now: Qt would show it later, and not make room for it then
        self._rows.setVisible(bool(self.buttons))


def _is_here(happening: Happening, here: dict[str, str]) -> bool:
    if happening.kind not in here:
        return False
    return not happening.value or plain(happening.value) == plain(here[happening.kind])
