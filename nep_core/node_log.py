"""The file that keeps what a node writes; whatever is wrong with it never hurts the node."""

from __future__ import annotations

import logging
import zlib
from io import FileIO
from pathlib import Path

log = logging.getLogger(__name__)

LOG_BYTES = 5_000_000
"""A node's log file is cut there."""

LONGEST_FILE_NAME = 80
"""In letters, without the ending: file systems allow 255 bytes."""


class NodeLog:
    """A log file, made anew; one that cannot be written is given up with a warning."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._left_bytes = LOG_BYTES
        self._file: FileIO | None = None
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open("wb", buffering=0)  # a buffer would fail again in close()
        except OSError as error:
            self._give_up(error)

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


def log_file_name(node: str) -> str:
    """The name of a node's log file: readable, allowed everywhere, and another for each node."""
    plain = "".join(letter if letter.isalnum() or letter in "-_" else "_" for letter in node)
    plain = plain[:LONGEST_FILE_NAME]
    if plain != node:
        plain += f"-{zlib.crc32(node.encode()):08x}"
    return f"{plain}.log"
