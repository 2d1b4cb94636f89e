"""What was taken for what, as a table: rows are made, columns are recognised."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import (
    QAbstractTableModel,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    Qt,
)

from nep_studio.ui.trainer.results.findings import NOTHING, Findings
from nep_studio.ui.words import tr

Index = QModelIndex | QPersistentModelIndex
SHARE = int(Qt.ItemDataRole.UserRole)
"""The role that gives which part of its row a cell is, from 0 to 1."""
_TOP = QModelIndex()


class Confusion(QAbstractTableModel):
    """The pairs of some findings; *nothing* is a class as the gestures are, the last."""

    def __init__(self, title: Callable[[str], str], parent: QObject) -> None:
        super().__init__(parent)
        self._title = title
        self._findings = Findings({}, {})
        self.names: tuple[str, ...] = ()

    def show(self, findings: Findings | None) -> None:
        """Show the pairs of these findings; of None, none."""
        self.beginResetModel()
        self._findings = findings or Findings({}, {})
        self.names = (*self._findings.names, NOTHING) if self._findings.names else ()
        self.endResetModel()

    def title(self, name: str) -> str:
        """What a class is called."""
        return self._title(name) if name != NOTHING else tr("nothing")

    def pair(self, index: Index) -> tuple[str, str]:
        """What was made and what was recognised, of a cell."""
        return self.names[index.row()], self.names[index.column()]

    def is_right(self, index: Index) -> bool:
        """Whether a cell counts what was recognised as what it was."""
        return index.row() == index.column()

    def count(self, index: Index) -> int:
        """How often it was so."""
        return self._findings.confusion.get(self.pair(index), 0)

    def rowCount(self, parent: Index = _TOP) -> int:
        """What was made."""
        return 0 if parent.isValid() else len(self.names)

    def columnCount(self, parent: Index = _TOP) -> int:
        """What was recognised."""
        return 0 if parent.isValid() else len(self.names)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """The number of a cell, and what it says."""
        if not index.isValid():
            return None
        match role:
            case Qt.ItemDataRole.DisplayRole:
                return self._number(index)
            case Qt.ItemDataRole.ToolTipRole | Qt.ItemDataRole.AccessibleTextRole:
                return self.sentence(index)
            case Qt.ItemDataRole.TextAlignmentRole:
                return Qt.AlignmentFlag.AlignCenter
            case _ if role == SHARE:
                made = self._findings.made_of(self.pair(index)[0])
                return self.count(index) / made if made else 0.0
        return None

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        """What the classes are called."""
        if not 0 <= section < len(self.names):
            return None
        title = self.title(self.names[section])
        match role:
            case Qt.ItemDataRole.DisplayRole:
                return title
            case Qt.ItemDataRole.ToolTipRole if orientation == Qt.Orientation.Horizontal:
                return tr("Recognised: {gesture}", gesture=title)
            case Qt.ItemDataRole.ToolTipRole:
                return tr("Made: {gesture}", gesture=title)
        return None

    def sentence(self, index: Index) -> str:
        """What a cell says, in words."""
        made, found = self.pair(index)
        count, all_made = self.count(index), self._findings.made_of(made)
        values = {"made": self.title(made), "found": self.title(found), "all": all_made}
        if made == found == NOTHING:
            return tr("Nothing was made and nothing was recognised: that is not counted.")
        if made == NOTHING:
            one = tr("Nothing was made, but “{found}” was recognised once", **values)
            many = tr("Nothing was made, but “{found}” was recognised {n} times", n=count, **values)
        elif found == NOTHING:
            one = tr("“{made}” was missed once in {all}", **values)
            many = tr("“{made}” was missed {n} times in {all}", n=count, **values)
        elif made == found:
            one = tr("“{made}” was recognised once in {all}", **values)
            many = tr("“{made}” was recognised {n} times in {all}", n=count, **values)
        else:
            one = tr("“{made}” was taken for “{found}” once in {all}", **values)
            many = tr("“{made}” was taken for “{found}” {n} times in {all}", n=count, **values)
        return one if count == 1 else many

    def _number(self, index: Index) -> str:
        if self.pair(index) == (NOTHING, NOTHING):
            return "\N{EN DASH}"
        count = self.count(index)
        return str(count) if count else ""
