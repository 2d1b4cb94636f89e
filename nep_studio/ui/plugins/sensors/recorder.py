"""Records in a thread of its own: a slow disk does not hold up the window."""

from __future__ import annotations

import contextlib
import math
import os
import queue
import threading
import time
from itertools import count
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtWidgets import QCheckBox, QComboBox, QLabel, QPushButton, QToolButton, QWidget

from faults import reason_of
from nep_core.errors import RecordingError
from nep_core.wire.messages import Imu
from nep_studio.run.node_board import NodeStatus
from nep_studio.run.plan import REPLAY, PlannedNode
from nep_studio.ui.labels import explained, follow_words, labelled
from nep_studio.ui.theme.icons import icon, icon_pixmap
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import ElidedLabel
from nep_studio.ui.widgets.layouts import in_row
from nep_studio.ui.words import tr
from nodes.recordings import MAX_SAMPLES

from .feed import SensorFeed
from .streams import ImuStream

# Writes what sensors measure to files while it comes; nodes/sensory/replay.py reads them.

_LONGEST_GAP_S = 600.0
_CHECKLIST = (
    "Is there room on the disk?",
    "Choose a folder that you may write into, such as one in your home folder.",
    "Is the folder on a stick or in the network? Is it still connected?",
)


class Part:
    """One file: samples of one sensor whose times go on; it is readable at every moment.

    Only whole lines are written, each batch at once; when one does not fit on the disk, what of
    it was written is taken away again. Raises OSError.
    """

    def __init__(self, path: Path, first: Imu) -> None:
        self.path = path
        self.samples = 0
        self.size_bytes = 0
        self._first_t = self._last_t = next(filter(math.isfinite, first.t), 0.0)
        self._kind = _kind(first)
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
        try:
            self._write(_header(first))
        except OSError:
            self.close()
            raise

    def fits(self, batch: Imu) -> bool:
        """Whether a batch goes on in this file: the reader wants times that rise, and limits."""
        gap_s = batch.t[-1] - self._last_t
        is_next = 0 < gap_s < _LONGEST_GAP_S or not self.samples
        has_room = self.samples + len(batch.t) <= MAX_SAMPLES
        return is_next and has_room and _kind(batch) == self._kind

    def add(self, batch: Imu) -> None:
        """Write a batch."""
        lines: list[str] = []
        for at, t in enumerate(batch.t):
            row = (*batch.acc[at], *(batch.gyr[at] if batch.gyr is not None else ()))
            is_later = t > self._last_t or not self.samples + len(lines)
            if not is_later or not all(map(math.isfinite, (t, *row))):
                continue  # the reader refuses such lines
            cells = ",".join(f"{value:.6g}" for value in row)
            lines.append(f"{t - self._first_t:.6f},{cells}\n")
            self._last_t = t
        self._write("".join(lines))
        self.samples += len(lines)

    def keep(self) -> None:
        """See to it that what was written is on the disk."""
        os.fsync(self._file)

    def close(self) -> None:
        """Write no more; a file with too few samples to be read goes."""
        with contextlib.suppress(OSError):
            os.fsync(self._file)
        with contextlib.suppress(OSError):
            os.close(self._file)
        if self.samples < 2:
            self.path.unlink(missing_ok=True)

    def _write(self, text: str) -> None:
        data = text.encode()
        written = 0
        try:
            while written < len(data):
                written += os.write(self._file, data[written:])
        except OSError:
            with contextlib.suppress(OSError):
                os.ftruncate(self._file, self.size_bytes)
            raise
        self.size_bytes += len(data)


class Recording:
    """Files in one folder: one for each sensor, and another where its times do not go on.

    ``add`` raises RecordingError; what was written before is kept.
    """

    def __init__(self, folder: Path, stem: str) -> None:
        self.folder, self.stem = folder, stem
        self.samples = 0
        self.size_bytes = 0
        self.paths: list[Path] = []
        self._parts: dict[str, Part] = {}

    def open(self) -> None:
        """Make sure that there can be files; raises RecordingError."""
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            probe = self.folder / f".{self.stem}.{os.getpid()}.probe"
            probe.write_bytes(b"")
            probe.unlink()
        except OSError as error:
            raise _not_written(self.folder, error) from error

    def add(self, batch: Imu) -> None:
        """Write a batch; one whose rows do not fit its times is left out."""
        columns = (batch.acc,) if batch.gyr is None else (batch.acc, batch.gyr)
        if not batch.t or any(len(one) != len(batch.t) for one in columns):
            return
        try:
            part = self._part(batch)
            samples, size_bytes = part.samples, part.size_bytes
            part.add(batch)
        except OSError as error:
            raise _not_written(self.folder, error) from error
        self.samples += part.samples - samples
        self.size_bytes += part.size_bytes - size_bytes

    def keep(self) -> None:
        """See to it that all is on the disk; raises RecordingError."""
        try:
            for part in self._parts.values():
                part.keep()
        except OSError as error:
            raise _not_written(self.folder, error) from error

    def close(self) -> list[Path]:
        """Write no more; the files that are there."""
        for part in self._parts.values():
            part.close()
        self._parts.clear()
        self.paths = [path for path in self.paths if path.exists()]
        return self.paths

    def _part(self, batch: Imu) -> Part:
        part = self._parts.get(batch.source)
        if part is not None and part.fits(batch):
            return part
        if part is not None:
            part.close()
        made = self._parts[batch.source] = Part(self._free_path(), batch)
        self.paths.append(made.path)
        self.size_bytes += made.size_bytes
        return made

    def _free_path(self) -> Path:
        numbers = count(len(self.paths) + 1)
        names = (f"{self.stem}.csv" if n == 1 else f"{self.stem}_{n}.csv" for n in numbers)
        return next(self.folder / name for name in names if not (self.folder / name).exists())


