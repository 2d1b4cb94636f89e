"""What is known of a robot: short facts beside each other, long ones in lines."""

from __future__ import annotations

import re

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QLabel, QSizePolicy, QVBoxLayout, QWidget

from nep_core.messages import RobotState
from nep_studio.blocks.language import Language
from nep_studio.ui.panels.flow import FlowLayout
from nep_studio.ui.theme import Look, icon_pixmap
from nep_studio.ui.words import tr

LOW_BATTERY = 0.2
LONG = ("doing", "saying", "listening")


class Facts(QWidget):
    """Signs with words; a fact without words takes no room."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self._parts: dict[str, _Fact] = {}
        self._shown: dict[str, tuple[str, str, str]] = {}
        line = self.fontMetrics().height()
        self._short = QWidget()
        self._flow = FlowLayout(self._short, line // 2)
        self._box = QVBoxLayout(self)
        self._box.setContentsMargins(0, 0, 0, 0)
        self._box.setSpacing(line // 5)
        self._box.addWidget(self._short)
        look.theme_changed.connect(self._dress)

    def show_fact(self, name: str, icon_name: str, words: str, colour: str = "muted") -> None:
        """Show a fact; ``name`` is the same each time that it is told anew."""
        if self._shown.get(name) == (icon_name, words, colour):
            return
        self._shown[name] = (icon_name, words, colour)
        part = self._parts.get(name) or self._add(name)
        part.setVisible(bool(words))
        part.label.setText(words)
        self._short.setVisible(any(self.words(one) for one in self._shown if one not in LONG))
        self._dress_part(name)

    def words(self, name: str) -> str:
        """What a fact says; "" when it says nothing."""
        return self._shown.get(name, ("", "", ""))[1]

    def text(self) -> str:
        """All facts as sentences, for screen readers."""
        return " ".join(f"{words}." for _, words, _ in self._shown.values() if words)

    def _add(self, name: str) -> _Fact:
        part = self._parts[name] = _Fact(is_long=name in LONG)
        if name in LONG:
            self._box.addWidget(part)
        else:
            self._flow.addWidget(part)
        return part

    def _dress(self) -> None:
        for name in self._parts:
            self._dress_part(name)

    def _dress_part(self, name: str) -> None:
        icon_name, _, colour = self._shown[name]
        side, ratio = self.fontMetrics().height(), self.devicePixelRatioF()
        pixmap = icon_pixmap(icon_name, self._look.theme.colour(colour), side, ratio)
        self._parts[name].sign.setPixmap(pixmap)


class _Fact(QWidget):
    """A sign and words."""

    def __init__(self, *, is_long: bool) -> None:
        super().__init__()
        self.sign, self.label = QLabel(), QLabel()
        self.label.setTextFormat(Qt.TextFormat.PlainText)
        self.label.setWordWrap(is_long)
        if is_long:
            self.label.setSizePolicy(wrapped())
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(self.fontMetrics().height() // 4)
        row.addWidget(self.sign, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(self.label, 1)


def wrapped() -> QSizePolicy:
    """How words take room that are as wide as there is room, and as high as that makes them."""
    policy = QSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
    policy.setHeightForWidth(True)
    return policy


def show_state(facts: Facts, state: RobotState, language: Language) -> None:
    """Show posture, movement, battery, and what it says and listens for."""
    facts.show_fact("posture", "person-standing", posture_words(state.posture, language))
    moves = tr("Moves") if state.moving else tr("At rest")
    facts.show_fact("moving", "footprints" if state.moving else "pause", moves)
    is_low = state.battery < LOW_BATTERY
    percent = f"{state.battery:.0%}"
    battery = tr("Battery {percent}", percent=percent)
    if is_low:
        battery = tr("Battery {percent}: charge it soon", percent=percent)
    facts.show_fact("battery", "battery-medium", battery, "warning" if is_low else "muted")
    says = tr("Says “{text}”", text=state.saying) if state.saying else ""
    facts.show_fact("saying", "message-square", says)
    heard = tr(" or ").join(f"“{word}”" for word in state.listening)
    facts.show_fact("listening", "ear", tr("Listens for {words}", words=heard) if heard else "")


def posture_words(posture: str, language: Language) -> str:
    """A posture, as the robot names it, in words: "LyingBack" is “lying on the back”."""
    if not posture:
        return ""
    key = "posture" + re.sub("[A-Z]", lambda found: f"_{found.group().lower()}", posture)
    words = language.choices.get("postures", {}).get(key, posture)
    return tr("Posture: {posture}", posture=words)
