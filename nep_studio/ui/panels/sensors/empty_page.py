"""What the panel says while nothing is measured: what belongs there, and the first steps."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from nep_studio.ui.words import tr

_WIDEST_LINES = 30


class EmptyPage(QScrollArea):
    """Offers a watch, a recording, or any number of the network."""

    watch_asked = Signal()
    replay_asked = Signal()
    choose_asked = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWidgetResizable(True)
        inside = QWidget()
        box = QVBoxLayout(inside)
        box.addStretch(1)
        title = QLabel(tr("What sensors measure is drawn here as curves."))
        title.setProperty("role", "heading")
        hint = QLabel(
            tr(
                "Start a simulated watch, play a recording, or connect a watch or phone: "
                "its curves appear by themselves. You can also choose any number that a node sends."
            )
        )
        hint.setProperty("role", "hint")
        for label in (title, hint):
            label.setWordWrap(True)
            label.setAlignment(Qt.AlignmentFlag.AlignCenter)
            box.addWidget(label)
        self.watch_button = QPushButton(tr("Start the virtual watch"))
        self.watch_button.setProperty("kind", "primary")
        self.replay_button = QPushButton(tr("Replay a recording…"))
        self.choose_button = QPushButton(tr("Choose numbers…"))
        box.addLayout(self._buttons())
        box.addStretch(1)
        self.setWidget(inside)
        self.watch_button.clicked.connect(self.watch_asked)
        self.replay_button.clicked.connect(self.replay_asked)
        self.choose_button.clicked.connect(self.choose_asked)

    def show_starting(self, is_starting: bool) -> None:
        """Say that the watch is on its way."""
        words = tr("The virtual watch starts…") if is_starting else tr("Start the virtual watch")
        self.watch_button.setText(words)
        self.watch_button.setEnabled(not is_starting)

    def _buttons(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.addStretch(1)
        for button in (self.watch_button, self.replay_button, self.choose_button):
            row.addWidget(button)
        row.addStretch(1)
        return row
