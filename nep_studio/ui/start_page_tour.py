"""The offer of the tour on the start page, until somebody has taken it or wants none."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from nep_studio.ui.app import Studio
from nep_studio.ui.start_page_flow import Flow, begin_where_reading_begins
from nep_studio.ui.theme import icon, icon_pixmap
from nep_studio.ui.words import tr


class TourOffer(QFrame):
    """One line that offers the tour; ``accepted`` begins it."""

    accepted = Signal()

    def __init__(self, studio: Studio, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._studio = studio
        self.setProperty("kind", "info")
        line, theme = self.fontMetrics().height(), studio.look.theme
        box = QHBoxLayout(self)
        box.setContentsMargins(line // 2, line // 2, line // 2, line // 2)
        box.setSpacing(line // 2)
        sign = QLabel()
        sign.setPixmap(
            icon_pixmap("map", theme.colour("text"), line * 1.4, self.devicePixelRatioF())
        )
        box.addWidget(sign, 0, Qt.AlignmentFlag.AlignTop)
        words = QVBoxLayout()
        self.words = QLabel(tr("New here? Five short steps show how a robot gets its behaviour."))
        self.words.setWordWrap(True)
        begin_where_reading_begins(self.words)
        words.addWidget(self.words)
        words.addLayout(self._answers(line))
        box.addLayout(words, 1)
        self.setVisible(not studio.settings.tour_done)

    def _answers(self, line: int) -> Flow:
        row = Flow(spacing=line // 3)
        self.take_button = QPushButton(tr("Take the tour"))
        self.take_button.setIcon(icon("footprints", self._studio.look.theme))
        self.take_button.clicked.connect(self._on_taken)
        self.leave_button = QPushButton(tr("Not now"))
        self.leave_button.setProperty("kind", "quiet")
        self.leave_button.setToolTip(tr("The tour stays in the Help menu"))
        self.leave_button.clicked.connect(self._on_left)
        row.addWidget(self.take_button)
        row.addWidget(self.leave_button)
        return row

    def _on_taken(self) -> None:
        self._on_left()
        self.accepted.emit()

    def _on_left(self) -> None:
        self._studio.settings.tour_done = True
        self.hide()
