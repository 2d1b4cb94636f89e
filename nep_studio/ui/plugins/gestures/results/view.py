"""What trains, and what came of it: in words, what was taken for what, and the points."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QFrame,
    QProgressBar,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.message_cards import MessageText
from nep_studio.ui.messages import Message, announce
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.choices import Choices
from nep_studio.ui.widgets.layouts import Halves, in_column, in_row, scrolled
from nep_studio.ui.words import language_code, tr

from .advice import Advice, AdviceList, Known, advice_on, false_triggers, headline, takes_of_pair
from .confusion import ConfusionView
from .findings import method_words
from .labels import StatusIcon, Words
from .threshold import PointPanel
from .training import QUICK_S, Training

# The button that trains, how far it is, and whether what was learned is up to date.

BAR_WIDE_LINES = 30
"""So many lines of text wide, the button and what is told have room beside each other."""


class TrainBar(QWidget):
    """Follows a training."""

    def __init__(self, training: Training, look: Look) -> None:
        super().__init__()
        self.training, self._look = training, look
        self.button = labelled(QPushButton(), text="Train")
        self.button.setProperty("kind", "primary")
        self.cancel = labelled(
            QPushButton(), text="Cancel", tip="Stop the training; what was learned before stays"
        )
        self.progress = QProgressBar(textVisible=False, minimum=0, maximum=100)
        labelled(self.progress, name="Progress of the training")
        self.progress.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.sign = StatusIcon(look)
        self.status = Words()
        self.by_itself = labelled(
            QCheckBox(),
            text="Train after each change",
            tip="Learn again by itself, as long as it takes only a moment",
        )
        self._lay_out()
        self.button.clicked.connect(training.train)
        self.cancel.clicked.connect(training.cancel)
        self.by_itself.toggled.connect(training.set_by_itself)
        training.changed.connect(self.refresh)
        training.trained.connect(lambda: announce(self, self.status.text()))
        look.theme_changed.connect(self._dress)
        self._dress()
        follow_words(self, self.refresh)

    def _lay_out(self) -> None:
        buttons = in_row(self.button, self.cancel, (self.progress, 1), 0)
        status = in_row(self.sign, (self.status, 1))
        halves = Halves(BAR_WIDE_LINES)
        halves.first.addLayout(buttons)
        halves.second.addLayout(status)
        halves.second.addWidget(self.by_itself)
        in_column(halves, of=self, margins=0)

    def refresh(self) -> None:
        """Show how it stands."""
        training = self.training
        is_busy, why_not = training.is_training, training.why_not
        had_focus = self.button.hasFocus() or self.cancel.hasFocus()
        self.button.setVisible(not is_busy)
        self.button.setEnabled(not why_not)
        has_learned = training.controller.recogniser is not None
        labelled(self.button, text="Train again" if has_learned else "Train")
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
            words = tr("Something has changed: train again.")
            if training.trains_by_itself and not training.is_quick:
                words = tr(
                    "Something has changed: train again. It took longer than {seconds} s, so it is"
                    " not done by itself.",
                    seconds=round(QUICK_S),
                )
            return "refresh-cw", "warning", words
        if training.controller.recogniser is None:
            words = tr("Train, and it is told how well your gestures are told apart.")
            return "info", "info", words
        if training.seconds:
            seconds = f"{training.seconds:.1f}"
            return "circle-check", "success", tr("Learned in {seconds} s", seconds=seconds)
        return "circle-check", "success", tr("Learned, and up to date")

    def _dress(self) -> None:
        theme = self._look.theme
        self.button.setIcon(icon("brain", theme.colour("accent_text")))
        self.cancel.setIcon(icon("x", theme))


# What came of a training: in words first, then what was taken for what, then the points.

_FEW_TAKES = "few_takes"
"""A remark of the training that the advice tells too, with more."""

WIDE_LINES = 42
"""So many lines of text wide, words and pictures have room beside each other."""


class ResultsView(QWidget):
    """Trains, and shows what came of it.

    What a person asks for here is done elsewhere: ``takes_asked`` gives the ids of takes that are
    to be shown, ``record_asked`` the gesture to be recorded ("" for any), ``everyday_asked`` wants
    everyday movement, ``gesture_asked`` a new gesture, ``trial_asked`` the try-out.
    """

    takes_asked = Signal(object)
    record_asked = Signal(str)
    everyday_asked = Signal()
    gesture_asked = Signal()
    trial_asked = Signal()

    def __init__(self, controller: GestureController, training: Training) -> None:
        super().__init__()
        self.controller, self.training, self.tuning = controller, training, training.tuning
        self.bar = TrainBar(training, controller.look)
        self.headline = Words(role="heading")
        self.everyday = Words(role="hint")
        self.advice = AdviceList(controller.look)
        self.method = Choices(method_words)
        self.table = ConfusionView(self._title, controller.look)
        self.points = PointPanel(self.tuning, controller.look)
        self.failure = QFrame()
        self._told_problem: object = None
        self._shown: object = None
        self._lay_out()
        self._connect()
        follow_words(self, self.refresh)

    def _lay_out(self) -> None:
        inner = QWidget()
        labelled(self.method, name="Recogniser")
        self.method.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.found = Halves(WIDE_LINES)
        legend = labelled(
            Words(role="hint"),
            text="Rows are what was made, columns what was recognised. "
            "Press a number to see its takes.",
        )
        point = labelled(
            Words(role="hint"), text="How certain it must be before a gesture counts as made."
        )
        self.found.add(self.headline, self.everyday, self.advice)
        self.found.add_beside(
            labelled(Words(role="heading"), text="What was taken for what"),
            self.table,
            legend,
            labelled(Words(role="heading"), text="Recognition point"),
            point,
            self.points,
            labelled(Words(role="heading"), text="Recogniser"),
            self.method,
        )
        in_column(self.bar, self.failure, self.found, 1, of=inner)
        self.area = scrolled(inner)
        self.area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        in_column(self.area, of=self, margins=0)
        self.failure.setProperty("kind", "card")
        self.failure.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        QVBoxLayout(self.failure)

    def _connect(self) -> None:
        self.method.currentIndexChanged.connect(
            lambda: self.tuning.use_method(str(self.method.currentData()))
        )
        self.advice.asked.connect(self._on_asked)
        self.advice.takes_asked.connect(self.takes_asked)
        self.table.cell_chosen.connect(self._on_cell_chosen)
        for signal in (self.training.changed, self.controller.changed, self.tuning.method_changed):
            signal.connect(self.refresh)
        self.tuning.point_changed.connect(self._show_advice)

    def refresh(self) -> None:
        """Show what there is now."""
        self._show_failure()
        findings = self.tuning.findings
        self.found.setVisible(findings is not None)
        self.method.choose(self.tuning.method)
        self._show_advice()
        shown = (
            language_code(),
            findings,
            [(name, one.title) for name, one in self.controller.gestures.items()],
        )
        if shown != self._shown:  # a table that is filled anew forgets which cell is looked at
            self._shown = shown
            self.table.show_findings(findings)
            self.points.fill()
        self.points.refresh()

    def _show_advice(self) -> None:
        findings = self.tuning.findings
        if findings is None:
            self.advice.show_advice(())
            return
        known = self._known()
        self.headline.setText(headline(findings))
        self.everyday.setText(false_triggers(findings, is_simulated=not known.everyday_s))
        self.everyday.setVisible(bool(self.everyday.text()))
        remarks = [one for one in self.training.remarks if one.code != _FEW_TAKES]
        told = [Advice("tip", tr(remark.sentence)) for remark in remarks]
        self.advice.show_advice([*advice_on(findings, known), *told])

    def _known(self) -> Known:
        everyday = (one.seconds for one in self.controller.recordings.values() if one.everyday)
        return Known(self.controller.gestures, self.controller.people, sum(everyday))

    def _title(self, name: str) -> str:
        return self._known().title(name)

    def _show_failure(self) -> None:
        problem = self.training.problem
        self.failure.setVisible(problem is not None)
        if (language_code(), problem) == self._told_problem:
            return
        self._told_problem = (language_code(), problem)
        box = self.failure.layout()
        while box is not None and (item := box.takeAt(0)) is not None:
            if (widget := item.widget()) is not None:
                widget.deleteLater()
        if problem is not None and box is not None:
            steps = tuple(map(tr, problem.checklist))
            told = Message("error", tr(problem.title), tr(problem.sentence), steps, problem.details)
            box.addWidget(MessageText(told))

    def _on_cell_chosen(self, made: str, found: str) -> None:
        findings = self.tuning.findings
        if findings is None:
            return
        if takes := takes_of_pair(findings, self.controller.gestures, made, found):
            self.takes_asked.emit(takes)

    def _on_asked(self, advice: Advice) -> None:
        match advice.what:
            case "record":
                self.record_asked.emit(advice.gesture)
            case "everyday":
                self.everyday_asked.emit()
            case "gesture":
                self.gesture_asked.emit()
            case "takes":
                self.takes_asked.emit(advice.takes)
            case "try":
                self.trial_asked.emit()
            case "point":
                self.points.choose(advice.gesture)
                self.area.ensureWidgetVisible(self.points)
                self.points.slider.setFocus()

    def showEvent(self, event: QShowEvent) -> None:
        """Somebody may want to train soon."""
        super().showEvent(event)
        self.training.warm()
