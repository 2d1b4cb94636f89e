"""The page of the panel: the graph, the gestures, and what was learned of them."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt, QTimer, Signal
from PySide6.QtGui import QHideEvent, QKeyEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QApplication,
    QFrame,
    QScrollArea,
    QSplitter,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from nep_studio.ui.actions_icons import fit_icons
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.trainer.cards import Cards
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.exchanging import Exchange
from nep_studio.ui.trainer.head import Head
from nep_studio.ui.trainer.keeping import Keeping
from nep_studio.ui.trainer.live import Samples
from nep_studio.ui.trainer.menus import Menus, show_menu
from nep_studio.ui.trainer.outcome import everyday_words, keep_session, session_words
from nep_studio.ui.trainer.record_bar import RecordBar
from nep_studio.ui.trainer.results.results_view import ResultsView
from nep_studio.ui.trainer.results.training import Training
from nep_studio.ui.trainer.results.try_out import TryOut
from nep_studio.ui.trainer.session import Session, TakeSession
from nep_studio.ui.trainer.shape import Shape, shape_for
from nep_studio.ui.trainer.simulated import SimulatedWearer
from nep_studio.ui.trainer.strip import Strip
from nep_studio.ui.trainer.take_view import TakeView
from nep_studio.ui.words import tr


class TrainerPage(QWidget):
    """``connect_asked`` wants a watch to be connected."""

    connect_asked = Signal()

    def __init__(self, desk: TrainerDesk, training: Training, canvas: Canvas) -> None:
        super().__init__()
        self.desk, self.training = desk, training
        self.keeping = Keeping(desk)
        self.session = TakeSession(desk, self)
        self.simulated = SimulatedWearer(desk, self.session)
        self.take = TakeView(desk, self.keeping, self)
        self.head = Head(desk)
        self.strip = Strip(desk, self.session, self.take)
        self.bar = RecordBar(desk, self.keeping, self.session, self.take)
        self.cards = Cards(desk, self.keeping, self.session, canvas)
        self.menus = Menus(desk, self.keeping, self.cards)
        self.exchange = Exchange(desk, self)
        self.results, self.trial = ResultsView(desk, training), TryOut(desk, training)
        self.beeps = False
        self._lay_out()
        self._connect()
        self._on_current_changed(self.cards.current)

    def _lay_out(self) -> None:
        self.tabs = QTabWidget()
        self.tabs.setDocumentMode(True)
        self.tabs.addTab(self.trial, tr("Try it"))
        self.tabs.addTab(self.results, tr("What was learned"))
        self.inner, self.outer = QSplitter(), QSplitter()
        for splitter, parts in (
            (self.inner, (self._top(), self.cards)),
            (self.outer, (self.inner, self.tabs)),
        ):
            splitter.setChildrenCollapsible(False)
            for part in parts:
                splitter.addWidget(part)
        self._shape: Shape | None = None
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.addWidget(self.outer)
        fit_icons(self)

    def _top(self) -> QScrollArea:
        """The graph with what is above and below it; where there is little room, it scrolls."""
        line, top = self.fontMetrics().height(), QWidget()
        box = QVBoxLayout(top)
        box.setContentsMargins(line // 2, line // 3, line // 2, line // 3)
        box.setSpacing(line // 3)
        box.addWidget(self.head)
        box.addWidget(self.strip, 1)
        box.addWidget(self.bar)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setWidget(top)
        area.setMinimumSize(line * 15, line * 4)
        return area

    def _connect(self) -> None:
        self.head.watch.connect_asked.connect(self.connect_asked)
        self.head.hint.asked.connect(self.take_step)
        self.bar.everyday.clicked.connect(self._on_everyday_asked)
        self.head.more_asked.connect(self._on_more_asked)
        self.bar.button.clicked.connect(self.record_or_stop)
        self.cards.record_asked.connect(self.record)
        self.cards.current_changed.connect(self._on_current_changed)
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
        if name not in self.desk.gestures:
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
            self.bar.tell(tr("Nothing is heard yet. Connect a watch or phone, and move it."))
            return
        self.desk.choose_take("")
        self.show_recording()
        self.bar.tell(self._what_to_do())
        self.strip.setFocus(Qt.FocusReason.OtherFocusReason)

    def _what_to_do(self) -> str:
        gesture = self.session.gesture
        if not gesture:
            return tr("Move as you usually do, without your gestures.")
        if self.simulated.is_there:
            made = self.simulated.movement_for(gesture)
            return tr("The simulated person makes the movement {movement}.", movement=made)
        return tr("Hold still. After the countdown, make the gesture and rest, five times.")

    def _on_ended(self, session: Session) -> None:
        if session.takes and not keep_session(self.keeping, session):
            self.bar.tell(tr("The takes could not be kept. Is the gesture still there?"))
            return
        self.cards.show_card(session.gesture)
        self.bar.tell(session_words(session))

    def _on_everyday_ended(self, samples: Samples) -> None:
        self.bar.tell(everyday_words(samples, self.keeping.keep_everyday(samples)))

    def _on_session_changed(self) -> None:
        is_on = self.session.is_on
        if self.head.isHidden() != is_on:
            self.head.setVisible(not is_on)  # the graph has its room meanwhile
        if not is_on and not self.isVisible():
            self.desk.listen(False)
        if self.beeps and self.session.state == "countdown":
            QApplication.beep()

    def _on_movement_found(self, _movement: object) -> None:
        self.bar.tell(self.strip.big_words)
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

    def _on_current_changed(self, name: str) -> None:
        self.bar.set_gesture(name)

    def show_recording(self) -> None:
        """Show the graph and the gestures, where they share the room with other tabs."""
        if self.tabs.indexOf(self.inner) >= 0:
            self.tabs.setCurrentWidget(self.inner)

    def _on_takes_asked(self, ids: object) -> None:
        takes = (
            [one for one in ids if isinstance(one, str)] if isinstance(ids, (list, tuple)) else []
        )
        found = self.desk.find_take(takes[0]) if takes else None
        if found is not None:
            self.show_recording()
            self.desk.choose_take(found[1].id)
            self.cards.choose(found[0])
            self.cards.show_card(found[0])

    def _on_everyday_asked(self) -> None:
        button = self.bar.everyday
        menu = self.menus.of_everyday(self.record_everyday)
        show_menu(menu, button.mapToGlobal(QPoint(0, button.height())))

    def _on_more_asked(self) -> None:
        button, menu = self.head.more, self.menus.of_panel(self.exchange.entries())
        menu.addSeparator()
        beep = menu.addAction(tr("Beep while recording"))
        beep.setCheckable(True)
        beep.setChecked(self.beeps)
        beep.toggled.connect(self._on_beep_chosen)
        show_menu(menu, button.mapToGlobal(QPoint(0, button.height())))

    def _on_beep_chosen(self, is_on: bool) -> None:
        self.beeps = is_on

    # Keys, size, and being looked at

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Space records and stops; Escape stops, or goes back to the live graph."""
        if event.key() == Qt.Key.Key_Space and not event.isAutoRepeat():
            self.record_or_stop()
        elif event.key() == Qt.Key.Key_Escape and self.session.is_on:
            self.session.stop()
        elif event.key() == Qt.Key.Key_Escape and self.desk.chosen_take:
            self.desk.choose_take("")
        else:
            super().keyPressEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Take the shape that there is room for."""
        super().resizeEvent(event)
        line = max(1, self.fontMetrics().height())
        shape = shape_for(self.width() / line, self.height() / line)
        if shape != self._shape:
            self._shape = shape
            self._take_shape(shape)

    def _take_shape(self, shape: Shape) -> None:
        shown = self.tabs.currentWidget()
        is_first = self.tabs.indexOf(self.inner) >= 0
        if shape.is_tabbed and not is_first:
            self.tabs.insertTab(0, self.inner, tr("Record"))
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
        """Hear the sensors, and let the training be ready."""
        super().showEvent(event)
        self.desk.listen(True)

    def hideEvent(self, event: QHideEvent) -> None:
        """Hear them no more, unless something is recorded."""
        super().hideEvent(event)
        if not self.session.is_on:
            self.desk.listen(False)
