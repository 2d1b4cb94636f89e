"""The page of the panel: the graph, the gestures, and what was learned of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Literal

from PySide6.QtCore import QSize, Qt, QTimer, Signal
from PySide6.QtGui import QHideEvent, QKeyEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QApplication,
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QSplitter,
    QTabWidget,
    QToolButton,
    QWidget,
)

from nep_studio.blocks.own_gestures import OwnGesture
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.labels import explained, follow_words, labelled
from nep_studio.ui.theme.icons import fit_icons, icon
from nep_studio.ui.watch_view.status import WatchStatus
from nep_studio.ui.widgets.layouts import in_column, in_row, scrolled
from nep_studio.ui.words import count_words, tr

from .cards import Cards
from .gesture_controller import GestureController
from .live import Samples
from .menus import Exchange, Menus, show_below, show_menu
from .project_gestures import Keeping
from .record_bar import RecordBar
from .recording import RecordingSession, SimulatedWearer, TakeSession, everyday_words, session_words
from .results.training import Training
from .results.try_out import TryOut
from .results.view import ResultsView
from .strip import Strip, TakeView

# How the parts of the page are arranged, by the room that there is for them.

WIDE, TWO, NARROW = 64.0, 44.0, 30.0
"""Lines of text across: three columns fit, two fit, fewer than that is one."""
HIGH = 34.0
"""So high, the gestures have room below the graph."""


@dataclass(frozen=True)
class Shape:
    """Whether recording is a tab beside the others, and what stands beside what."""

    is_tabbed: bool
    is_beside: bool
    has_cards_beside: bool


def shape_for(wide: float, high: float) -> Shape:
    """The shape for a room of so many lines of text."""
    if high >= HIGH:
        is_narrow = wide < TWO
        return Shape(is_tabbed=is_narrow, is_beside=not is_narrow, has_cards_beside=False)
    if wide >= WIDE:
        return Shape(is_tabbed=False, is_beside=True, has_cards_beside=True)
    return Shape(is_tabbed=True, is_beside=False, has_cards_beside=wide >= NARROW)


# The one next thing to do, from the first connection to the robot that reacts.

Step = Literal["project", "connect", "name", "record", "more", "another", "train", "try"]
ENOUGH_TAKES = 3


def next_step(controller: GestureController) -> tuple[Step, str]:
    """The step, and the name of the gesture that it is about."""
    if controller.editor is None:
        return "project", ""
    few = (name for name, one in controller.gestures.items() if _used(one) < ENOUGH_TAKES)
    lacking = next(few, "")
    if not controller.is_hearing and (lacking or len(controller.gestures) < 2):
        return "connect", ""
    if not controller.gestures:
        return "name", ""
    if lacking:
        return ("more" if controller.gestures[lacking].takes else "record"), lacking
    if len(controller.gestures) < 2:
        return "another", ""
    return ("try" if controller.is_up_to_date else "train"), ""


def hint_words(controller: GestureController) -> str:
    """The next step in words."""
    step, name = next_step(controller)
    gesture = controller.gestures.get(name, OwnGesture(""))
    said = {
        "project": tr("Open a project first, or make a new one: gestures belong to a project."),
        "connect": tr("Connect a watch or phone, so that movements can be recorded."),
        "name": tr("Give your first gesture a name, such as “wave”."),
        "record": tr(
            "Record “{gesture}”: press Record, then make it five times, with a short rest between.",
            gesture=gesture.title,
        ),
        "more": count_words(
            max(1, ENOUGH_TAKES - _used(gesture)),
            "Record “{gesture}” once more.",
            "Record “{gesture}” {n} more times.",
            gesture=gesture.title,
        ),
        "another": tr("Add another gesture: what can be confused can be told apart."),
        "train": tr("Train: the program learns from the takes."),
        "try": tr("Try it, then press “when …” of a gesture: it is in your program."),
    }
    return said[step]


def button_words(step: Step) -> str:
    """What the button beside the words says; empty where that button is there already."""
    return {
        "another": tr("New gesture"),
        "train": tr("Train"),
        "try": tr("Try it"),
    }.get(step, "")


def _used(gesture: OwnGesture) -> int:
    return sum(not take.left_out for take in gesture.takes)


# The head of the panel: the watch, more that can be done, and the next step.

LOOK_MS = 500


class HintLine(QWidget):
    """The one next thing to do; ``asked`` gives the step and the gesture when it is pressed."""

    asked = Signal(str, str)

    def __init__(self, controller: GestureController) -> None:
        super().__init__()
        self._controller = controller
        self._sign, self.words = QLabel(), QLabel(wordWrap=True)
        self.button = QPushButton(autoDefault=False)
        self.words.setTextFormat(Qt.TextFormat.PlainText)
        self.words.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        middle = Qt.AlignmentFlag.AlignVCenter
        parts = ((self._sign, 0, middle), (self.words, 1), (self.button, 0, middle))
        in_row(*parts, of=self, margins=0)
        self.button.clicked.connect(lambda: self.asked.emit(*next_step(controller)))
        self._looking = QTimer(self, interval=LOOK_MS)
        for signal in (self._looking.timeout, controller.changed, controller.sources_changed):
            signal.connect(self.refresh)
        controller.look.theme_changed.connect(self._dress)
        self._dress()
        follow_words(self, self.refresh)

    def refresh(self) -> None:
        """Show the step that is next now."""
        self.words.setText(hint_words(self._controller))
        self.button.setText(button_words(next_step(self._controller)[0]))
        self.button.setVisible(bool(self.button.text()))

    def showEvent(self, event: QShowEvent) -> None:
        """Look on: whether a watch is heard changes without anybody telling."""
        super().showEvent(event)
        self._looking.start()
        self.refresh()

    def hideEvent(self, event: QHideEvent) -> None:
        """Nobody looks."""
        super().hideEvent(event)
        self._looking.stop()

    def _dress(self) -> None:
        theme, line = self._controller.look.theme, self.fontMetrics().height()
        picture = icon("lightbulb", theme.colour("info"))
        self._sign.setPixmap(picture.pixmap(QSize(line, line), self.devicePixelRatioF()))


class Head(QWidget):
    """``more_asked`` tells that the button with more was pressed."""

    more_asked = Signal()

    def __init__(self, controller: GestureController) -> None:
        super().__init__()
        self._controller = controller
        self.watch, self.more = WatchStatus(controller.runner, controller.look), QToolButton()
        self.hint = HintLine(controller)
        explained(self.more, "Import, export and more")
        self.more.clicked.connect(self.more_asked)
        row = in_row((self.watch, 1), self.more)
        in_column(row, self.hint, of=self, margins=0, spacing=self.fontMetrics().height() // 3)
        controller.look.theme_changed.connect(self._dress)
        self._dress()

    def _dress(self) -> None:
        self.more.setIcon(icon("ellipsis", self._controller.look.theme))


class TrainerPage(QWidget):
    """``connect_asked`` wants a watch to be connected."""

    connect_asked = Signal()

    def __init__(self, controller: GestureController, training: Training, canvas: Canvas) -> None:
        super().__init__()
        self.controller, self.training = controller, training
        self.keeping = Keeping(controller)
        self.session = TakeSession(controller, self)
        self.simulated = SimulatedWearer(controller, self.session)
        self.take = TakeView(controller, self.keeping, self)
        self.head = Head(controller)
        self.strip = Strip(controller, self.session, self.take)
        self.bar = RecordBar(controller, self.keeping, self.session, self.take)
        self.cards = Cards(controller, self.keeping, self.session, canvas)
        self.menus = Menus(controller, self.keeping, self.cards)
        self.exchange = Exchange(controller, self)
        self.results, self.trial = ResultsView(controller, training), TryOut(controller, training)
        self.beeps = False
        self.tabs = QTabWidget(documentMode=True)
        labelled(self.tabs.tabBar(), name="Gestures")
        for tab in (self.trial, self.results):
            self.tabs.addTab(tab, "")
        self.inner = QSplitter(childrenCollapsible=False)
        self.outer = QSplitter(childrenCollapsible=False)
        self.inner.addWidget(self._top())
        self.inner.addWidget(self.cards)
        self.outer.addWidget(self.inner)
        self.outer.addWidget(self.tabs)
        self._shape: Shape | None = None
        in_column(self.outer, of=self, margins=0)
        fit_icons(self)
        self._connect()
        self.bar.set_gesture(self.cards.current)
        follow_words(self, self._name_tabs)

    def _name_tabs(self) -> None:
        for part, words in (
            (self.inner, tr("Record")),
            (self.trial, tr("Try it")),
            (self.results, tr("What was learned")),
        ):
            self.tabs.setTabText(self.tabs.indexOf(part), words)

    def _top(self) -> QScrollArea:
        """The graph with what is above and below it; where there is little room, it scrolls."""
        line, top = self.fontMetrics().height(), QWidget()
        margins = (line // 2, line // 3, line // 2, line // 3)
        parts = (self.head, (self.strip, 1), self.bar)
        in_column(*parts, of=top, margins=margins, spacing=line // 3)
        area = labelled(scrolled(top), name="Record")
        area.setMinimumSize(line * 15, line * 4)
        return area

    def _connect(self) -> None:
        self.head.watch.connect_asked.connect(self.connect_asked)
        self.head.hint.asked.connect(self.take_step)
        self.bar.everyday.clicked.connect(self._on_everyday_asked)
        self.head.more_asked.connect(self._on_more_asked)
        self.bar.button.clicked.connect(self.record_or_stop)
        self.cards.record_asked.connect(self.record)
        self.cards.current_changed.connect(self.bar.set_gesture)
        self.cards.menu_asked.connect(lambda name, at: show_menu(self.menus.of_gesture(name), at))
        self.cards.take_menu_asked.connect(lambda name, at: show_menu(self.menus.of_take(name), at))
        self.session.ended.connect(self._on_ended)
        self.session.everyday_ended.connect(self._on_everyday_ended)
        self.session.changed.connect(self._on_session_changed)
        self.session.movement_found.connect(self._on_movement_found)
        self.results.takes_asked.connect(self._on_takes_asked)
        self.results.record_asked.connect(lambda name: self.record(name or self.cards.current))
        self.results.everyday_asked.connect(lambda: self.record_everyday(60.0))
        self.results.gesture_asked.connect(self.ask_for_gesture)
        self.results.trial_asked.connect(lambda: self.tabs.setCurrentWidget(self.trial))

    # Recording

    def record_or_stop(self) -> None:
        """Record the gesture in use; stop when something is recorded."""
        if self.session.is_on:
            self.session.stop()
        else:
            self.record(self.cards.current)

    def record(self, name: str) -> None:
        """Record takes of a gesture; when it is recorded already, stop."""
        if self.session.is_on:
            self.session.stop()
            return
        if name not in self.controller.gestures:
            self.ask_for_gesture()
            return
        self.cards.choose(name)
        self._begin(self.session.start(name))

    def record_everyday(self, seconds: float) -> None:
        """Record everyday movement."""
        if not self.session.is_on:
            self._begin(self.session.start_everyday(seconds))

    def _begin(self, has_begun: bool) -> None:
        if not has_begun:
            self.bar.tell(
                lambda: tr("Nothing is heard yet. Connect a watch or phone, and move it.")
            )
            return
        self.controller.choose_take("")
        self.show_recording()
        self.bar.tell(partial(self._what_to_do, self.session.gesture))
        self.strip.setFocus(Qt.FocusReason.OtherFocusReason)

    def _what_to_do(self, gesture: str) -> str:
        if not gesture:
            return tr("Move as you usually do, without your gestures.")
        if self.simulated.is_there:
            made = self.simulated.movement_for(gesture)
            return tr("The simulated person makes the movement {movement}.", movement=made)
        return tr("Hold still. After the countdown, make the gesture and rest, five times.")

    def _on_ended(self, session: RecordingSession) -> None:
        if session.takes and not self.keeping.keep_session(
            session.gesture, session.samples, session.takes, session.forgotten
        ):
            self.bar.tell(lambda: tr("The takes could not be kept. Is the gesture still there?"))
            return
        self.cards.show_card(session.gesture)
        self.bar.tell(partial(session_words, session))

    def _on_everyday_ended(self, samples: Samples) -> None:
        is_kept = self.keeping.keep_everyday(samples)
        self.bar.tell(partial(everyday_words, samples, is_kept))

    def _on_session_changed(self) -> None:
        is_on = self.session.is_on
        if self.head.isHidden() != is_on:
            self.head.setVisible(not is_on)  # the graph has its room meanwhile
        if not is_on and not self.isVisible():
            self.controller.listen(False)
        if self.beeps and self.session.state == "countdown":
            QApplication.beep()

    def _on_movement_found(self, _movement: object) -> None:
        counted = self.strip.big_words
        self.bar.tell(lambda: counted)
        if self.beeps:
            QApplication.beep()

    # What else is asked for

    def take_step(self, step: str, name: str) -> None:
        """Do what the hint says."""
        if step == "connect":
            self.connect_asked.emit()
        elif step in ("name", "another"):
            self.ask_for_gesture()
        elif step in ("record", "more"):
            self.record(name)
        elif step == "train":
            self.training.train()
            self.tabs.setCurrentWidget(self.results)
        elif step == "try":
            self.tabs.setCurrentWidget(self.trial)

    def ask_for_gesture(self) -> None:
        """Let the name of a new gesture be typed."""
        self.show_recording()
        self.cards.ask_for_name()

    def show_recording(self) -> None:
        """Show the graph and the gestures, where they share the room with other tabs."""
        if self.tabs.indexOf(self.inner) >= 0:
            self.tabs.setCurrentWidget(self.inner)

    def _on_takes_asked(self, ids: Sequence[str]) -> None:
        found = self.controller.find_take(ids[0]) if ids else None
        if found is not None:
            self.show_recording()
            self.controller.choose_take(found[1].id)
            self.cards.choose(found[0])
            self.cards.show_card(found[0])

    def _on_everyday_asked(self) -> None:
        show_below(self.bar.everyday, self.menus.of_everyday(self.record_everyday))

    def _on_more_asked(self) -> None:
        menu = self.menus.of_panel(self.exchange.entries())
        menu.addSeparator()
        beep = menu.addAction(tr("Beep while recording"))
        beep.setCheckable(True)
        beep.setChecked(self.beeps)
        beep.toggled.connect(self._on_beep_chosen)
        show_below(self.head.more, menu)

    def _on_beep_chosen(self, is_on: bool) -> None:
        self.beeps = is_on

    # Keys, size, and being looked at

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Space records and stops; Escape stops, or goes back to the live graph."""
        if event.key() == Qt.Key.Key_Space and not event.isAutoRepeat():
            self.record_or_stop()
        elif event.key() == Qt.Key.Key_Escape and self.session.is_on:
            self.session.stop()
        elif event.key() == Qt.Key.Key_Escape and self.controller.chosen_take:
            self.controller.choose_take("")
        else:
            super().keyPressEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Take the shape that there is room for."""
        super().resizeEvent(event)
        line = max(1, self.fontMetrics().height())
        shape = shape_for(self.width() / line, self.height() / line)
        if shape != self._shape:
            self._shape = shape
            shown = self.tabs.currentWidget()
            is_first = self.tabs.indexOf(self.inner) >= 0
            if shape.is_tabbed and not is_first:
                self.tabs.insertTab(0, self.inner, "")
                self._name_tabs()
                self.tabs.setCurrentIndex(0)
            elif not shape.is_tabbed and is_first:
                self.outer.insertWidget(0, self.inner)
                self.inner.show()
                self.tabs.setCurrentWidget(self.trial if shown is self.inner else shown)
            across, down = Qt.Orientation.Horizontal, Qt.Orientation.Vertical
            self.outer.setOrientation(across if shape.is_beside else down)
            self.inner.setOrientation(across if shape.has_cards_beside else down)
            QTimer.singleShot(0, self, self._share_room)

    def _share_room(self) -> None:
        """Give the parts their usual shares, once they have the room of the shape."""
        self.outer.setSizes([3000, 2000])
        self.inner.setSizes([1000, 1000])

    def showEvent(self, event: QShowEvent) -> None:
        """Hear the sensors."""
        super().showEvent(event)
        self.controller.listen(True)

    def hideEvent(self, event: QHideEvent) -> None:
        """Hear them no more, unless something is recorded."""
        super().hideEvent(event)
        if not self.session.is_on:
            self.controller.listen(False)
