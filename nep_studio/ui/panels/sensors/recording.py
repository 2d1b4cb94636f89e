"""Writes what sensors measure to files while it comes; nodes/sensory/replay.py reads them."""

from __future__ import annotations

import contextlib
import math
import os
from pathlib import Path

from nep_core.errors import RecordingError
from nep_core.messages import Imu
from nodes.recording_table import MAX_SAMPLES

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
        if not _is_whole(batch):
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
        number = len(self.paths) + 1
        while True:
            path = self.folder / (
                f"{self.stem}.csv" if number == 1 else f"{self.stem}_{number}.csv"
            )
            if not path.exists():
                return path
            number += 1


def _is_whole(batch: Imu) -> bool:
    count = len(batch.t)
    return count > 0 and len(batch.acc) == count and (batch.gyr is None or len(batch.gyr) == count)


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
        f"The recording cannot be written to {folder}: {error.strerror}.",
        checklist=_CHECKLIST,
        details=str(error),
    )
