"""Plays a recording into the network: which, how fast, again and again, stop."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QCheckBox, QComboBox, QHBoxLayout, QPushButton, QToolButton, QWidget

from nep_studio.run.node_board import NodeStatus
from nep_studio.run.plan import REPLAY, PlannedNode
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.labels import ElidedLabel
from nep_studio.ui.words import tr

RECORDING = "recording"
"""The name of the node that plays."""

_TIMES = "\N{MULTIPLICATION SIGN}"
_SPEEDS = (0.25, 0.5, 1.0, 2.0, 5.0, 10.0)


class ReplayBar(QWidget):
    """Is there after a recording was chosen, until it is closed.

    ``start_asked`` gives the node to start, ``stop_asked`` follows when it is to end.
    """

    start_asked = Signal(object)
    stop_asked = Signal()

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self.path: Path | None = None
        self.is_playing = self._has_begun = False
        self.words = ElidedLabel()
        self.speed = QComboBox()
        self.speed.setAccessibleName(tr("Speed"))
        self.speed.setToolTip(tr("Speed"))
        for speed in _SPEEDS:
            self.speed.addItem(f"{speed:g} {_TIMES}", speed)
        self.speed.setCurrentIndex(_SPEEDS.index(1.0))
        self.again = QCheckBox(tr("Again and again"))
        self.button = QPushButton()
        self.close_button = QToolButton()
        self.close_button.setToolTip(tr("Close"))
        self.close_button.setAccessibleName(tr("Close"))
        self._lay_out()
        self.button.clicked.connect(self.toggle)
        self.close_button.clicked.connect(self._on_close)
        self.speed.currentIndexChanged.connect(self._on_speed_changed)
        look.theme_changed.connect(self._dress)
        self._dress()
        self._show_state()
        self.hide()

    def _lay_out(self) -> None:
        row = QHBoxLayout(self)
        row.setContentsMargins(*[self.fontMetrics().height() // 4] * 4)
        row.addWidget(self.words, 1)
        for widget in (self.speed, self.again, self.button, self.close_button):
            row.addWidget(widget)

    def choose(self, path: Path) -> None:
        """Play this file, or this folder of files."""
        if self.is_playing:
            self.stop()
        self.path = path
        self.show()
        self.start()

    def start(self) -> None:
        """Play from the beginning."""
        if self.path is None:
            return
        self.is_playing, self._has_begun = True, False
        settings: dict[str, str | float | int | bool] = {
            "recording": str(self.path),
            "speed": float(self.speed.currentData()),
            "loop": self.again.isChecked(),
            "quit_at_end": True,
        }
        self._show_state()
        self.start_asked.emit(PlannedNode(REPLAY, RECORDING, settings, tr("it was asked for")))

    def stop(self) -> None:
        """Play no more."""
        self.is_playing = False
        self._show_state()
        self.stop_asked.emit()

    def toggle(self) -> None:
        """Play, or stop."""
        if self.is_playing:
            self.stop()
        else:
            self.start()

    def see(self, status: NodeStatus | None) -> None:
        """Take note of how the node that plays is doing."""
        if status is None or not self.is_playing:
            return
        if status.is_there:
            self._has_begun = True
        elif self._has_begun:  # before, it was another one that ended
            self.note_end()

    def note_end(self) -> None:
        """The node that plays has ended, or could not start."""
        self.is_playing = False
        self._show_state()

    def _show_state(self) -> None:
        name = self.path.name if self.path is not None else ""
        words = tr("Plays “{name}”", name=name) if self.is_playing else f"“{name}”"
        self.words.set_words(words)
        self.button.setText(tr("Stop") if self.is_playing else tr("Play"))

    def _dress(self) -> None:
        self.close_button.setIcon(icon("x", self._look.theme))

    def _on_speed_changed(self) -> None:
        if self.is_playing:
            self.start()  # another speed is another node: the old one is stopped for it

    def _on_close(self) -> None:
        if self.is_playing:
            self.stop()
        self.hide()