def _kind(batch: Imu) -> tuple[bool, bool, bool]:
    return batch.gyr is not None, batch.gravity_included, batch.simulated


def _header(first: Imu) -> str:
    has_rotation, has_gravity, is_simulated = _kind(first)
    columns = "t_s,ax,ay,az" + (",gx,gy,gz" if has_rotation else "")
    source = " ".join(first.source.split())
    return (
        f"# person: \n# source: {source}\n"
        f"# gravity_included: {'yes' if has_gravity else 'no'}\n"
        f"# simulated: {'yes' if is_simulated else 'no'}\n{columns}\n"
    )


def _not_written(folder: Path, error: OSError) -> RecordingError:
    return RecordingError(
        "The recording cannot be written to {folder}: {reason}.",
        checklist=_CHECKLIST,
        details=str(error),
        folder=folder,
        reason=reason_of(error),
    )


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

    def _on_imu_heard(self, batch: list[Imu]) -> None:
        for message in batch if self.is_recording else ():
            try:
                self._waiting.put_nowait(message)
            except queue.Full:
                self._not_taken += len(message.t)

    def _run(self, recording: Recording, waiting: queue.Queue[Imu | None]) -> None:
        failure: RecordingError | None = None
        try:
            # Write until None comes; raises RecordingError
            next_keep_s = time.monotonic() + _KEEP_S
            while (batch := waiting.get()) is not None:
                recording.add(batch)
                if time.monotonic() >= next_keep_s:
                    recording.keep()
                    next_keep_s = time.monotonic() + _KEEP_S
        except RecordingError as error:
            failure = error
        self._over.emit(recording.close(), failure)

    def _on_over(self, paths: list[Path], failure: RecordingError | None) -> None:
        self._recording = None
        self._feed.record(False)
        if failure is not None:
            self.failed.emit(failure)
        self.stopped.emit(paths)


# Says how a recording goes on, and lets it be stopped.

_REFRESH_MS = 500


class RecordBar(QWidget):
    """Is there while something is recorded."""

    def __init__(self, recorder: Recorder, look: Look) -> None:
        super().__init__()
        self._recorder, self._look = recorder, look
        self._sign = QLabel()
        self.words = ElidedLabel()
        self.stop_button = labelled(QPushButton(), text="Stop recording")
        self.stop_button.setProperty("kind", "stop")
        room = self.fontMetrics().height() // 4
        in_row(self._sign, (self.words, 1), self.stop_button, of=self, margins=room)
        self.stop_button.clicked.connect(recorder.stop)
        self._timer = QTimer(self, interval=_REFRESH_MS)
        self._timer.timeout.connect(self.refresh)
        recorder.started.connect(self._on_changed)
        recorder.stopped.connect(self._on_changed)
        look.theme_changed.connect(self._dress)
        self._dress()
        self._on_changed()
        follow_words(self, self.refresh)

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
        self.setVisible(self._recorder.is_recording)
        if self._recorder.is_recording:
            self._timer.start()
        else:
            self._timer.stop()
        self.refresh()

    def _dress(self) -> None:
        colour, size = self._look.theme.colour("stop"), self.fontMetrics().height()
        self._sign.setPixmap(icon_pixmap("circle-dot", colour, size, self.devicePixelRatioF()))


def _size(size_bytes: int) -> str:
    if size_bytes < 1_000_000:
        return tr("{size} kB", size=round(size_bytes / 1000))
    return tr("{size} MB", size=f"{size_bytes / 1e6:.1f}")


# Plays a recording into the network: which, how fast, again and again, stop.

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

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.path: Path | None = None
        self.is_playing = self._has_begun = False
        self.words = ElidedLabel()
        self.speed = explained(QComboBox(), "Speed")
        for speed in _SPEEDS:
            self.speed.addItem(f"{speed:g} {_TIMES}", speed)
        self.speed.setCurrentIndex(_SPEEDS.index(1.0))
        self.again = labelled(QCheckBox(), text="Again and again")
        self.button = QPushButton()
        self.close_button = explained(QToolButton(), "Close")
        chosen = (self.speed, self.again, self.button, self.close_button)
        in_row((self.words, 1), *chosen, of=self, margins=self.fontMetrics().height() // 4)
        self.button.clicked.connect(self.toggle)
        self.close_button.clicked.connect(self._on_close)
        self.speed.currentIndexChanged.connect(self._on_speed_changed)
        look.theme_changed.connect(self._dress)
        self._dress()
        follow_words(self, self._show_state)
        self.hide()

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
        labelled(self.button, text="Stop" if self.is_playing else "Play")

    def _dress(self) -> None:
        self.close_button.setIcon(icon("x", self._look.theme))

    def _on_speed_changed(self) -> None:
        if self.is_playing:
            self.start()  # another speed is another node: the old one is stopped for it

    def _on_close(self) -> None:
        if self.is_playing:
            self.stop()
        self.hide()
