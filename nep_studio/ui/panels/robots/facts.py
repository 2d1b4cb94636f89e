"""What is known of a robot, in short lines: a sign and words."""

from __future__ import annotations

import re

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QGridLayout, QLabel, QWidget

from nep_core.messages import RobotState
from nep_studio.blocks.language import Language
from nep_studio.ui.theme import Look, icon_pixmap
from nep_studio.ui.words import tr

LOW_BATTERY = 0.2


class Facts(QWidget):
    """Rows of a sign and words; a row without words takes no room."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self._rows: dict[str, tuple[QLabel, QLabel]] = {}
        self._shown: dict[str, tuple[str, str, str]] = {}
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setColumnStretch(1, 1)
        look.theme_changed.connect(self._dress)

    def show_fact(self, name: str, icon_name: str, words: str, colour: str = "muted") -> None:
        """Show a fact; ``name`` is the same each time that it is told anew."""
        if self._shown.get(name) == (icon_name, words, colour):
            return
        self._shown[name] = (icon_name, words, colour)
        sign, label = self._rows.get(name) or self._add_row(name)
        sign.setVisible(bool(words))
        label.setVisible(bool(words))
        label.setText(words)
        self._dress_row(name)

    def text(self) -> str:
        """All facts as sentences, for screen readers."""
        return " ".join(f"{words}." for _, words, _ in self._shown.values() if words)

    def _add_row(self, name: str) -> tuple[QLabel, QLabel]:
        row = len(self._rows)
        sign, label = QLabel(), QLabel()
        label.setWordWrap(True)
        label.setTextFormat(Qt.TextFormat.PlainText)
        self._grid.addWidget(sign, row, 0, Qt.AlignmentFlag.AlignTop)
        self._grid.addWidget(label, row, 1)
        self._rows[name] = (sign, label)
        return sign, label

    def _dress(self) -> None:
        for name in self._rows:
            self._dress_row(name)

    def _dress_row(self, name: str) -> None:
        icon_name, _, colour = self._shown[name]
        side, ratio = self.fontMetrics().height(), self.devicePixelRatioF()
        pixmap = icon_pixmap(icon_name, self._look.theme.colour(colour), side, ratio)
        self._rows[name][0].setPixmap(pixmap)


def show_state(facts: Facts, state: RobotState, language: Language) -> None:
    """Show posture, movement, battery and what it listens for."""
    facts.show_fact("posture", "person-standing", posture_words(state.posture, language))
    moves = tr("Moves") if state.moving else tr("At rest")
    facts.show_fact("moving", "footprints" if state.moving else "pause", moves)
    is_low = state.battery < LOW_BATTERY
    percent = f"{state.battery:.0%}"
    battery = tr("Battery {percent}", percent=percent)
    if is_low:
        battery = tr("Battery {percent}: charge it soon", percent=percent)
    facts.show_fact("battery", "battery-medium", battery, "warning" if is_low else "muted")
    heard = tr(" or ").join(f"“{word}”" for word in state.listening)
    facts.show_fact("listening", "ear", tr("Listens for {words}", words=heard) if heard else "")


def posture_words(posture: str, language: Language) -> str:
    """A posture, as the robot names it, in words: "LyingBack" is “lying on the back”."""
    if not posture:
        return ""
    key = "posture" + re.sub("[A-Z]", lambda found: f"_{found.group().lower()}", posture)
    words = language.choices.get("postures", {}).get(key, posture)
    return tr("Posture: {posture}", posture=words)
