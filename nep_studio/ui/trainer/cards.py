"""The cards of all gestures, below each other, and the row that makes a new one."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QSize, Qt, QTimer, Signal
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.theme import icon
from nep_studio.ui.trainer.badges import Badges
from nep_studio.ui.trainer.card import GestureCard
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.keeping import Keeping
from nep_studio.ui.trainer.session import TakeSession
from nep_studio.ui.trainer.take_pictures import TakePictures
from nep_studio.ui.words import tr


class Cards(QScrollArea):
    """``record_asked`` and ``menu_asked`` give the name of a gesture, ``current_changed`` tells
    that Space records another one."""

    record_asked = Signal(str)
    menu_asked = Signal(str, QPoint)
    take_menu_asked = Signal(str, QPoint)
    current_changed = Signal(str)

    def __init__(
        self, desk: TrainerDesk, keeping: Keeping, session: TakeSession, canvas: Canvas
    ) -> None:
        super().__init__()
        self._desk, self._keeping, self._session = desk, keeping, session
        self._canvas = canvas
        self._pictures, self._badges = TakePictures(desk), Badges(desk)
        self.cards: dict[str, GestureCard] = {}
        self.current = ""
        self.empty = QLabel()
        self.new_name = QLineEdit()
        self.new_button = QPushButton(tr("New gesture"))
        self._soon = QTimer(self, singleShot=True, interval=0)
        self._soon.timeout.connect(self.refresh)
        self._lay_out()
        desk.changed.connect(self._on_changed)
        session.changed.connect(self._show_states)
        desk.look.theme_changed.connect(self._dress)
        self.new_button.clicked.connect(self.make_gesture)
        self.new_name.returnPressed.connect(self.make_gesture)
        self._dress()
        self.refresh()

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setAccessibleName(tr("Gestures"))
        self.new_name.setPlaceholderText(tr("Name of a new gesture"))
        self.new_name.setAccessibleName(tr("Name of a new gesture"))
        self.new_name.setMaxLength(60)
        self.new_button.setAutoDefault(False)
        self.empty.setWordWrap(True)
        self.empty.setProperty("role", "hint")
        new = QHBoxLayout()
        new.addWidget(self.new_name, 1)
        new.addWidget(self.new_button)
        inner = QWidget()
        self._box = QVBoxLayout(inner)
        self._box.setContentsMargins(line // 4, line // 4, line // 2, line // 4)
        self._box.setSpacing(line // 2)
        self._box.addLayout(new)
        self._box.addWidget(self.empty)
        self._box.addStretch(1)
        self.setWidget(inner)

    def sizeHint(self) -> QSize:
        """Room for two cards."""
        line = self.fontMetrics().height()
        return QSize(line * 24, line * 14)

    def minimumSizeHint(self) -> QSize:
        """One card can be used."""
        line = self.fontMetrics().height()
        return QSize(line * 12, line * 4)

    # What is shown

    def refresh(self) -> None:
        """Show the gestures as they are now; cards that stay are not made anew."""
        gestures = self._desk.gestures
        for name in [name for name in self.cards if name not in gestures]:
            card = self.cards.pop(name)
            self._box.removeWidget(card)
            card.hide()
            card.deleteLater()
        badges = self._badges.all()
        for place, (name, gesture) in enumerate(gestures.items()):
            card = self.cards.get(name) or self._make_card(name)
            if self._box.indexOf(card) != place:
                self._box.removeWidget(card)
                self._box.insertWidget(place, card)
            card.show_gesture(gesture, badges)
        self._box.update()
        self.cards = {name: self.cards[name] for name in gestures}
        self.new_name.setEnabled(self._desk.editor is not None)
        self.new_button.setEnabled(self._desk.editor is not None)
        self._show_empty()
        if self.current not in gestures:
            self.choose(next(iter(gestures), ""))
        self._show_states()

    def choose(self, name: str) -> None:
        """Let Space record this gesture."""
        if name != self.current:
            self.current = name
            self._show_states()
            self.current_changed.emit(name)

    def make_gesture(self) -> None:
        """Make a gesture of the name that was typed; without one, ask for it."""
        title = self.new_name.text().strip()
        if not title:
            self.ask_for_name()
            return
        made = self._keeping.new_gesture(title)
        if made:
            self.new_name.clear()
            self.refresh()
            self.choose(made)
            self.show_card(made)

    def ask_for_name(self) -> None:
        """Give the keyboard to the name of a new gesture."""
        self.ensureWidgetVisible(self.new_name)
        self.new_name.setFocus(Qt.FocusReason.OtherFocusReason)

    def show_card(self, name: str) -> None:
        """Bring a card into view."""
        card = self.cards.get(name)
        if card is not None:
            self._box.activate()
            QTimer.singleShot(0, card, lambda: self.ensureWidgetVisible(card))

    def _show_empty(self) -> None:
        self.empty.setVisible(not self._desk.gestures)
        words = tr(
            "A gesture is a movement that your program waits for, such as a wave. "
            "Give it a name here, then make it five times: the program learns it."
        )
        no_project = tr("Gestures belong to a project. Open one, or make a new one.")
        self.empty.setText(words if self._desk.editor is not None else no_project)

    def _make_card(self, name: str) -> GestureCard:
        card = self.cards[name] = GestureCard(name, self._desk, self._canvas, self._pictures)
        card.renamed.connect(lambda title: self._keeping.rename_gesture(name, title))
        card.record_asked.connect(lambda: self.record_asked.emit(name))
        card.activated.connect(lambda: self.choose(name))
        card.menu_asked.connect(lambda place: self.menu_asked.emit(name, place))
        card.take_menu_asked.connect(lambda place: self.take_menu_asked.emit(name, place))
        card.takes_dropped.connect(lambda ids: self._keeping.relabel_takes(ids, name))
        card.takes.opened.connect(self._on_opened)
        card.takes.delete_asked.connect(self._keeping.delete_takes)
        return card

    def _show_states(self) -> None:
        for name, card in self.cards.items():
            is_recording = self._session.is_on and self._session.gesture == name
            card.show_state(is_current=name == self.current, is_recording=is_recording)
            card.record.setEnabled(not self._session.is_on or is_recording)

    def _on_opened(self, take: str) -> None:
        self._desk.choose_take("" if take == self._desk.chosen_take else take)

    def _on_changed(self) -> None:
        self._soon.start()

    def _dress(self) -> None:
        self.new_button.setIcon(icon("plus", self._desk.look.theme))
        for card in self.cards.values():
            card.dress()
