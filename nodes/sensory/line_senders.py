"""Who sends lines: each sender's lines are read in its own way, and no number of them fills us."""

from __future__ import annotations

from nodes.sensory.line_reader import LineReader
from nodes.sensory.ways.way import Arrived

_MOST_SENDERS = 32  # remembered at once; the one that was silent longest is forgotten first


class LineSenders:
    """A reader of lines for each sender."""

    def __init__(self, columns: str = "") -> None:
        self._columns = columns
        self._readers: dict[str, LineReader] = {}

    def arrived(self, sender: str, lines: list[bytes], now_s: float) -> Arrived:
        """What these lines of a sender say."""
        reader = self._readers.pop(sender, None) or LineReader(self._columns)
        self._readers[sender] = reader
        if len(self._readers) > _MOST_SENDERS:
            del self._readers[next(iter(self._readers))]
        read = reader.read(lines, now_s)
        trouble = read.fault.told(sender) if read.fault else ""
        return Arrived(sender, read.readings, now_s, trouble, reader.told)
