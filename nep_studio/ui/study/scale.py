"""One item of the questionnaire, with its options in a row."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import (
    QBoxLayout,
    QButtonGroup,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QRadioButton,
    QSizePolicy,
    QStyle,
    QVBoxLayout,
)

from nep_studio.study.sus import Questionnaire
from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr

_WRAPPED = Qt.TextFlag.TextWordWrap.value
BELOW = Qt.AlignmentFlag.AlignHCenter.value | Qt.AlignmentFlag.AlignTop.value | _WRAPPED
BESIDE = Qt.AlignmentFlag.AlignLeading.value | Qt.AlignmentFlag.AlignVCenter.value | _WRAPPED


class OptionButton(QRadioButton):
    """One option: a circle, and its words below, or beside it where there is little room."""

    def __init__(self, words: str, look: Look) -> None:
        super().__init__(words)
        self._look = look
        self._is_beside = False
        policy = QSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        policy.setHeightForWidth(True)
        self.setSizePolicy(policy)
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def set_beside(self, is_beside: bool) -> None:
        """Put the words beside the circle, or below it."""
        self._is_beside = is_beside
        self.updateGeometry()

    @property
    def least_width(self) -> int:
        """As wide as its longest word."""
        metrics = self.fontMetrics()
        widest = max(metrics.horizontalAdvance(word) for word in self.text().split())
        return widest + metrics.height()

    def sizeHint(self) -> QSize:
        """Room for the circle and the words."""
        width = self.least_width + self._is_beside * self._circle_room()
        return QSize(width, self.heightForWidth(width))

    def minimumSizeHint(self) -> QSize:
        """All of its words are seen."""
        return QSize(self.sizeHint().width(), self._circle_room())

    def heightForWidth(self, width: int) -> int:
        """As many lines as the words need."""
        return self._words_rect(width).bottom() + self.fontMetrics().height() // 3

    def hitButton(self, place: QPoint) -> bool:
        """The words can be clicked too."""
        return self.rect().contains(place)

    def _circle_room(self) -> int:
        return round(self.fontMetrics().height() * 1.8)

    def _words_rect(self, width: int) -> QRect:
        """Where the words are, as if one reads from the left."""
        room = self._circle_room()
        if self._is_beside:
            endless = QRect(room, 0, max(1, width - room), 10_000)
            tall = self.fontMetrics().boundingRect(endless, BESIDE, self.text()).height()
            return QRect(room, 0, endless.width(), max(tall, room))
        endless = QRect(0, room, width, 10_000)
        tall = self.fontMetrics().boundingRect(endless, BELOW, self.text()).height()
        return QRect(0, room, width, tall)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw circle and words."""
        theme, line = self._look.theme, self.fontMetrics().height()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.underMouse():
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.colour("hover"))
            painter.drawRoundedRect(self.rect(), line / 3, line / 3)
        self._paint_circle(painter)
        painter.setPen(theme.colour("text"))
        words = QStyle.visualRect(
            self.layoutDirection(), self.rect(), self._words_rect(self.width())
        )
        painter.drawText(words, BESIDE if self._is_beside else BELOW, self.text())
        if self.hasFocus():
            painter.setPen(QPen(theme.colour("focus"), max(2.0, line / 9)))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(2, 2, -2, -2), line / 3, line / 3)

    def _paint_circle(self, painter: QPainter) -> None:
        theme, line, room = self._look.theme, self.fontMetrics().height(), self._circle_room()
        space = QRect(0, 0, room if self._is_beside else self.width(), room)
        circle = QRectF(0, 0, line, line)
        circle.moveCenter(
            QRectF(QStyle.visualRect(self.layoutDirection(), self.rect(), space)).center()
        )
        painter.setPen(QPen(theme.colour("field_line"), max(1.5, line / 12)))
        painter.setBrush(theme.colour("accent" if self.isChecked() else "field"))
        painter.drawEllipse(circle)
        if self.isChecked():
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.colour("accent_text"))
            painter.drawEllipse(circle.center(), line * 0.2, line * 0.2)


class ItemRow(QFrame):
    """One item. Digits choose an option, Backspace leaves it open; ``changed`` tells of both."""

    changed = Signal()

    def __init__(self, number: int, form: Questionnaire, look: Look) -> None:
        super().__init__()
        self.setProperty("kind", "card")
        words = form.items[number]
        self.label = QLabel(tr("{number}. {item}", number=number + 1, item=words))
        self.label.setWordWrap(True)
        self.label.setProperty("role", "heading")
        self.clear_button = QPushButton(tr("Leave open"))
        self.clear_button.setProperty("kind", "quiet")
        self.clear_button.setAccessibleDescription(words)
        self.buttons = [OptionButton(option, look) for option in form.options]
        self._group = QButtonGroup(self)
        for place, button in enumerate(self.buttons, 1):
            count = len(self.buttons)
            told = tr(
                "{option}, {place} of {count}", option=button.text(), place=place, count=count
            )
            button.setAccessibleName(told)
            button.setAccessibleDescription(words)
            self._group.addButton(button, place)
        self._lay_out()
        self._group.idToggled.connect(self._on_toggled)
        self.clear_button.clicked.connect(self.clear)
        self._show_clear()

    def _lay_out(self) -> None:
        head = QHBoxLayout()
        head.addWidget(self.label, 1)
        head.addWidget(self.clear_button, 0, Qt.AlignmentFlag.AlignTop)
        policy = self.clear_button.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        self.clear_button.setSizePolicy(policy)
        self._options = QBoxLayout(QBoxLayout.Direction.LeftToRight)
        self._options.setSpacing(0)
        for button in self.buttons:
            self._options.addWidget(button, 1)
        box = QVBoxLayout(self)
        box.addLayout(head)
        box.addLayout(self._options)

    def fit(self, width: int) -> None:
        """Put the options in a row where there is room for it, else one below the other."""
        margins = self.contentsMargins()
        needed = max(button.least_width for button in self.buttons) * len(self.buttons)
        is_beside = needed + margins.left() + margins.right() + self.fontMetrics().height() > width
        direction = QBoxLayout.Direction
        self._options.setDirection(direction.TopToBottom if is_beside else direction.LeftToRight)
        for button in self.buttons:
            button.set_beside(is_beside)

    @property
    def answer(self) -> int | None:
        """The option that is chosen, from 1; None while it is open."""
        chosen = self._group.checkedId()
        return chosen if chosen > 0 else None

    def choose(self, option: int) -> None:
        """Choose an option, from 1."""
        button = self._group.button(option)
        if button is not None:
            button.setChecked(True)
            button.setFocus()

    def clear(self) -> None:
        """Leave the item open."""
        chosen = self._group.checkedButton()
        if chosen is None:
            return
        self._group.setExclusive(False)
        chosen.setChecked(False)
        self._group.setExclusive(True)
        if self.clear_button.hasFocus():
            self.buttons[0].setFocus()
        self._show_clear()
        self.changed.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Answer by a digit."""
        if event.text().isdecimal() and 1 <= int(event.text()) <= len(self.buttons):
            self.choose(int(event.text()))
        elif event.key() in (Qt.Key.Key_Backspace, Qt.Key.Key_Delete):
            self.clear()
        else:
            super().keyPressEvent(event)

    def _on_toggled(self, option: int, is_chosen: bool) -> None:
        if is_chosen:
            self._show_clear()
            self.changed.emit()

    def _show_clear(self) -> None:
        self.clear_button.setVisible(self.answer is not None)
