"""The place over the canvas where messages are shown, the newest below."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QPoint, Qt, QTimer
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from nep_studio.ui.messages import Message
from nep_studio.ui.messages_card import MessageCard
from nep_studio.ui.theme import Look

MOST_CARDS = 3
READ_MS_PER_LETTER = 70
LEAST_READ_MS = 4000
WIDEST_LETTERS = 64


class MessageArea(QWidget):
    """Lies over the upper edge of ``host``; it takes no room from it and moves nothing."""

    def __init__(self, look: Look, host: QWidget) -> None:
        super().__init__(host)
        self._look, self._host = look, host
        self.cards: list[MessageCard] = []
        self._box = QVBoxLayout(self)
        host.installEventFilter(self)
        self.hide()

    def show_message(self, message: Message) -> None:
        """Add a card; one that says the same is shown once."""
        for card in list(self.cards):
            if card.message.title == message.title and card.message.passes == message.passes:
                self._remove(card)
        while len(self.cards) >= MOST_CARDS:
            self._remove(next((c for c in self.cards if c.message.passes), self.cards[0]))
        card = MessageCard(message, self._look.theme, self)
        card.closed.connect(lambda: self._remove(card))
        self.cards.append(card)
        self._box.addWidget(card)
        if message.passes:
            self._pass(card)
        self.show()
        self._place()

    def withdraw(self, message: Message) -> None:
        """Take the card of a message away."""
        for card in [card for card in self.cards if card.message is message]:
            self._remove(card)

    def clear_passing(self) -> None:
        """Take away the cards that go by themselves."""
        for card in [card for card in self.cards if card.message.passes]:
            self._remove(card)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Stay at the upper edge of the host."""
        if watched is self._host and event.type() == QEvent.Type.Resize:
            self._place()
        return False

    def event(self, event: QEvent) -> bool:
        """Grow and shrink with the cards."""
        if event.type() == QEvent.Type.LayoutRequest:
            self._place()
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc closes the newest card."""
        if event.key() == Qt.Key.Key_Escape and self.cards:
            self._remove(self.cards[-1])
            return
        super().keyPressEvent(event)

    def _pass(self, card: MessageCard) -> None:
        letters = len(card.message.spoken)
        timer = QTimer(card, singleShot=True)
        timer.setInterval(max(LEAST_READ_MS, letters * READ_MS_PER_LETTER))
        timer.timeout.connect(lambda: self._pass_away(card, timer))
        timer.start()

    def _pass_away(self, card: MessageCard, timer: QTimer) -> None:
        is_read = card.underMouse() or card.isAncestorOf(self.focusWidget() or self)
        if is_read or card.isHidden():
            timer.start()
        else:
            self._remove(card)

    def _remove(self, card: MessageCard) -> None:
        if card not in self.cards:
            return
        self.cards.remove(card)
        self._box.removeWidget(card)
        card.hide()
        card.deleteLater()
        self.setVisible(bool(self.cards))
        self._place()

    def _place(self) -> None:
        if not self.cards:
            return
        widest = self.fontMetrics().averageCharWidth() * WIDEST_LETTERS
        width = min(self._host.width(), widest)
        self._hide_what_has_no_room(width)
        height = self._box.heightForWidth(width) if self._box.hasHeightForWidth() else -1
        height = min(max(height, self._box.sizeHint().height() if height < 0 else height), 10_000)
        left = (self._host.width() - width) // 2
        self.setGeometry(left, 0, width, min(height, self._host.height()))
        self.move(QPoint(left, 0))
        self.raise_()

    def _hide_what_has_no_room(self, width: int) -> None:
        """Older cards wait until newer ones are closed: squeezed together, none could be read."""
        margins = self._box.contentsMargins()
        inside = width - margins.left() - margins.right()
        left = self._host.height() - margins.top() - margins.bottom()
        for card in reversed(self.cards):
            has_room = card is self.cards[-1] or left >= card.heightForWidth(inside)
            card.setHidden(not has_room)
            left = left - card.heightForWidth(inside) - self._box.spacing() if has_room else 0
