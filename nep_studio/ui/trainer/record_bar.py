"""Below the graph: what records, how far it is, and what came of it."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import (
    QLabel,
    QProgressBar,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from nep_studio.ui.messages import announce
from nep_studio.ui.panels.flow import FlowLayout
from nep_studio.ui.theme import icon
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.keeping import Keeping
from nep_studio.ui.trainer.session import TakeSession
from nep_studio.ui.trainer.take_view import TakeView
from nep_studio.ui.trainer.wearer_box import WearerBox
from nep_studio.ui.words import tr


class RecordBar(QWidget):
    """One button that records and stops, beside it who is recorded and what goes on."""

    def __init__(
        self, desk: TrainerDesk, keeping: Keeping, session: TakeSession, take: TakeView
    ) -> None:
        super().__init__()
        self._desk, self._session, self._take = desk, session, take
        self.gesture = ""
        self.button, self.cancel = QPushButton(), QPushButton(tr("Cancel"))
        self.play, self.back = QToolButton(), QPushButton(tr("Back to the live graph"))
        self.everyday = QPushButton(tr("Everyday movement"))
        self.wearer = WearerBox(desk, keeping)
        self.wearer.setParent(self)
        self.words, self.progress = QLabel(), QProgressBar()
        self._lay_out()
        self.cancel.clicked.connect(session.cancel)
        self.play.clicked.connect(take.play)
        self.back.clicked.connect(lambda: desk.choose_take(""))
        for signal in (session.changed, desk.changed, take.changed, desk.take_chosen):
            signal.connect(self.refresh)
        desk.look.theme_changed.connect(self._dress)
        self._dress()
        self.refresh()

    def _lay_out(self) -> None:
        for button in (self.button, self.cancel, self.back, self.everyday):
            button.setAutoDefault(False)
        tip = tr("Record how you usually move: the program learns what is no gesture")
        self.everyday.setToolTip(tip)
        self.back.setProperty("kind", "quiet")
        self.words.setTextFormat(Qt.TextFormat.PlainText)
        self.words.setWordWrap(True)
        self.words.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        self.progress.setRange(0, 100)
        self.progress.setAccessibleName(tr("How much is recorded"))
        row = FlowLayout(gap=self.fontMetrics().height() // 3)
        wearer = (self.wearer.who, self.wearer.where)
        for widget in (self.button, self.cancel, self.play, self.back, *wearer, self.everyday):
            row.addWidget(widget)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.setSpacing(self.fontMetrics().height() // 4)
        box.addWidget(self.words)  # first: what came of it is seen without scrolling
        box.addWidget(self.progress)
        box.addLayout(row)

    def tell(self, words: str) -> None:
        """Say what came of it, on the screen and to screen readers."""
        self.words.setText(words)
        self.words.setVisible(bool(words))
        announce(self, words)

    def set_gesture(self, name: str) -> None:
        """Record this gesture when the button is pressed."""
        self.gesture = name
        self.refresh()

    def refresh(self, _what: object = None) -> None:
        """Show what can be done now."""
        session, is_open = self._session, self._take.is_open
        is_everyday = session.state == "everyday"
        gesture = self._desk.gestures.get(self.gesture)
        self.button.setVisible(session.is_on or not is_open)
        self.button.setEnabled(session.is_on or gesture is not None)
        if session.is_on:
            self._show_button(tr("Stop"), "stop")
        elif gesture is not None:
            words = tr("Record “{gesture}”", gesture=_short(gesture.title))
            self._show_button(words, "primary")
        else:
            self._show_button(tr("Record"), "primary")
        self.cancel.setVisible(session.is_on)
        self.play.setVisible(is_open and not session.is_on)
        self.back.setVisible(is_open and not session.is_on)
        for widget in (self.wearer.who, self.wearer.where, self.everyday):
            widget.setVisible(not session.is_on and not is_open)
        self.everyday.setEnabled(self._desk.editor is not None)
        self.progress.setVisible(is_everyday)
        self.progress.setValue(round(session.share * 100))
        self._dress_play()
        self.words.setVisible(bool(self.words.text()))

    def _show_button(self, words: str, kind: str) -> None:
        if (words, kind) == (self.button.text(), self.button.property("kind")):
            return
        self.button.setText(words)
        self.button.setToolTip(tr("Space"))
        if kind != self.button.property("kind"):
            self.button.setProperty("kind", kind)
            self.button.style().unpolish(self.button)
            self.button.style().polish(self.button)
            self._dress()

    def _dress(self) -> None:
        theme = self._desk.look.theme
        is_on = self._session.is_on
        name, colour = ("square", "stop_text") if is_on else ("circle-dot", "accent_text")
        self.button.setIcon(icon(name, theme.colour(colour)))
        line = self.fontMetrics().height()
        self.play.setIconSize(QSize(line, line))
        self.everyday.setIcon(icon("footprints", theme))
        self._dress_play()

    def _dress_play(self) -> None:
        is_playing = self._take.cursor_s is not None
        words = tr("Stop playing") if is_playing else tr("Play the take")
        if words != self.play.accessibleName():
            self.play.setAccessibleName(words)
            self.play.setToolTip(words)
        self.play.setIcon(icon("square" if is_playing else "play", self._desk.look.theme))


def _short(title: str) -> str:
    """A title that leaves room for others."""
    return title if len(title) <= 24 else title[:23] + "…"
