"""Says how a recording goes on, and lets it be stopped."""

from __future__ import annotations

from PySide6.QtCore import QTimer
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QWidget

from nep_studio.ui.elided_label import ElidedLabel
from nep_studio.ui.panels.sensors.recorder import Recorder
from nep_studio.ui.theme import Look, icon_pixmap
from nep_studio.ui.words import tr

_REFRESH_MS = 500


class RecordBar(QWidget):
    """Is there while something is recorded."""

    def __init__(self, recorder: Recorder, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._recorder, self._look = recorder, look
        self._sign = QLabel()
        self.words = ElidedLabel()
        self.stop_button = QPushButton(tr("Stop recording"))
        self.stop_button.setProperty("kind", "stop")
        row = QHBoxLayout(self)
        row.setContentsMargins(*[self.fontMetrics().height() // 4] * 4)
        for widget, stretch in ((self._sign, 0), (self.words, 1), (self.stop_button, 0)):
            row.addWidget(widget, stretch)
        self.stop_button.clicked.connect(recorder.stop)
        self._timer = QTimer(self, interval=_REFRESH_MS)
        self._timer.timeout.connect(self.refresh)
        recorder.started.connect(self._on_changed)
        recorder.stopped.connect(self._on_changed)
        look.theme_changed.connect(self._dress)
        self._dress()
        self._on_changed()

    def refresh(self) -> None:
        """Say how long, how much, how fast, and what was lost."""
        one = self._recorder
        minutes, seconds = divmod(int(one.elapsed_s), 60)
        parts = [
            tr("Recording {time}", time=f"{minutes}:{seconds:02}"),
            _size(one.size_bytes),
            tr("{rate} samples a second", rate=f"{one.rate_hz:.0f}"),
            tr("{count} lost", count=one.lost),
        ]
        self.words.set_words("  ·  ".join(parts))

    def _on_changed(self) -> None:
        is_recording = self._recorder.is_recording
        self.setVisible(is_recording)
        if is_recording:
            self._timer.start()
        else:
            self._timer.stop()
        self.refresh()

    def _dress(self) -> None:
        colour = QColor(self._look.theme.colour("stop"))
        size = self.fontMetrics().height()
        ratio = self.devicePixelRatioF()
        self._sign.setPixmap(icon_pixmap("circle-dot", colour, size, ratio))


def _size(size_bytes: int) -> str:
    if size_bytes < 1_000_000:
        return tr("{size} kB", size=round(size_bytes / 1000))
    return tr("{size} MB", size=f"{size_bytes / 1e6:.1f}")
