"""The lines of what happens: who, what and when; bounded, filtered, and searched."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass

from PySide6.QtCore import QAbstractListModel, QModelIndex, QObject, QPersistentModelIndex, Qt

from nep_core import messages as m
from nep_studio.ui.words import tr

MOST_LINES = 2000
"""The oldest of more lines go."""

RUN = "run"
LINE = Qt.ItemDataRole.UserRole
Index = QModelIndex | QPersistentModelIndex


@dataclass(slots=True)
class Line:
    """One thing that happened; ``count`` times, one after the other, ``elapsed_s`` into the run.

    ``part`` is the type of the node that tells it, or "run" for the beginning of a run.
    """

    elapsed_s: float
    part: str
    who: str
    what: str
    count: int = 1

    @property
    def words(self) -> str:
        """All of it, for the clipboard, files, and screen readers."""
        times = tr(" ({count} times)", count=self.count) if self.count > 1 else ""
        who = f"{self.who}: " if self.who else ""
        return f"{self.elapsed_s:.2f} s  {who}{self.what}{times}"


def part_of(message: object) -> str:
    """The type of the node that a message is told of."""
    match message:
        case m.NodeState():
            return message.type
        case m.HumanBehavior():
            return "perceptual"
        case m.ProgramState():
            return "cognitive"
    return "action"


class LinesModel(QAbstractListModel):
    """The last lines that are of the chosen part and have the words that are looked for."""

    def __init__(self, parent: QObject | None = None, most: int = MOST_LINES) -> None:
        super().__init__(parent)
        self._all: deque[Line] = deque(maxlen=most)
        self._shown: list[Line] = []
        self._part = self._words = ""
        self._most = most

    def add(self, lines: Iterable[Line]) -> None:
        """Add lines at the end; one that says the same as the one before it is counted."""
        new: list[Line] = []
        for line in lines:
            last = self._all[-1] if self._all else None
            if last is not None and _is_same(last, line):
                last.count += 1
                last.elapsed_s = line.elapsed_s
                continue
            self._all.append(line)
            if self._fits(line):
                new.append(line)
        self._tell_counted()
        self._append(new[-self._most :])

    def show_part(self, part: str) -> None:
        """Show the lines of a type of node only; "" shows all."""
        self._part = part
        self._refilter()

    def search(self, words: str) -> None:
        """Show the lines only that have these words, in any case."""
        self._words = words.strip().casefold()
        self._refilter()

    def clear(self) -> None:
        """Forget all lines."""
        self._all.clear()
        self._refilter()

    @property
    def total(self) -> int:
        """How many lines there are, shown or not."""
        return len(self._all)

    def lines(self) -> list[Line]:
        """The lines that are shown."""
        return list(self._shown)

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008 Qt's own signature
        """How many lines are shown."""
        return 0 if parent.isValid() else len(self._shown)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        """The words of a line, or the line."""
        if not index.isValid() or index.row() >= len(self._shown):
            return None
        line = self._shown[index.row()]
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.ToolTipRole):
            return line.words
        return line if role == LINE else None

    def _fits(self, line: Line) -> bool:
        if self._part and line.part not in (self._part, RUN):
            return False
        return not self._words or self._words in f"{line.who} {line.what}".casefold()

    def _tell_counted(self) -> None:
        if self._shown:
            last = self.index(len(self._shown) - 1)
            self.dataChanged.emit(last, last)

    def _append(self, new: list[Line]) -> None:
        surplus = len(self._shown) + len(new) - self._most
        if surplus > 0:
            self.beginRemoveRows(QModelIndex(), 0, surplus - 1)
            del self._shown[:surplus]
            self.endRemoveRows()
        if new:
            first = len(self._shown)
            self.beginInsertRows(QModelIndex(), first, first + len(new) - 1)
            self._shown += new
            self.endInsertRows()

    def _refilter(self) -> None:
        self.beginResetModel()
        self._shown = [line for line in self._all if self._fits(line)]
        self.endResetModel()


def _is_same(last: Line, line: Line) -> bool:
    return (last.part, last.who, last.what) == (line.part, line.who, line.what)
