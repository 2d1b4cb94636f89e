"""The file that keeps what a node writes; whatever is wrong with it never hurts the node.

The file of the time before is kept beside it, as ``name.1.log``: it may say why the node ended.
"""

from __future__ import annotations

import logging
import time
import zlib
from contextlib import suppress
from io import FileIO
from pathlib import Path

log = logging.getLogger(__name__)

LOG_BYTES = 5_000_000
"""A node's log file is cut there."""

SEPARATOR = "--- started again at"
"""What stands before the time in the line between two lives of a node."""

LONGEST_FILE_NAME = 80
"""In letters, without the ending: file systems allow 255 bytes."""


class NodeLog:
    """A log file; one that cannot be written is given up with a warning.

    It is made anew, unless ``goes_on``: then the node was started again after a crash, and what it
    writes now follows what it wrote before.
    """

    def __init__(self, path: Path, *, goes_on: bool = False) -> None:
        self._path = path
        self._left_bytes = LOG_BYTES
        self._file: FileIO | None = None
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            goes_on = goes_on and _size(path) < LOG_BYTES  # else many crashes fill the disk
            if not goes_on:
                _set_aside(path)
            # without a buffer, which would fail again in close()
            self._file = path.open("ab" if goes_on else "wb", buffering=0)
        except OSError as error:
            self._give_up(error)
        if goes_on:
            self.write(f"\n{SEPARATOR} {time.strftime('%H:%M:%S')}\n".encode())

    def write(self, piece: bytes) -> None:
        """Keep ``piece``, or as much of it as still fits."""
        if self._file is None:
            return
        try:
            self._left_bytes -= self._file.write(piece[: self._left_bytes])
        except OSError as error:
            self._give_up(error)

    def close(self) -> None:
        """Close the file."""
        file, self._file = self._file, None
        if file is not None:
            file.close()

    def __enter__(self) -> NodeLog:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def _give_up(self, error: OSError) -> None:
        log.warning("The log %s cannot be kept: %s.", self._path, error.strerror)
        self.close()


def _size(path: Path) -> int:
    return path.stat().st_size if path.exists() else 0


def _set_aside(path: Path) -> None:
    """Keep the file of the time before; where somebody reads it and the system forbids, it goes."""
    with suppress(OSError):
        if _size(path):
            path.replace(path.with_suffix(".1.log"))


def log_file_name(node: str) -> str:
    """The name of a node's log file: readable, allowed everywhere, and another for each node."""
    plain = "".join(letter if letter.isalnum() or letter in "-_" else "_" for letter in node)
    plain = plain[:LONGEST_FILE_NAME]
    if plain != node:
        plain += f"-{zlib.crc32(node.encode()):08x}"
    return f"{plain}.log"
