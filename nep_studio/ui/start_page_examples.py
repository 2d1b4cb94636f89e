"""The examples as cards: a picture of the blocks, a title, a sentence."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import (
    QEnterEvent,
    QFocusEvent,
    QFont,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPixmap,
)
from PySide6.QtWidgets import QFrame, QLabel, QSizePolicy, QVBoxLayout, QWidget

from nep_studio import paths
from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr

CARD_LINES, PICTURE_LINES = 15.0, 7.5
"""How wide a card is, and how high its picture, in lines of text."""


def example_files() -> list[Path]:
    """The examples that come with the program."""
    return sorted(paths.examples().glob("*.nep"))


def example_title(path: Path) -> str:
    """What an example is called."""
    return _about().get(path.stem, (path.stem.replace("_", " ").capitalize(), ""))[0]


def example_sentence(path: Path) -> str:
    """What an example does, in a sentence."""
    return _about().get(path.stem, ("", ""))[1]


def _about() -> dict[str, tuple[str, str]]:
    return {
        "karate_greeting": (
            tr("Karate greeting"),
            tr("Make a karate chop, and NAO bows to its master."),
        ),
        "five_gestures": (tr("Five gestures"), tr("One answer of the robot for each gesture.")),
        "imitate_animals": (
            tr("NAO imitates animals"),
            tr("Make an animal's gesture: NAO plays the animal."),
        ),
        "theatre_sequence": (
            tr("Theatre sequence"),
            tr("A little play from beginning to end, without a sensor."),
        ),
        "two_robots_talk": (tr("Two robots talk"), tr("Two robots have a conversation.")),
    }


class Card(QFrame):
    """A card that can be clicked, or chosen with the keyboard."""

    clicked = Signal()

    def __init__(
        self, title: str, sentence: str, look: Look, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._look = look
        self.setProperty("kind", "card")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setAccessibleName(f"{title}. {sentence}")
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        line = self.fontMetrics().height()
        self.picture = QLabel()
        self.picture.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.picture.setFixedSize(_picture_size(line))
        box = QVBoxLayout(self)
        box.setContentsMargins(2, 2, 2, line // 2)
        box.setSpacing(line // 6)
        box.addWidget(self.picture)
        box.addWidget(_label(title, "heading", line))
        box.addWidget(_label(sentence, "hint", line))
        box.addStretch(1)
        self.setFixedSize(round(line * CARD_LINES) + 4, round(line * (PICTURE_LINES + 4.3)))

    def picture_size(self) -> QSize:
        """How large the picture is, in pixels of the window."""
        return self.picture.size()

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
        """Enter and Space are a click."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space):
            self.clicked.emit()
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


def _picture_size(line: int) -> QSize:
    return QSize(round(line * CARD_LINES), round(line * PICTURE_LINES))


def _label(words: str, role: str, line: int) -> QLabel:
    label = QLabel(words)
    label.setWordWrap(True)
    label.setProperty("role", role)
    label.setContentsMargins(line // 2, 0, line // 2, 0)
    if role == "heading":
        font = QFont(label.font())
        font.setWeight(QFont.Weight.DemiBold)
        label.setFont(font)
    return label
