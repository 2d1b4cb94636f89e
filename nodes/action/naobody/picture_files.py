"""Writes pictures as PNG files and videos as animated PNG files, which browsers play."""

from __future__ import annotations

import contextlib
import os
import shutil
import struct
import tempfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]
"""Rows of red, green, blue: (rows, columns, 3)."""

ENDING = ".png"
KNOWN_ENDINGS = (".png", ".apng", ".jpg", ".jpeg", ".bmp", ".avi", ".mp4")
RESERVED = frozenset(
    {"con", "prn", "aux", "nul"} | {f"{d}{n}" for d in ("com", "lpt") for n in range(10)}
)
"""Names that mean devices on Windows."""
LONGEST_NAME_BYTES = 150
SIGNATURE = b"\x89PNG\r\n\x1a\n"
EIGHT_BITS_RGB = (8, 2, 0, 0, 0)
COMPRESSION = 4
UP = 2
"""The PNG filter that keeps how each row differs from the one above it."""
COUNT_AT = len(SIGNATURE) + 25 + 8
"""Where the file of a video says how many frames it has."""
MILLISECONDS = 1000
LONGEST_FRAME_MS = 0xFFFF


def safe_name(name: str, instead: str) -> str:
    """Return a name as a name of a file without folders; ``instead`` is for one that has none."""
    last = name.replace("\\", "/").rsplit("/", 1)[-1].strip()
    stem, dot, ending = last.rpartition(".")
    if f"{dot}{ending.lower()}" in KNOWN_ENDINGS:
        last = stem
    plain = "".join(sign if sign.isalnum() or sign in " -_.()" else "_" for sign in last)
    plain = plain.encode()[:LONGEST_NAME_BYTES].decode(errors="ignore").strip(" .")
    return f"_{plain}" if plain.lower().split(".")[0] in RESERVED else plain or instead


def write_picture(path: Path, picture: Picture) -> None:
    """Write a picture, in the place of an older one. Raises OSError."""
    packed = zlib.compress(_filtered(picture), COMPRESSION)
    parts = [SIGNATURE, _head(picture), _chunk(b"IDAT", packed), _chunk(b"IEND")]
    _replace(path, lambda file: file.writelines(parts))


class VideoFile:
    """A video that grows frame by frame, and is a file at its end. All methods raise OSError."""

    def __init__(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        if not os.access(path.parent, os.W_OK):
            raise PermissionError(path.parent)
        self.path = path
        self.frames = 0
        self._chunks = 0
        self._last: tuple[bytes, tuple[int, int]] | None = None
        self._file: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - closed by end

    def add(self, picture: Picture) -> None:
        """Keep a frame; it is shown until the next one."""
        if not self.frames:
            self._file.write(SIGNATURE + _head(picture) + _chunk(b"acTL", bytes(8)))
        self._last = zlib.compress(_filtered(picture), COMPRESSION), picture.shape[1::-1]

    def show(self, seconds: float) -> None:
        """Say how long the frame that was added last is shown."""
        if self._last is None:
            return
        (packed, (width, height)), self._last = self._last, None
        shown_ms = min(max(1, round(seconds * MILLISECONDS)), LONGEST_FRAME_MS)
        frame = (width, height, 0, 0, shown_ms, MILLISECONDS, 0, 0)
        self._file.write(_chunk(b"fcTL", struct.pack(">5I2H2B", self._number(), *frame)))
        if self.frames:
            self._file.write(_chunk(b"fdAT", struct.pack(">I", self._number()) + packed))
        else:
            self._file.write(_chunk(b"IDAT", packed))
        self.frames += 1

    def end(self) -> None:
        """Make the file of the frames that were shown, in the place of an older one."""
        with self._file as made:
            if self.frames:
                made.write(_chunk(b"IEND"))
                made.seek(COUNT_AT - 8)
                made.write(_chunk(b"acTL", struct.pack(">2I", self.frames, 0)))
                made.seek(0)
                _replace(self.path, lambda file: shutil.copyfileobj(made, file))

    def _number(self) -> int:
        self._chunks += 1
        return self._chunks - 1


def frames_in(path: Path) -> int:
    """Return how many frames the file of a video has. Raises OSError."""
    with path.open("rb") as file:
        file.seek(COUNT_AT)
        return int.from_bytes(file.read(4), "big")


def _replace(path: Path, write: Callable[[IO[bytes]], object]) -> None:
    """Write a file beside the place where it goes, so that a broken one never is there."""
    path.parent.mkdir(parents=True, exist_ok=True)
    made, name = tempfile.mkstemp(dir=path.parent, prefix=".", suffix=ENDING)
    try:
        with os.fdopen(made, "wb") as file:
            write(file)
        os.replace(name, path)
    except OSError:
        with contextlib.suppress(OSError):
            os.unlink(name)
        raise


def _filtered(picture: Picture) -> bytes:
    rows = picture.reshape(len(picture), -1)
    filtered = np.empty((len(rows), rows.shape[1] + 1), np.uint8)
    filtered[:, 0] = UP
    filtered[0, 1:] = rows[0]
    np.subtract(rows[1:], rows[:-1], out=filtered[1:, 1:])
    return filtered.tobytes()


def _head(picture: Picture) -> bytes:
    height, width = picture.shape[:2]
    return _chunk(b"IHDR", struct.pack(">2I5B", width, height, *EIGHT_BITS_RGB))


def _chunk(kind: bytes, content: bytes = b"") -> bytes:
    check = zlib.crc32(kind + content)
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check)
