"""The file that keeps what a node writes; whatever is wrong with it never hurts the node.

What was written before is kept beside it, the newest in ``name.1.log``: it may say why the node
ended. However much a node writes, its newest words are kept.
"""

from __future__ import annotations

import logging
import os
import re
import time
import zlib
from collections.abc import Sequence
from contextlib import suppress
from io import FileIO
from itertools import pairwise
from pathlib import Path

from faults.files import make_privately
from nep_core.closing import Closing
from nep_core.places import opened_privately

log = logging.getLogger(__name__)

LOG_BYTES = 2_000_000
"""A file that is so long is set aside, and another begins."""

KEPT_FILES = 5
"""With the newest; what is older is deleted, so that a node's log never takes more than 10 MB."""

SEPARATOR = "--- started again at"
"""What stands before the time in the line between two lives of a node."""

LONGEST_FILE_NAME = 80
"""In letters, without the ending: file systems allow 255 bytes."""


class NodeLog(Closing):
    """A log file; one that cannot be written is given up with a warning.

    It is made anew, unless ``goes_on``: then the node was started again after a crash, and what it
    writes now follows what it wrote before.
    """

    def __init__(self, path: Path, *, goes_on: bool = False) -> None:
        self._path = path
        self._left_bytes = 0
        self._file: FileIO | None = None
        try:
            make_privately(path.parent)
            self._begin(goes_on=goes_on)
        except OSError as error:
            self._give_up(error)
        if goes_on:
            self.write(f"\n{SEPARATOR} {time.strftime('%H:%M:%S')}\n".encode())

    def write(self, piece: bytes) -> None:
        """Keep ``piece``, in another file when this one is full."""
        if self._file is None:
            return
        try:
            if len(piece) > self._left_bytes:
                self._begin()
            self._left_bytes -= len(piece)
            self._file.write(piece)
        except OSError as error:
            self._give_up(error)

    def close(self) -> None:
        """Close the file."""
        file, self._file = self._file, None
        if file is not None:
            file.close()

    def _begin(self, *, goes_on: bool = False) -> None:
        self.close()  # a file that is open can have no other name on Windows
        size = self._path.stat().st_size if self._path.exists() else 0
        goes_on = goes_on and size < LOG_BYTES
        if size and not goes_on:
            # It is kept beside; where somebody reads one and the system forbids, one is lost
            for number in range(KEPT_FILES - 1, 0, -1):
                younger = self._path.with_suffix(f".{number - 1}.log") if number > 1 else self._path
                with suppress(OSError):
                    younger.replace(self._path.with_suffix(f".{number}.log"))
        # without a buffer, which would fail again in close()
        mode = "a" if goes_on else "w"
        self._file = FileIO(self._path, mode, opener=opened_privately)
        self._left_bytes = LOG_BYTES - (size if goes_on else 0)

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


# What Python writes into the log of a process in which one call holds up all threads for long.

BUSY_S = 5.0
GOES_ON = "nep: goes on after a long call"
_HANG, _THREAD = "Timeout (", re.compile(r"(Current thread|Thread) 0x")
_FRAME = re.compile(r'  File "(?P<file>.*)", line (?P<line>\d+) in ')


def busy_line(lines: Sequence[str], file: str) -> int:
    """The line of ``file`` at which a process has hung last and hangs still; 0 where it does not.

    ``lines`` are the last of its log.
    """
    begin = next((n for n in reversed(range(len(lines))) if lines[n].startswith(_HANG)), None)
    if begin is None or GOES_ON in lines[begin:]:
        return 0
    for above, line in pairwise(lines[begin:]):  # the innermost call of a thread comes first
        frame = _FRAME.match(line) if _THREAD.match(above) else None
        if frame is not None and os.path.basename(frame["file"]) == os.path.basename(file):
            return int(frame["line"])
    return 0
