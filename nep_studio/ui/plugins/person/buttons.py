"""The buttons of the simulated human, which are pressed, held, or put on and off."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QElapsedTimer, QSize, Qt, QTimer
from PySide6.QtGui import QPaintEvent
from PySide6.QtWidgets import (
    QPushButton,
    QSizePolicy,
    QStyle,
    QStyleOptionButton,
    QStylePainter,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from nep_studio.project.triggers import Happening
from nep_studio.ui.theme.icons import icon, icon_room
from nep_studio.ui.theme.look import Look
from nep_studio.ui.words import tr

from .words import ICONS, words_of

LASTS_MS = 500
"""A touch lasts at least so long, however short the click is."""
FEWEST_LETTERS = 6
HELD = ("touch",)
KEPT = ("face", "ball", "mark")


class WordsButton(QPushButton):
    """A button whose words end in … where there is no room for all of them."""

    def __init__(self, words: str, look: Look, icon_name: str = "") -> None:
        super().__init__()
        self._look, self._icon_name = look, icon_name
        self.words = ""
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self.set_words(words)
        look.theme_changed.connect(self._dress)
        self._dress()

    def set_words(self, words: str) -> None:
        """Show these words."""
        self.words = words
        self.setText(words.replace("&", "&&"))
        self.setAccessibleName(words)
        self.setToolTip(words)

    def minimumSizeHint(self) -> QSize:
        """A few letters at least."""
        usual, letter = self.sizeHint(), self.fontMetrics().averageCharWidth()
        spare = self.fontMetrics().horizontalAdvance(self.words) - letter * FEWEST_LETTERS
        return QSize(usual.width() - max(spare, 0), usual.height())

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint as many of the words as there is room for."""
        option = QStyleOptionButton()
        self.initStyleOption(option)
        lacking = max(self.sizeHint().width() - self.width(), 0)
        room = self.fontMetrics().horizontalAdvance(self.words) + 1 - lacking
        mode = Qt.TextElideMode.ElideRight
        shown = self.fontMetrics().elidedText(self.words, mode, room)
        option.text = shown.replace("&", "&&")
        QStylePainter(self).drawControl(QStyle.ControlElement.CE_PushButton, option)

    def _dress(self) -> None:
        line = self.fontMetrics().height()
        if self._icon_name:
            self.setIcon(icon(self._icon_name, self._look.theme))
            self.setIconSize(icon_room(line))


class HappeningButton(WordsButton):
    """Lets something happen: while it is held, until it is pressed again, or once."""

    def __init__(
        self,
        happening: Happening,
        look: Look,
        begin: Callable[[Happening], bool],
        end: Callable[[Happening], None],
        words: str = "",
    ) -> None:
        super().__init__(words or words_of(happening), look, ICONS[happening.kind])
        self.happening, self._begin, self._end = happening, begin, end
        self._letting_go = QTimer(self, singleShot=True, interval=LASTS_MS)
        self._letting_go.timeout.connect(self.let_go)
        self.is_held = False
        self._since = QElapsedTimer()
        if happening.kind in HELD:
            self.pressed.connect(self._on_pressed)
            self.released.connect(self._on_released)
        elif happening.kind in KEPT:
            self.setCheckable(True)
            self.clicked.connect(self._on_switched)
        else:
            self.clicked.connect(lambda: self._begin(self.happening))

    def let_go(self) -> None:
        """End a touch."""
        if self.is_held:
            self.is_held = False
            self._end(self.happening)

    def _on_pressed(self) -> None:
        self._letting_go.stop()
        self.let_go()
        self._since.start()
        self.is_held = self._begin(self.happening)

    def _on_released(self) -> None:
        """A quick click is felt as well as a long one."""
        self._letting_go.start(max(LASTS_MS - self._since.elapsed(), 0))

    def _on_switched(self, is_on: bool) -> None:
        if not is_on:
            self._end(self.happening)
        elif not self._begin(self.happening):
            self.setChecked(False)


# A part of a panel with a heading, which can be folded away.


class Section(QWidget):
    """A heading that folds, and a box below it."""

    def __init__(self, title: str, look: Look, *, is_open: bool = True) -> None:
        super().__init__()
        self._look, self.is_open = look, is_open
        self.heading = QToolButton()
        self.heading.setText(title)
        self.heading.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.heading.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.body = QWidget()
        self.box = QVBoxLayout(self.body)
        line = self.fontMetrics().height()
        self.box.setContentsMargins(line // 2, 0, 0, line // 2)
        self.box.setSpacing(line // 3)
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.setSpacing(line // 6)
        outer.addWidget(self.heading)
        outer.addWidget(self.body)
        self.heading.clicked.connect(lambda: self.open(not self.is_open))
        look.theme_changed.connect(self._dress)
        self.open(is_open)

    def open(self, is_open: bool) -> None:
        """Show or fold away what is in it."""
        self.is_open = is_open
        self.body.setVisible(is_open)
        self.heading.setAccessibleDescription(tr("open") if is_open else tr("folded"))
        self._dress()

    def _dress(self) -> None:
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        folded = "chevron-left" if is_mirrored else "chevron-right"
        name = "chevron-down" if self.is_open else folded
        font = self.font()
        font.setBold(True)
        self.heading.setFont(font)
        self.heading.setIcon(icon(name, self._look.theme))
        self.heading.setIconSize(icon_room(self.fontMetrics().height()))
