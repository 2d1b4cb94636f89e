"""A ball, a mark and sounds, which a robot notices."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QLabel, QSpinBox, QVBoxLayout, QWidget

from nep_studio.surroundings import FIRST_MARK
from nep_studio.ui.panels.flow import FlowLayout
from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr

from .buttons import WordsButton
from .hands import Hands


class ThingsBox(QWidget):
    """What is shown to a robot stands in the scene of the robots too."""

    def __init__(self, hands: Hands, look: Look) -> None:
        super().__init__()
        self._hands = hands
        self.ball = QCheckBox(tr("The red ball"))
        self.mark = QCheckBox(tr("The mark"))
        self.number = QSpinBox()
        self.number.setRange(0, 999)
        self.number.setValue(FIRST_MARK)
        self.number.setAccessibleName(tr("The number of the mark"))
        sides = {0: tr("ahead"), 90: tr("the left"), -90: tr("the right"), 180: tr("behind")}
        self.sounds = {
            degrees: WordsButton(tr("Sound from {side}", side=side), look, "volume-2")
            for degrees, side in sides.items()
        }
        self._lay_out()
        self.ball.toggled.connect(partial(self._on_toggled, "ball"))
        self.mark.toggled.connect(partial(self._on_toggled, "mark"))
        self.number.valueChanged.connect(self._on_number_changed)
        for degrees, button in self.sounds.items():
            button.clicked.connect(partial(self._on_sound, degrees))
        hands.visitors.changed.connect(self.refresh)
        self.refresh()

    def _lay_out(self) -> None:
        marked = QHBoxLayout()
        marked.addWidget(self.mark)
        marked.addWidget(self.number)
        marked.addStretch(1)
        sounds = QWidget()
        flow = FlowLayout(sounds, self.fontMetrics().height() // 3)
        for button in self.sounds.values():
            flow.addWidget(button)
        hint = QLabel(tr("Other things are placed in the scene of the robots."))
        hint.setWordWrap(True)
        hint.setProperty("role", "hint")
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addWidget(self.ball)
        box.addLayout(marked)
        box.addWidget(sounds)
        box.addWidget(hint)

    def refresh(self) -> None:
        """Show what is there."""
        for what, check in (("ball", self.ball), ("mark", self.mark)):
            with QSignalBlocker(check):
                check.setChecked(self._hands.visitors.find(what) is not None)
        mark = self._hands.visitors.find("mark")
        if mark is not None and mark.name.isdecimal():
            with QSignalBlocker(self.number):
                self.number.setValue(int(mark.name))

    def _on_toggled(self, what: str, is_there: bool) -> None:
        name = str(self.number.value()) if what == "mark" else ""
        if is_there:
            self._hands.visitors.come(what, self._hands.robot, name)
        else:
            self._hands.visitors.go(what)

    def _on_number_changed(self, number: int) -> None:
        self._hands.visitors.rename("mark", str(number))

    def _on_sound(self, degrees: int) -> None:
        self._hands.make_sound(float(degrees))
