"""The sign that is in the window as long as a study is recorded."""

from __future__ import annotations

from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton

from nep_studio.ui.elided_label import ElidedLabel
from nep_studio.ui.theme import Look, icon_pixmap
from nep_studio.ui.words import tr

from .recorder import StudyRecorder


class StudySign(QFrame):
    """Says that a study is on and of whom, with buttons for the questionnaire and to stop."""

    def __init__(self, recorder: StudyRecorder, look: Look) -> None:
        super().__init__()
        self._recorder, self._look = recorder, look
        self.setProperty("kind", "warning")
        self.dot, self.words = QLabel(), ElidedLabel()
        self.form_button = QPushButton(tr("Fill in the questionnaire"))
        self.stop_button = QPushButton(tr("Stop the study"))
        row = QHBoxLayout(self)
        row.addWidget(self.dot)
        row.addWidget(self.words, 1)
        row.addWidget(self.form_button)
        row.addWidget(self.stop_button)
        recorder.changed.connect(self.refresh)
        look.theme_changed.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Be there, or not."""
        sitting = self._recorder.sitting
        side, ratio = self.fontMetrics().height(), self.devicePixelRatioF()
        self.dot.setPixmap(icon_pixmap("eye", self._look.theme.colour("warning"), side, ratio))
        if sitting is None:
            return
        values = {"participant": sitting.participant, "condition": sitting.condition}
        if sitting.condition:
            words = tr("A study is recorded: {participant}, {condition}", **values)
        else:
            words = tr("A study is recorded: {participant}", participant=sitting.participant)
        self.words.set_words(words)
