"""The examples as cards: a picture of the blocks, what it is, what it needs, and what to do."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QEnterEvent,
    QFocusEvent,
    QFont,
    QFontMetrics,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPixmap,
)
from PySide6.QtWidgets import QFrame, QLabel, QPushButton, QSizePolicy, QVBoxLayout, QWidget

from nep_studio.examples import Example, example_of, examples
from nep_studio.ui.actions_icons import icon_room
from nep_studio.ui.start_page_flow import Flow, begin_where_reading_begins
from nep_studio.ui.start_page_words import Sign, difficulty_of, signs_of
from nep_studio.ui.theme import Look, icon, paint_icon
from nep_studio.ui.words import tr

CARD_LINES, PICTURE_LINES = 17.0, 7.5
"""How wide a card is, and how high its picture, in lines of text."""

ARROWS = {
    Qt.Key.Key_Left: "left",
    Qt.Key.Key_Right: "right",
    Qt.Key.Key_Up: "up",
    Qt.Key.Key_Down: "down",
}


def example_files() -> list[Path]:
    """The examples that come with the program, in the order of the gallery."""
    return [example.path for example in examples()]


def example_title(path: Path) -> str:
    """What an example is called."""
    example = example_of(path)
    return tr(example.title) if example else path.stem


def example_sentence(path: Path) -> str:
    """What an example does, in a sentence."""
    example = example_of(path)
    return tr(example.sentence) if example else ""


class Signs(QWidget):
    """Small icons with words under each other: what one needs, how long it takes."""

    def __init__(self, signs: Sequence[Sign], look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._signs, self._look = signs, look
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)

    def sizeHint(self) -> QSize:
        """A line for each."""
        metrics = self._metrics()
        wide = max((metrics.horizontalAdvance(words) for _, words in self._signs), default=0)
        return QSize(wide + 2 * metrics.height(), self._row(metrics) * len(self._signs))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the icons and words."""
        metrics, theme = self._metrics(), self._look.theme
        side, row = metrics.height() * 0.9, self._row(metrics)
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setFont(self._small_font())
            painter.setPen(theme.colour("muted"))
            for number, (name, words) in enumerate(self._signs):
                x = self.width() - side if is_mirrored else 0.0
                top = number * row + (row - side) / 2
                paint_icon(painter, QRectF(x, top, side, side), name, theme.colour("muted"))
                room = self.rect().adjusted(round(side * 1.5), 0, 0, 0)
                if is_mirrored:
                    room = self.rect().adjusted(0, 0, -round(side * 1.5), 0)
                room.setTop(number * row)
                room.setHeight(row)
                said = metrics.elidedText(words, Qt.TextElideMode.ElideRight, room.width())
                flags = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeading
                painter.drawText(room, flags, said)

    def _small_font(self) -> QFont:
        font = QFont(self.font())
        font.setPixelSize(round(self.fontMetrics().height() * 0.74))
        return font

    def _metrics(self) -> QFontMetrics:
        return QFontMetrics(self._small_font())

    def _row(self, metrics: QFontMetrics) -> int:
        return round(metrics.height() * 1.25)


