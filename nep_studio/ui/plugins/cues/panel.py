"""The cue panel: the operator of a stage piece tells by hand what a person does."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QDateTime, QLocale, QMetaObject, QObject, Qt, Signal
from PySide6.QtGui import QHideEvent, QKeyEvent, QShowEvent
from PySide6.QtWidgets import (
    QFrame,
    QLineEdit,
    QListWidget,
    QMenu,
    QPushButton,
    QScrollArea,
    QSplitter,
    QWidget,
)

from nep_core.wire.messages import GESTURE_REQUEST, HUMAN_BEHAVIOR, GestureRequest, HumanBehavior
from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.errors import EditRefused
from nep_studio.project.triggers import KEY, Cue, arranged, cues_of, kept_cues, own_cue, to_keep
from nep_studio.run.plan import VIRTUAL_WATCH
from nep_studio.ui.cue_style import cue_words
from nep_studio.ui.edits import OpenProject
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.messages import announce
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.widgets.forms import EmptyHint, hint, plain_label, styled
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

from .arranging import ArrangeDialog, CueBoard

if TYPE_CHECKING:
    from collections.abc import Callable

    from nep_studio.ui.document_files import Files
    from nep_studio.ui.host import Host


# The cues of the project that is open, as they are at the moment.


class ProjectCues(QObject):
    """``changed`` tells, soon after, that they may be others."""

    changed = Signal()

    def __init__(self, files: Files, parent: QObject) -> None:
        super().__init__(parent)
        self._project = OpenProject(files, self)
        self._project.changed.connect(self.changed)

    @property
    def is_open(self) -> bool:
        """Whether there is a project."""
        return self._project.editor is not None

    def cues(self) -> list[Cue]:
        """The cues, arranged, hidden ones too."""
        editor = self._project.editor
        if editor is None:
            return []
        return arranged(cues_of(editor.project, editor.language), kept_cues(editor.project))

    def keep(self, cues: list[Cue]) -> None:
        """Keep how they are arranged in the project; can be taken back."""
        editor = self._project.editor
        if editor is not None:
            editor.apply(SetExtra(KEY, to_keep(cues)), tr("arrange the cues"))


# Sends cues by hand, and remembers which were sent when.

MOST_SENT = 500


@dataclass(frozen=True)
class SentCue:
    """What was sent, and when (time.time())."""

    time_s: float
    words: str


class CueSender(QObject):
    """One door for what an operator sends. ``sent`` tells of each, ``refused`` why not."""

    sent = Signal(object)
    refused = Signal(str)
    changed = Signal()

    def __init__(
        self, runner: Runner, parent: QObject, now: Callable[[], float] = time.time
    ) -> None:
        super().__init__(parent)
        self._runner, self._now = runner, now
        self.log: deque[SentCue] = deque(maxlen=MOST_SENT)
        for signal in (runner.state_changed, runner.connected, runner.disconnected):
            signal.connect(self.changed)

    @property
    def why_not(self) -> str:
        """Why nothing can be sent now, "" when it can."""
        if self._runner.is_connected and self._runner.state in ("running", "paused"):
            return ""
        if self._runner.state == "starting":
            return tr("The program is starting. It will hear you in a moment.")
        return tr("The program does not run, so that nobody would hear it.")

    def send(self, cue: Cue) -> bool:
        """Send the state of a cue."""
        state = HumanBehavior(human_state=cue.state, source=cue.source)
        return self._send(HUMAN_BEHAVIOR, state, cue_words(cue))

    def make_gesture(self, gesture: str, words: str) -> bool:
        """Let the watch on the screen make a gesture, which is then recognised, or not."""
        request = GestureRequest(gesture=gesture)
        return self._send(GESTURE_REQUEST, request, tr("movement: {gesture}", gesture=words))

    def _send(self, topic: str, message: HumanBehavior | GestureRequest, words: str) -> bool:
        reason = self.why_not
        if reason or not self._runner.send(topic, message):
            self.refused.emit(reason or tr("The network is down."))
            return False
        sent = SentCue(self._now(), words)
        self.log.append(sent)
        self.sent.emit(sent)
        return True


MOST_LOGGED = 200


class CuePage(QWidget):
    """Buttons, a line for words, and what was sent when. With ``is_large`` it is for a show."""

    def __init__(
        self, host: Host, *, is_large: bool = False, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._look, self._runner = host.services.look, host.services.runner
        self.cues = ProjectCues(host.services.files, self)
        self.sending = CueSender(self._runner, self)
        self._heard: QMetaObject.Connection | None = None
        self.board = CueBoard(host.services.look, self)
        self.empty = hint("The rules of this program wait for nothing that could be sent.")
        self.why_not = plain_label()
        self.run_button = labelled(styled(QPushButton(), kind="run"), text="Run")
        self.words = labelled(
            QLineEdit(), placeholder="Somebody says…", name="Words that somebody says"
        )
        self.say_button = labelled(QPushButton(), text="Send")
        self.arrange_button = labelled(QPushButton(), text="Arrange…")
        self.movements = labelled(
            QPushButton(),
            text="The watch moves",
            tip="The movement, which has to be recognised like a real one",
        )
        self.movements.setMenu(QMenu(self.movements))
        self.log = labelled(QListWidget(), name="What was sent")
        EmptyHint(self.log, "What you send is listed here.")
        self._has_run_button = not is_large  # a show has its own
        self._lay_out(is_large)
        self._connect()
        self._dress()
        follow_words(self, self.refresh)

    def refresh(self) -> None:
        """Show the cues of the project as it is now, if somebody looks."""
        if not self.isVisible():
            return
        cues = self.cues.cues()
        self.board.show_cues(cues)
        self.empty.setVisible(not self.board.buttons)
        self._show_movements([cue for cue in cues if cue.movement and not cue.is_hidden])
        self._on_running_changed()

    def send(self, cue: Cue) -> bool:
        """Send a cue, or say why that cannot be."""
        is_sent = self.sending.send(cue)
        if is_sent:
            self.board.flash(cue)
        return is_sent

    def press(self, key: str) -> bool:
        """Send the cue of a key, also while the buttons are hidden; whether there is one."""
        if self.isVisible():
            return self.board.press(key)
        cues = [cue for cue in self.cues.cues() if not cue.is_hidden]
        found = next((cue for cue in cues if key and cue.key == key), None)
        if found is not None:
            self.send(found)
        return found is not None

    def showEvent(self, event: QShowEvent) -> None:
        """Nothing was followed while nobody looked."""
        super().showEvent(event)
        if self._heard is None:
            self._heard = self.sending.changed.connect(self._on_running_changed)
        self.refresh()

    def hideEvent(self, event: QHideEvent) -> None:
        """Follow nothing."""
        super().hideEvent(event)
        if self._heard is not None:
            QObject.disconnect(self._heard)
            self._heard = None

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """The keys of the buttons, wherever the focus is in the panel but in the line."""
        if event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier or not self.board.press(
            event.text()
        ):
            super().keyPressEvent(event)

    def _lay_out(self, is_large: bool) -> None:
        line = self.fontMetrics().height()
        state = in_row((self.why_not, 1), self.run_button)
        area = QScrollArea(widgetResizable=True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        area.setWidget(self.board)
        say = in_row((self.words, 1), self.say_button)
        others = in_row(self.movements, 1, *([] if is_large else [self.arrange_button]))
        upper = QWidget()
        in_column(state, self.empty, (area, 1), say, others, of=upper, margins=0)
        direction = Qt.Orientation.Horizontal if is_large else Qt.Orientation.Vertical
        split = QSplitter(direction, childrenCollapsible=False)
        split.addWidget(upper)
        split.addWidget(self.log)
        split.setStretchFactor(0, 4)
        split.setStretchFactor(1, 1)
        in_column(split, of=self, margins=line // 2)

    def _connect(self) -> None:
        self.cues.changed.connect(self.refresh)
        self.sending.sent.connect(self._on_sent)
        self.sending.refused.connect(self._on_refused)
        self.board.chosen.connect(self.send)
        self.board.change_asked.connect(self.arrange)
        self.run_button.clicked.connect(lambda: self._runner.run())
        self.say_button.clicked.connect(self._on_said)
        self.words.returnPressed.connect(self._on_said)
        self.arrange_button.clicked.connect(lambda: self.arrange())
        self._look.theme_changed.connect(self._dress)

    def arrange(self, cue: Cue | None = None) -> None:
        """Let the person arrange the cues."""
        if not self.cues.is_open or self.arrange_button.parent() is None:
            return
        dialog = ArrangeDialog(self.cues.cues(), self._look.theme, self)
        dialog.arranged.connect(self._on_arranged)
        if cue is not None:
            dialog.select(cue)
        dialog.open()

    def _on_arranged(self, cues: list[Cue]) -> None:
        self.cues.keep(cues)
        self.refresh()

    def _show_movements(self, gestures: list[Cue]) -> None:
        """Let the watch on the screen move, where it is what measures."""
        nodes = {planned.node for planned in self._runner.planned()} if gestures else set()
        self.movements.setVisible(VIRTUAL_WATCH in nodes)
        menu = self.movements.menu()
        menu.clear()
        for cue in gestures:
            make = partial(self.sending.make_gesture, cue.movement, cue.words)
            menu.addAction(cue_words(cue)).triggered.connect(lambda _=False, make=make: make())

    def _on_said(self) -> None:
        try:
            cue = own_cue(self.words.text(), is_word=True)
        except EditRefused:
            self.words.setFocus()
            return
        if self.send(cue):
            self.words.clear()

    def _on_running_changed(self) -> None:
        if not self.isVisible():
            return
        reason = self.sending.why_not
        self.board.set_heard(not reason)
        self.why_not.setText(reason or tr("The program hears you."))
        is_idle = self._runner.state == "idle" and self.cues.is_open
        self.run_button.setVisible(self._has_run_button and is_idle)

    def _on_refused(self, reason: str) -> None:
        self.why_not.setText(reason)
        announce(self, reason)
        if self.run_button.isVisible():
            self.run_button.setFocus()

    def _on_sent(self, sent: SentCue) -> None:
        moment = QDateTime.fromSecsSinceEpoch(int(sent.time_s)).time()
        clock = QLocale().toString(moment, "HH:mm:ss")
        self.log.insertItem(0, f"{clock}  {sent.words}")
        while self.log.count() > MOST_LOGGED:
            self.log.takeItem(self.log.count() - 1)
        announce(self, tr("Sent: {words}", words=sent.words))

    def _dress(self) -> None:
        theme = self._look.theme
        self.run_button.setIcon(icon("play", theme.colour("run_text")))
        self.say_button.setIcon(icon("ear", theme))
        self.arrange_button.setIcon(icon("sliders-horizontal", theme))
        self.movements.setIcon(icon("watch", theme))
