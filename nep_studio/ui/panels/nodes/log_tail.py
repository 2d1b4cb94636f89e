"""The end of a node's log, read bit by bit; however much it writes, a piece stays small."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

PIECE_BYTES = 65_536
PIECE_LINES = 500
"""What can be shown at once without a stutter; of more, the last is shown."""
COMPARED_LINES = 200


@dataclass(frozen=True)
class Piece:
    """New lines; ``is_new_log`` when the node began anew, ``has_gap`` when lines are left out."""

    lines: tuple[str, ...] = ()
    is_new_log: bool = False
    has_gap: bool = False


class LogTail:
    """Reads a log file that may grow, begin anew, be full, or not be there.

    ``last_lines`` gives the last lines that the node wrote, for when the file has them not.
    """

    def __init__(self, path: Path, last_lines: Callable[[], list[str]]) -> None:
        self._path, self._last_lines = path, last_lines
        self._offset = 0
        self._rest = b""
        self._shown: deque[str] = deque(maxlen=COMPARED_LINES)
        self._still = 0

    def read(self) -> Piece:
        """What is new since the last time."""
        try:
            size = self._path.stat().st_size
            is_new_log = size < self._offset
            if is_new_log:
                self._offset, self._rest, self._still = 0, b"", 0
                self._shown.clear()
            piece = self._read_file(size, is_new_log)
        except OSError:
            piece = Piece()
        if not piece.lines and not piece.is_new_log:
            piece = self._beside_file()
        self._shown.extend(piece.lines)
        return piece

    def _read_file(self, size: int, is_new_log: bool) -> Piece:
        has_gap = size - self._offset > PIECE_BYTES
        if has_gap:
            self._offset, self._rest = size - PIECE_BYTES, b""
        if size == self._offset:
            return Piece(is_new_log=is_new_log)
        with self._path.open("rb") as file:
            file.seek(self._offset)
            data = self._rest + file.read(PIECE_BYTES)
            self._offset = file.tell()
        self._still = 0
        *whole, self._rest = data.split(b"\n")
        if has_gap:
            whole = whole[1:]  # half a line
        return self._piece([one.decode(errors="replace") for one in whole], is_new_log, has_gap)

    def _beside_file(self) -> Piece:
        """The node's last lines, when the file stands still though the node writes."""
        lines = self._last_lines()
        if not lines or (self._shown and lines[-1] == self._shown[-1].rstrip()):
            self._still = 0
            return Piece()
        self._still += 1
        if self._still < 2:  # the file may get the line in a moment
            return Piece()
        self._rest = b""
        known = _overlap([line.rstrip() for line in self._shown], lines)
        return self._piece(lines[known:], False, has_gap=known == 0 and bool(self._shown))

    def _piece(self, lines: list[str], is_new_log: bool, has_gap: bool) -> Piece:
        kept = lines[-PIECE_LINES:]
        has_gap = has_gap or len(kept) < len(lines)
        return Piece(tuple(line.rstrip("\r") for line in kept), is_new_log, has_gap)


def _overlap(before: list[str], after: list[str]) -> int:
    """How many of the first lines of ``after`` are the last of ``before``."""
    for count in range(min(len(before), len(after)), 0, -1):
        if before[-count:] == after[:count]:
            return count
    return 0
