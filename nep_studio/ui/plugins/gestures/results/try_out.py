"""Tries the gestures out: what the recogniser sees now, and what it would recognise."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import QMenu, QPushButton, QVBoxLayout, QWidget

from nep_core.errors import RecordingError
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.messages import announce
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.live import Samples
from nep_studio.ui.plugins.gestures.project_gestures import Keeping
from nep_studio.ui.widgets.layouts import FlowLayout, Halves, in_column, in_row, scrolled
from nep_studio.ui.words import tr
from nodes.perceptual.recognition.features import Detection
from nodes.perceptual.recognition.model import Model

from .band import BandPanel
from .certainties import KEPT_S, Certainties, CertaintyHistory, Listening, Wanted
from .labels import StatusIcon, Words
from .threshold import both_sides
from .timeline import GestureBar, TriggerTimeline
from .training import Training

# What "it missed it" and "false alarm" add to the project: the last seconds, as movement.

BEFORE_S, AFTER_S = 1.0, 0.5
"""So much around a movement is kept with it."""
SHORTEST_S, LONGEST_S = 0.3, 8.0


def keep_missed(controller: GestureController, name: str, start_s: float, end_s: float) -> bool:
    """Keep a movement (on the clock of the live stream) as a take more of a gesture.

    What is around it may be anything, so nothing is learned from that. False when too little of
    the movement is still known.
    """
    samples = _around(controller, start_s, end_s)
    if not len(samples):
        return False
    first_s, last_s = float(samples.t[0]), float(samples.t[-1])
    take = (max(start_s, first_s), min(end_s, last_s))
    if not SHORTEST_S <= take[1] - take[0] <= LONGEST_S:
        return False
    unknown = [span for span in ((first_s, take[0]), (take[1], last_s)) if span[1] > span[0]]
    label = "add what was missed"
    return bool(Keeping(controller).keep_session(name, samples, [take], unknown, label))


def keep_false_alarm(controller: GestureController, start_s: float, end_s: float) -> bool:
    """Keep a movement as everyday movement; False when too little of it is still known."""
    samples = _around(controller, start_s, end_s)
    return samples.seconds >= SHORTEST_S and Keeping(controller).keep_everyday(samples)


def _around(controller: GestureController, start_s: float, end_s: float) -> Samples:
    live = controller.live
    return Samples.none() if live is None else live.between(start_s - BEFORE_S, end_s + AFTER_S)


# Two buttons that tell the recogniser what it did wrong, while one tries it out.

MISSED_S, ALARM_S = 6.0, 10.0
"""How far back a missed gesture, and a false alarm, is looked for."""
USUAL_S = 1.5
"""A movement of which nothing is known is taken to be so long."""


class CorrectionBar(QWidget):
    """``history`` gives what the recogniser saw in the last half minute."""

    def __init__(
        self, controller: GestureController, history: Callable[[], CertaintyHistory]
    ) -> None:
        super().__init__()
        self._controller, self._history = controller, history
        self.missed = labelled(
            QPushButton(),
            text="It missed it",
            tip="Keep the last seconds as a take more of a gesture",
        )
        self.false_alarm = labelled(
            QPushButton(), text="False alarm", tip="Keep the last seconds as everyday movement"
        )
        self.menu = QMenu(self.missed)
        self.menu.aboutToShow.connect(self.fill_menu)
        self.missed.setMenu(self.menu)
        self.false_alarm.clicked.connect(self.keep_false_alarm)
        FlowLayout(self, 4, (self.missed, self.false_alarm))

    def fill_menu(self) -> None:
        """Offer the gestures that may have been missed."""
        self.menu.clear()
        for name, gesture in self._controller.gestures.items():
            action = self.menu.addAction(gesture.title.replace("&", "&&"))
            action.triggered.connect(partial(self.keep_missed, name))

    def keep_missed(self, name: str, _is_on: bool = False) -> None:
        """Keep the movement of the last seconds that is most like a gesture as a take of it."""
        live, history = self._controller.live, self._history()
        if live is None:
            return
        best = history.best(name, history.now_s - MISSED_S)
        end_s = best.t_end if best is not None else live.last_t
        start_s = best.t_start if best is not None else end_s - USUAL_S
        title = self._controller.gestures[name].title
        is_kept = keep_missed(self._controller, name, start_s, end_s)
        self._tell(is_kept, tr("Kept as a take of “{gesture}”", gesture=title))

    def keep_false_alarm(self) -> None:
        """Keep what caused the last trigger as everyday movement."""
        live = self._controller.live
        if live is None:
            return
        recent = [one for one in self._history().triggers if one.t_end > live.last_t - ALARM_S]
        end_s = recent[-1].t_end if recent else live.last_t
        start_s = recent[-1].t_start if recent else end_s - 2 * USUAL_S
        is_kept = keep_false_alarm(self._controller, start_s, end_s)
        self._tell(is_kept, tr("Kept as everyday movement"))

    def _tell(self, is_kept: bool, words: str) -> None:
        if is_kept:
            self._controller.messages.confirm(words)
        else:
            self._controller.messages.refuse(
                "Too little movement was heard in the last seconds.",
                ("Make the movement, then press the button at once.",),
            )


WIDE_LINES = 38
"""So many lines of text wide, bars and curves have room beside each other."""
FLASH_MS = 1400
ANNOUNCE_MS = 500
"""A screen reader says the last of several gestures that follow each other so soon."""
_HEARING_MS = 500
_BATCH_S = 1.0


class TryOut(QWidget):
    """``recognised`` gives the Detection of each gesture that was just made."""

    recognised = Signal(object)

    def __init__(self, controller: GestureController, training: Training) -> None:
        super().__init__()
        self.controller, self.training, self.tuning = controller, training, training.tuning
        self.history = CertaintyHistory()
        self.model: Model | None = None
        self.problem: RecordingError | None = None
        self.listening = Listening(self)
        self._told_s = 0.0
        """Until then nothing is news: another recogniser or point may find what is long over."""
        self._flashing: Detection | None = None
        self._moved = ""
        """The gesture whose recognition point was moved last."""
        self._make()
        inner = QWidget()
        head = in_row((self.sign, 0, Qt.AlignmentFlag.AlignVCenter), (self.said, 1))
        self._bars_box = QVBoxLayout()
        self._bars_box.setSpacing(0)
        self.live = Halves(WIDE_LINES)
        self.live.first.addLayout(self._bars_box)
        self.live.add(self.meaning, self.timeline, self.corrections)
        self.live.add_beside(labelled(Words(role="heading"), text="Expected curve"), self.band)
        in_column(head, self.steps, self.live, 1, of=inner)
        self.area = scrolled(inner)
        self.area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        in_column(self.area, of=self, margins=0)
        self._connect()
        self._fill_bars()
        self.meaning.hide()
        follow_words(self, self._say)

    def _make(self) -> None:
        look = self.controller.look
        self.sign = StatusIcon(look)
        self.said = Words(role="title")
        self.steps = Words(role="hint")
        self.bars: dict[str, GestureBar] = {}
        self.meaning = Words(role="hint")
        self.timeline = TriggerTimeline(self._title, look)
        self.corrections = CorrectionBar(self.controller, lambda: self.history)
        self.band = BandPanel(self.controller, self._title)
        self._flash_over = QTimer(self, singleShot=True, interval=FLASH_MS)
        self._say_soon = QTimer(self, singleShot=True, interval=ANNOUNCE_MS)
        self._is_heard = QTimer(self, interval=_HEARING_MS)

    def _connect(self) -> None:
        self.controller.heard.connect(self._on_heard)
        self.controller.changed.connect(self._on_changed)
        self.controller.sources_changed.connect(self._on_source_changed)
        self.controller.wearer_changed.connect(self._listen)
        self.tuning.method_changed.connect(self._on_changed)
        self.tuning.point_changed.connect(self._on_point_changed)
        self.listening.model_read.connect(self._on_model_read)
        self.listening.looked.connect(self._on_looked)
        self.listening.failed.connect(self._on_failed)
        self._flash_over.timeout.connect(self._on_flash_over)
        self._say_soon.timeout.connect(self._announce)
        self._is_heard.timeout.connect(self._show_state)

    # What is listened for

    def _on_changed(self) -> None:
        self._listen()
        self._fill_bars()
        self._show_state()

    def _on_source_changed(self) -> None:
        """Another sensor has another clock."""
        self._begin(self.model)
        self._listen()

    def _listen(self) -> None:
        """Listen for what the project has learned, while somebody looks."""
        recogniser = self.controller.recogniser
        if recogniser is None or not self.isVisible():
            self.listening.stop()
            if recogniser is None:
                self._begin(None)
            return
        live, wrist = self.controller.live, self.controller.wrist
        gravity = live is None or live.gravity_included
        self.listening.listen_for(Wanted(recogniser.file, self.tuning.method, gravity, wrist))

    def _begin(self, model: Model | None) -> None:
        """Forget what was looked at by another model."""
        self.model = model
        self.history = CertaintyHistory(model.gestures if model is not None else ())
        self.history.set_points(self.tuning.points)
        self.band.use_model(model)
        self._fill_bars()
        self._show_history()

    def _on_model_read(self, model: Model) -> None:
        """A new recogniser looks at the last half minute too: its effect is seen at once."""
        self.problem = None
        self._begin(model)
        live = self.controller.live
        if live is None:
            return
        samples, begin_s = live.last(), live.last_t - KEPT_S
        self._told_s = live.last_t
        while begin_s < live.last_t:  # in parts: the thread can be stopped in between
            self.listening.hear(samples.between(begin_s, begin_s + _BATCH_S))
            begin_s += _BATCH_S

    def _on_failed(self, error: RecordingError) -> None:
        self.problem = error
        self._begin(None)
        self._show_state()

    def _on_heard(self, samples: Samples) -> None:
        if self.isVisible():
            self._listen()  # what the sensor sends may be different by now
            self.listening.hear(samples)

    # What is seen

    def _on_looked(self, looks: list[Certainties]) -> None:
        if self.model is None:
            return
        for look in looks:
            self.history.add(look)
        last = self.history.triggers[-1] if self.history.triggers else None
        if last is not None and last.t_end > self._told_s:
            self._told_s = last.t_end
            self._flashing = last
            self._flash_over.start()
            self._say_soon.start()
            self._show_state()
            self.recognised.emit(last)
        self._show_history()
        self.band.follow(self.history)

    def _show_history(self) -> None:
        certainties = self.history.certainties()
        flashing = self._flashing.gesture if self._flashing is not None else ""
        for name, bar in self.bars.items():
            bar.show_certainty(certainties.get(name, 0.0), is_flashing=name == flashing)
        self.timeline.show_history(self.history, tuple(self.history.triggers))

    def _on_flash_over(self) -> None:
        self._flashing = None
        self._show_state()
        self._show_history()

    def _announce(self) -> None:
        triggers = self.history.triggers
        if triggers:
            announce(self, self._title(triggers[-1].gesture))

    def _on_point_changed(self, name: str) -> None:
        self._moved = name
        self.history.set_points(self.tuning.points)
        self._told_s = max(self._told_s, self.history.now_s)
        if name in self.bars:
            self.bars[name].show_gesture(name)
        self._show_meaning(name)
        self._show_history()

    def _show_meaning(self, name: str) -> None:
        """What the recognition point that is moved means for takes and everyday movement."""
        findings = self.tuning.findings
        words = both_sides(findings, name, self.tuning.point(name)) if findings and name else ""
        self.meaning.setText(f"{self._title(name)}: {words}" if words else "")
        self.meaning.setVisible(bool(words))

    def _say(self) -> None:
        self._show_state()
        self._show_meaning(self._moved)

    def _show_state(self) -> None:
        icon, colour, words, step = self._state()
        self.sign.show_icon(icon, colour)
        self.said.setText(words)
        self.steps.setText(step)
        self.steps.setVisible(bool(step))
        self.live.setVisible(self.model is not None)
        self.corrections.setEnabled(self.model is not None and self.controller.live is not None)

    def _state(self) -> tuple[str, str, str, str]:
        """An icon, its colour, what is the case, and what to do."""
        if self._flashing is not None:
            return "circle-check", "success", self._title(self._flashing.gesture), ""
        if self.problem is not None:
            checklist = "\n".join(map(tr, self.problem.checklist))
            return "triangle-alert", "warning", tr(self.problem.sentence), checklist
        if self.controller.recogniser is None:
            first = tr("Record each gesture a few times, then train: the try-out begins by itself.")
            return "info", "info", tr("Nothing to try out yet"), first
        if not self.controller.is_hearing:
            connect = tr("Connect a watch or phone, and move it.")
            return "watch", "info", tr("No movement is heard"), connect
        return "ear", "muted", tr("Make a gesture"), ""

    def _title(self, name: str) -> str:
        gesture = self.controller.gestures.get(name)
        return gesture.title if gesture is not None else name

    def _fill_bars(self) -> None:
        """A bar for each gesture that is listened for."""
        known = self.model.names if self.model is not None else ()
        wanted = [name for name in self.controller.gestures if name in known]
        if wanted == list(self.bars):
            for name, bar in self.bars.items():
                bar.show_gesture(name)
            return
        for bar in self.bars.values():
            bar.hide()
            bar.deleteLater()
        self.bars = {name: GestureBar(self.tuning, name, self.controller.look) for name in wanted}
        for bar in self.bars.values():
            self._bars_box.addWidget(bar)

    # Only while somebody looks

    def showEvent(self, event: QShowEvent) -> None:
        """Listen."""
        super().showEvent(event)
        self._is_heard.start()
        self._on_changed()

    def hideEvent(self, event: QHideEvent) -> None:
        """Listen no more."""
        super().hideEvent(event)
        self._is_heard.stop()
        self.listening.stop()
