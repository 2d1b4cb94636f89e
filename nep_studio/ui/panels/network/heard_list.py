"""The last messages of a topic as a list; however fast they come, only some are drawn."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from datetime import datetime
from typing import Any

from PySide6.QtCore import QAbstractListModel, QModelIndex, QObject, Qt

from nep_studio.ui.running.tap import Heard

from .graph_words import as_json, one_line, pretty

KEPT = 500
"""So many messages of a topic are kept to look at."""

Index = QModelIndex


class HeardList(QAbstractListModel):
    """What is shown is what was there at the last ``refresh``, the newest first."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._kept: deque[Heard] = deque(maxlen=KEPT)
        self._shown: list[Heard] = []
        self.filter = ""
        self.count = 0

    @property
    def shown(self) -> Sequence[Heard]:
        """What is in the list, the newest first."""
        return self._shown

    def clear(self) -> None:
        """Forget all."""
        self._kept.clear()
        self.count = 0
        self.refresh()

    def add(self, batch: Sequence[Heard]) -> None:
        """Keep the newest of these; they are not shown yet."""
        self.count += len(batch)
        self._kept.extend(batch[-KEPT:])

    def refresh(self) -> None:
        """Show what has come."""
        wanted = self.filter.casefold()
        shown = [
            one
            for one in reversed(self._kept)
            if not wanted or wanted in f"{one.sender} {as_json(one.message)}".casefold()
        ]
        self.beginResetModel()
        self._shown = shown
        self.endResetModel()

    def rowCount(self, parent: Index | Any = QModelIndex()) -> int:  # noqa: B008  Qt's default
        """How many are shown."""
        return 0 if parent.isValid() else len(self._shown)

    def data(self, index: Index | Any, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """The line of a message, or all of it."""
        if not index.isValid() or index.row() >= len(self._shown):
            return None
        heard = self._shown[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return f"{clock(heard.time_s)}  {heard.sender}  {one_line(heard.message)}"
        if role == Qt.ItemDataRole.ToolTipRole:
            return pretty(heard.message)[:4000]
        return heard if role == Qt.ItemDataRole.UserRole else None


def clock(time_s: float) -> str:
    """The time of day to the millisecond."""
    return datetime.fromtimestamp(time_s).strftime("%H:%M:%S.%f")[:-3]
