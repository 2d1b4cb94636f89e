"""What there is to say of the motion: how to begin, or what the robot could not do."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QWidget

from nep_studio.ui.messages import announce
from nep_studio.ui.motion.desk import MotionDesk
from nep_studio.ui.motion.timeline_painter import Fault
from nep_studio.ui.theme import Look, icon_pixmap
from nep_studio.ui.words import count_words, tr


class NotesBar(QFrame):
    """One line, a sign before it, and what can be done about it."""

    time_asked = Signal()
    open_asked = Signal()

    def __init__(self, desk: MotionDesk, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.desk, self.look = desk, look
        self.faults: list[Fault] = []
        self.sign, self.words = QLabel(), QLabel()
        self.words.setWordWrap(True)
        self.give_time = QPushButton(tr("Give it the time it needs"))
        self.show_place = QPushButton(tr("Show the place"))
        self.open = QPushButton(tr("Open one as a start…"))
        for button in (self.give_time, self.show_place, self.open):
            button.setAutoDefault(False)
        self._lay_out()
        self.give_time.clicked.connect(self.time_asked)
        self.open.clicked.connect(self.open_asked)
        self.show_place.clicked.connect(self._on_show_asked)
        desk.changed.connect(self.refresh)
        look.theme_changed.connect(self.refresh)
        self.refresh()

    def show_faults(self, faults: list[Fault]) -> None:
        """Tell of these."""
        if faults and faults != self.faults:
            announce(self, faults[0].words)
        self.faults = faults
        self.refresh()

    def refresh(self) -> None:
        """Say what there is to say now."""
        is_empty = not self.desk.motion.joints
        self.open.setVisible(is_empty)
        self.give_time.setVisible(any(fault.kind == "fast" for fault in self.faults))
        self.show_place.setVisible(bool(self.faults))
        if is_empty:
            self._say("lightbulb", "info", self._how_to_begin())
        elif self.faults:
            more = len(self.faults) - 1
            rest = count_words(more, "One more place is marked.", "{n} more places are marked.")
            words = self.faults[0].words + (f" {rest}" if more else "")
            self._say("triangle-alert", "warning", words)
        else:
            self._say("circle-check", "success", tr("The robot can do this."))

    def _how_to_begin(self) -> str:
        return tr(
            "Drag a hand, a foot or the head of the robot, or move a slider: that is the first "
            "key pose. Then choose a later moment on the timeline, and pose it again."
        )

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.sign, 0, Qt.AlignmentFlag.AlignVCenter)
        row.addWidget(self.words, 1)
        for button in (self.open, self.show_place, self.give_time):
            row.addWidget(button)
        self.setMinimumHeight(line * 2)

    def _say(self, sign: str, colour: str, words: str) -> None:
        line = self.fontMetrics().height()
        drawn = icon_pixmap(
            sign, self.look.theme.colour(colour), line * 1.2, self.devicePixelRatioF()
        )
        self.sign.setPixmap(drawn)
        self.words.setText(words)

    def _on_show_asked(self) -> None:
        if self.faults:
            fault = self.faults[0]
            is_fall = fault.kind == "fall"
            self.desk.show(fault.from_s if is_fall else (fault.from_s + fault.to_s) / 2)
