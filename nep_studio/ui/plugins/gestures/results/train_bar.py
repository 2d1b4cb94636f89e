"""The button that trains, how far it is, and whether what was learned is up to date."""

from __future__ import annotations

from PySide6.QtCore import QSize
from PySide6.QtWidgets import (
    QCheckBox,
    QHBoxLayout,
    QProgressBar,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from nep_studio.ui.messages import announce
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import Halves
from nep_studio.ui.words import tr

from .labels import StatusIcon, Words
from .training import QUICK_S, Training

WIDE_LINES = 30
"""So many lines of text wide, the button and what is told have room beside each other."""


class TrainBar(QWidget):
    """Follows a training."""

    def __init__(self, training: Training, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.training, self._look = training, look
        self.button = QPushButton(tr("Train"))
        self.button.setProperty("kind", "primary")
        self.cancel = QPushButton(tr("Cancel"))
        self.cancel.setToolTip(tr("Stop the training; what was learned before stays"))
        self.progress = QProgressBar()
        self.progress.setRange(0, 100)
        self.progress.setTextVisible(False)
        self.progress.setAccessibleName(tr("Progress of the training"))
        self.progress.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.sign = StatusIcon(look)
        self.status = Words()
        self.by_itself = QCheckBox(tr("Train after each change"))
        self.by_itself.setToolTip(tr("Learn again by itself, as long as it takes only a moment"))
        self._lay_out()
        self.button.clicked.connect(training.train)
        self.cancel.clicked.connect(training.cancel)
        self.by_itself.toggled.connect(training.set_by_itself)
        training.changed.connect(self.refresh)
        training.trained.connect(lambda: announce(self, self.status.text()))
        look.theme_changed.connect(self._dress)
        self._dress()
        self.refresh()

    def _lay_out(self) -> None:
        buttons = QHBoxLayout()
        buttons.addWidget(self.button)
        buttons.addWidget(self.cancel)
        buttons.addWidget(self.progress, 1)
        buttons.addStretch(0)
        status = QHBoxLayout()
        status.addWidget(self.sign)
        status.addWidget(self.status, 1)
        halves = Halves(WIDE_LINES)
        halves.first.addLayout(buttons)
        halves.second.addLayout(status)
        halves.second.addWidget(self.by_itself)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addWidget(halves)

    def refresh(self) -> None:
        """Show how it stands."""
        training = self.training
        is_busy, why_not = training.is_training, training.why_not
        had_focus = self.button.hasFocus() or self.cancel.hasFocus()
        self.button.setVisible(not is_busy)
        self.button.setEnabled(not why_not)
        has_learned = training.controller.recogniser is not None
        self.button.setText(tr("Train again") if has_learned else tr("Train"))
        self.cancel.setVisible(is_busy)
        self.progress.setVisible(is_busy)
        self.progress.setValue(round(training.progress * 100))
        if had_focus:  # the button that takes the other's place goes on
            (self.cancel if is_busy else self.button).setFocus()
        self.by_itself.setChecked(training.trains_by_itself)
        name, colour, words = self._status()
        self.sign.show_icon(name, colour)
        self.status.setText(words)

    def _status(self) -> tuple[str, str, str]:
        """Icon, its colour, and words."""
        training = self.training
        if training.is_training:
            return "hourglass", "info", training.step or tr("Getting ready to learn…")
        if training.why_not:
            return "info", "info", training.why_not
        if training.is_stale:
            return "refresh-cw", "warning", self._stale_words()
        if training.controller.recogniser is None:
            return (
                "info",
                "info",
                tr("Train, and it is told how well your gestures are told apart."),
            )
        if training.seconds:
            seconds = f"{training.seconds:.1f}"
            return "circle-check", "success", tr("Learned in {seconds} s", seconds=seconds)
        return "circle-check", "success", tr("Learned, and up to date")

    def _stale_words(self) -> str:
        training = self.training
        if training.trains_by_itself and not training.is_quick:
            return tr(
                "Something has changed: train again. It took longer than {seconds} s, so it is not"
                " done by itself.",
                seconds=round(QUICK_S),
            )
        return tr("Something has changed: train again.")

    def _dress(self, _theme: object = None) -> None:
        theme, line = self._look.theme, self.fontMetrics().height()
        for button in (self.button, self.cancel):
            button.setIconSize(QSize(line, line))
        self.button.setIcon(icon("brain", theme.colour("accent_text")))
        self.cancel.setIcon(icon("x", theme))
