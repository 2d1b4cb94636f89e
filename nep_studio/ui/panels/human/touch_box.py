"""Touching a robot, and making gestures before it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from PySide6.QtWidgets import QHBoxLayout, QLabel, QSpinBox, QVBoxLayout, QWidget

from nep_studio.blocks.language import Language
from nep_studio.happenings import Happening
from nep_studio.ui.panels.flow import FlowLayout
from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr
from nodes.action.naobody.touch import TOUCH_SENSORS

from .buttons import HappeningButton
from .hands import Hands


class TouchBox(QWidget):
    """A button for each place that feels; it is touched as long as the button is held."""

    def __init__(self, hands: Hands, language: Language, look: Look) -> None:
        super().__init__()
        names = language.choices.get("touch_parts", {})
        self.buttons = [
            HappeningButton(
                Happening("touch", part, names.get(part, part)),
                look,
                hands.begin,
                hands.end,
                _capital(names.get(part, part)),
            )
            for part in TOUCH_SENSORS
        ]
        flow = FlowLayout(self, self.fontMetrics().height() // 3)
        for button in self.buttons:
            flow.addWidget(button)


class GestureBox(QWidget):
    """A button for each gesture, and how it comes about."""

    def __init__(self, hands: Hands, language: Language, look: Look) -> None:
        super().__init__()
        self._hands, self._look = hands, look
        self.buttons: list[HappeningButton] = []
        self._shown: dict[str, str] | None = None
        self._rows = QWidget()
        self._flow = FlowLayout(self._rows, self.fontMetrics().height() // 3)
        self.how = QLabel()
        self.how.setWordWrap(True)
        self.how.setProperty("role", "hint")
        self.certainty = QSpinBox()
        self.certainty.setRange(1, 100)
        self.certainty.setValue(100)
        self.certainty.setSuffix(tr(" %"))
        self.certainty.setAccessibleName(tr("How certain the gesture is"))
        self.certainty.valueChanged.connect(self._on_certainty_changed)
        self._certain = QWidget()
        row = QHBoxLayout(self._certain)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(QLabel(tr("Certainty")))
        row.addWidget(self.certainty)
        row.addStretch(1)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addWidget(self._rows)
        box.addWidget(self.how)
        box.addWidget(self._certain)
        self.show_gestures([], language.choices.get("gestures", {}))

    def show_gestures(self, of_program: Iterable[Happening], known: Mapping[str, str]) -> None:
        """Offer the gestures of the program, and all that the watch on the screen knows."""
        wanted = {one.value: one.words for one in of_program if one.kind == "gesture"}
        offered = {**wanted, **known}
        if offered != self._shown:
            self._shown = offered
            self._make_buttons(offered)
        self.refresh()

    def refresh(self) -> None:
        """Say how a gesture comes about now."""
        is_moved = self._hands.has_watch
        by_watch = tr("The watch on the screen makes the movement, which has to be recognised.")
        by_hand = tr("No watch runs: the program is told by hand that the gesture was made.")
        self.how.setText(by_watch if is_moved else by_hand)
        self._certain.setVisible(not is_moved)

    def _make_buttons(self, gestures: dict[str, str]) -> None:
        for button in self.buttons:
            self._flow.removeWidget(button)
            button.hide()
            button.deleteLater()
        self.buttons = [
            HappeningButton(
                Happening("gesture", name, label),
                self._look,
                self._hands.begin,
                self._hands.end,
                _capital(label),
            )
            for name, label in gestures.items()
        ]
        for button in self.buttons:
            self._flow.addWidget(button)
            button.show()

    def _on_certainty_changed(self, percent: int) -> None:
        self._hands.certainty = percent / 100.0


def _capital(words: str) -> str:
    return words[:1].upper() + words[1:]
