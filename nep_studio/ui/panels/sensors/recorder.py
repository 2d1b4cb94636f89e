"""Records in a thread of its own: a slow disk does not hold up the window."""

from __future__ import annotations

import queue
import threading
import time
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from nep_core.errors import RecordingError
from nep_core.messages import Imu
from nep_studio.ui.panels.sensors.feed import SensorFeed
from nep_studio.ui.panels.sensors.imu_stream import ImuStream
from nep_studio.ui.panels.sensors.recording import Recording

_KEEP_S = 2.0
"""How much a computer that loses its power may take with it."""
_MOST_WAITING = 20_000
_LAST_WRITING_S = 5.0


class Recorder(QObject):
    """Writes what a feed hears of sensors from ``start`` to ``stop``, looked at or not.

    ``stopped`` gives the files; ``failed`` the RecordingError that ended it, before ``stopped``.
    """

    started = Signal()
    failed = Signal(object)
    stopped = Signal(list)
    _over = Signal(list, object)

    def __init__(self, feed: SensorFeed) -> None:
        super().__init__(feed)
        self._feed = feed
        self._recording: Recording | None = None
        self._waiting: queue.Queue[Imu | None] = queue.Queue()
        self._thread: threading.Thread | None = None
        self._started_s = 0.0
        self._lost_before = self._not_taken = 0
        self._over.connect(self._on_over)
        feed.imu_heard.connect(self._on_imu_heard)

    @property
    def is_recording(self) -> bool:
        """Whether it writes now."""
        return self._recording is not None

    @property
    def elapsed_s(self) -> float:
        """How long it has been recording."""
        return time.monotonic() - self._started_s if self.is_recording else 0.0

    @property
    def samples(self) -> int:
        """How many samples are written."""
        return self._recording.samples if self._recording is not None else 0

    @property
    def size_bytes(self) -> int:
        """How large the files are."""
        return self._recording.size_bytes if self._recording is not None else 0

    @property
    def rate_hz(self) -> float:
        """How many samples a second were written, all sensors together."""
        return self.samples / self.elapsed_s if self.elapsed_s > 0.5 else 0.0

    @property
    def lost(self) -> int:
        """How many samples did not come, as far as their times tell, or were not taken."""
        return self._lost_until_now() - self._lost_before + self._not_taken

    def start(self, folder: Path) -> None:
        """Record into new files of a folder; raises RecordingError when that cannot be."""
        if self.is_recording:
            return
        recording = Recording(folder, time.strftime("recording_%Y-%m-%d_%H-%M-%S"))
        recording.open()
        self._recording, self._waiting = recording, queue.Queue(_MOST_WAITING)
        self._started_s, self._lost_before = time.monotonic(), self._lost_until_now()
        self._not_taken = 0
        arguments = recording, self._waiting
        self._thread = threading.Thread(
            target=self._run, args=arguments, name="nep-studio-record", daemon=True
        )
        self._thread.start()
        self._feed.record(True)
        self.started.emit()

    def stop(self) -> None:
        """Write what has come, and end; ``stopped`` follows."""
        if self.is_recording:
            self._feed.record(False)
            self._waiting.put(None)

    def finish(self) -> None:
        """Stop, and wait until all is written: the program ends."""
        self.stop()
        if self._thread is not None:
            self._thread.join(_LAST_WRITING_S)

    def _lost_until_now(self) -> int:
        return sum(one.lost for one in self._feed.streams.values() if isinstance(one, ImuStream))

    def _on_imu_heard(self, pairs: list[tuple[Imu, float]]) -> None:
        if not self.is_recording:
            return
        for message, _ in pairs:
            try:
                self._waiting.put_nowait(message)
            except queue.Full:
                self._not_taken += len(message.t)

    def _run(self, recording: Recording, waiting: queue.Queue[Imu | None]) -> None:
        failure: RecordingError | None = None
        try:
            _write_all(recording, waiting)
        except RecordingError as error:
            failure = error
        self._over.emit(recording.close(), failure)

    def _on_over(self, paths: list[Path], failure: RecordingError | None) -> None:
        self._recording = None
        self._feed.record(False)
        if failure is not None:
            self.failed.emit(failure)
        self.stopped.emit(paths)


def _write_all(recording: Recording, waiting: queue.Queue[Imu | None]) -> None:
    """Write until None comes; raises RecordingError."""
    next_keep_s = time.monotonic() + _KEEP_S
    while (batch := waiting.get()) is not None:
        recording.add(batch)
        if time.monotonic() >= next_keep_s:
            recording.keep()
            next_keep_s = time.monotonic() + _KEEP_S