class Card(QFrame):
    """An example that can be opened by a click or with the keyboard, or tried at once.

    ``moved_on`` asks for the card on another side: "left", "right", "up", "down".
    """

    clicked = Signal()
    try_requested = Signal()
    moved_on = Signal(str)

    def __init__(self, example: Example, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.example, self._look = example, look
        title, sentence = tr(example.title), tr(example.sentence)
        signs = [difficulty_of(example), *signs_of(example)]
        self.setProperty("kind", "card")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setAccessibleName(f"{title}. {sentence}")
        self.setAccessibleDescription(". ".join(words for _, words in signs))
        self.setToolTip("\n".join(f"• {tr(each.words)}" for each in example.tries))
        self._fill(title, sentence, signs)

    def _fill(self, title: str, sentence: str, signs: Sequence[Sign]) -> None:
        line = self.fontMetrics().height()
        self.picture = QLabel()
        self.picture.setAlignment(Qt.AlignmentFlag.AlignLeading | Qt.AlignmentFlag.AlignTop)
        self.picture.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.picture.setFixedHeight(round(line * PICTURE_LINES))
        self.signs = Signs(signs, self._look)
        inside = QVBoxLayout()
        inside.setContentsMargins(line // 2, line // 4, line // 2, 0)
        inside.setSpacing(line // 4)
        inside.addWidget(_label(title, "heading"))
        inside.addWidget(_label(sentence, "hint"))
        inside.addWidget(self.signs)
        inside.addStretch(1)
        inside.addLayout(self._buttons(title, line))
        box = QVBoxLayout(self)
        box.setContentsMargins(2, 2, 2, line // 2)
        box.setSpacing(0)
        box.addWidget(self.picture)
        box.addLayout(inside, 1)
        self.set_width(round(line * CARD_LINES) + 4)

    def _buttons(self, title: str, line: int) -> Flow:
        row = Flow(spacing=line // 3)
        row.setContentsMargins(0, line // 4, 0, 0)
        self.try_button = QPushButton(tr("Try on the simulator"))
        self.try_button.setIcon(icon("play", self._look.theme))
        self.try_button.setIconSize(icon_room(line))
        self.try_button.setAccessibleName(tr("Try “{example}” on the simulator", example=title))
        self.try_button.clicked.connect(self.try_requested)
        self.open_button = QPushButton(tr("Open"))
        self.open_button.setAccessibleName(tr("Open “{example}”", example=title))
        self.open_button.clicked.connect(self.clicked)
        for button in (self.try_button, self.open_button):
            button.setCursor(Qt.CursorShape.ArrowCursor)
            row.addWidget(button)
        return row

    def set_width(self, width: int) -> None:
        """Be so wide, and as high as that needs."""
        layout = self.layout()
        if layout is None or self.minimumWidth() == width:
            return
        self.setFixedWidth(width)
        self.setMinimumHeight(layout.totalHeightForWidth(width))

    def picture_size(self) -> QSize:
        """How large the picture is, in pixels of the window."""
        return QSize(self.minimumWidth() - 4, self.picture.height())

    def is_painted(self) -> bool:
        """Whether the picture is as wide as the card."""
        picture = self.picture.pixmap()
        wide = round(picture.width() / picture.devicePixelRatio()) if picture else 0
        return wide == self.picture_size().width()

    def show_picture(self, picture: QPixmap) -> None:
        """Show the picture."""
        self.picture.setPixmap(picture)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """A click."""
        if event.button() == Qt.MouseButton.LeftButton and self.rect().contains(
            event.position().toPoint()
        ):
            self.clicked.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter and Space are a click; arrows go to the cards around."""
        key = Qt.Key(event.key())
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space):
            self.clicked.emit()
        elif key in ARROWS and event.modifiers() in (
            Qt.KeyboardModifier.NoModifier,
            Qt.KeyboardModifier.KeypadModifier,
        ):
            self.moved_on.emit(ARROWS[key])
        else:
            super().keyPressEvent(event)

    def enterEvent(self, event: QEnterEvent) -> None:
        """Show that it can be clicked."""
        super().enterEvent(event)
        self.update()

    def focusInEvent(self, event: QFocusEvent) -> None:
        """Show the focus."""
        super().focusInEvent(event)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw a line around it when the mouse or the keyboard is there."""
        super().paintEvent(event)
        if not self.hasFocus() and not self.underMouse():
            return
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            width = max(2.0, self.fontMetrics().height() / 9)
            painter.setPen(
                QPen(self._look.theme.colour("focus" if self.hasFocus() else "accent"), width)
            )
            half, round_ = width / 2, self.fontMetrics().height() * 0.42
            inner = self.rect().toRectF().adjusted(half, half, -half, -half)
            painter.drawRoundedRect(inner, round_, round_)


def _label(words: str, role: str) -> QLabel:
    label = QLabel(words)
    label.setWordWrap(True)
    label.setProperty("role", role)
    begin_where_reading_begins(label)
    if role == "heading":
        font = QFont(label.font())
        font.setWeight(QFont.Weight.DemiBold)
        label.setFont(font)
    return label
