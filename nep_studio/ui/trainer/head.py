"""The head of the panel: the watch, more that can be done, and the next step."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, QTimer, Signal
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from nep_studio.ui.theme import icon
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.hint import button_words, hint_words, next_step
from nep_studio.ui.watches.status import WatchStatus
from nep_studio.ui.words import tr

LOOK_MS = 500


class HintLine(QWidget):
    """The one next thing to do; ``asked`` gives the step and the gesture when it is pressed."""

    asked = Signal(str, str)

    def __init__(self, desk: TrainerDesk) -> None:
        super().__init__()
        self._desk = desk
        self._sign, self.words, self.button = QLabel(), QLabel(), QPushButton()
        self.words.setWordWrap(True)
        self.words.setTextFormat(Qt.TextFormat.PlainText)
        self.words.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        self.button.setAutoDefault(False)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self._sign, 0, Qt.AlignmentFlag.AlignVCenter)
        row.addWidget(self.words, 1)
        row.addWidget(self.button, 0, Qt.AlignmentFlag.AlignVCenter)
        self.button.clicked.connect(lambda: self.asked.emit(*next_step(desk)))
        self._looking = QTimer(self, interval=LOOK_MS)
        self._looking.timeout.connect(self.refresh)
        desk.changed.connect(self.refresh)
        desk.sources_changed.connect(self.refresh)
        desk.look.theme_changed.connect(self._dress)
        self._dress()
        self.refresh()

    def refresh(self) -> None:
        """Show the step that is next now."""
        words = hint_words(self._desk)
        if words != self.words.text():
            self.words.setText(words)
        pressed = button_words(next_step(self._desk)[0])
        if pressed != self.button.text():
            self.button.setText(pressed)
        self.button.setVisible(bool(pressed))

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
        theme, line = self._desk.look.theme, self.fontMetrics().height()
        picture = icon("lightbulb", theme.colour("info"))
        self._sign.setPixmap(picture.pixmap(QSize(line, line), self.devicePixelRatioF()))


class Head(QWidget):
    """``more_asked`` tells that the button with more was pressed."""

    more_asked = Signal()

    def __init__(self, desk: TrainerDesk) -> None:
        super().__init__()
        self._desk = desk
        self.watch, self.more = WatchStatus(desk.runner, desk.look), QToolButton()
        self.hint = HintLine(desk)
        self.more.setAccessibleName(tr("Import, export and more"))
        self.more.setToolTip(tr("Import, export and more"))
        self.more.clicked.connect(self.more_asked)
        row = QHBoxLayout()
        row.addWidget(self.watch, 1)
        row.addWidget(self.more)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.setSpacing(self.fontMetrics().height() // 3)
        box.addLayout(row)
        box.addWidget(self.hint)
        desk.look.theme_changed.connect(self._dress)
        self._dress()

    def _dress(self) -> None:
        line = self.fontMetrics().height()
        self.more.setIcon(icon("ellipsis", self._desk.look.theme))
        self.more.setIconSize(QSize(line, line))
