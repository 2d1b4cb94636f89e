"""Plays the motion on the desk: the moment that is shown goes on with the clock."""

from __future__ import annotations

from PySide6.QtCore import QElapsedTimer, QObject, Qt, QTimer, Signal

from nep_studio.ui.motion.desk import MotionDesk

FRAME_MS = 16


class Player(QObject):
    """``changed`` tells whether it plays. ``speed``: 1 is real time; ``is_looping``: for ever."""

    changed = Signal(bool)

    def __init__(self, desk: MotionDesk, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.desk = desk
        self.speed = 1.0
        self.is_looping = False
        self._clock = QElapsedTimer()
        self._timer = QTimer(self, interval=FRAME_MS, timerType=Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._on_frame)

    @property
    def is_playing(self) -> bool:
        """Whether the moment goes on by itself."""
        return self._timer.isActive()

    def play(self) -> None:
        """Play on, from the beginning when the end is reached."""
        end_s = self.desk.motion.duration_s
        if self.is_playing or end_s <= 0:
            return
        if self.desk.cursor_s >= end_s:
            self.desk.show(0.0)
        self._clock.start()
        self._timer.start()
        self.changed.emit(True)

    def pause(self) -> None:
        """Stay at the moment that is shown."""
        if self.is_playing:
            self._timer.stop()
            self.changed.emit(False)

    def toggle(self) -> None:
        """Play, or pause."""
        if self.is_playing:
            self.pause()
        else:
            self.play()

    def _on_frame(self) -> None:
        end_s = self.desk.motion.duration_s
        now_s = self.desk.cursor_s + self._clock.restart() / 1000.0 * self.speed
        if now_s < end_s:
            self.desk.show(now_s)
        elif self.is_looping and end_s > 0:
            self.desk.show(now_s % end_s)
        else:
            self.desk.show(end_s)
            self.pause()
