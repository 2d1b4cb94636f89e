"""Looks for robots and tests the way to one, in threads of their own; news come as signals."""

from __future__ import annotations

import logging
import threading
from collections.abc import Sequence
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QHideEvent
from PySide6.QtWidgets import (
    QLabel,
    QListWidget,
    QListWidgetItem,
    QProgressBar,
    QPushButton,
    QWidget,
)

from nep_studio.ui.background import Job, Tell
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import count_words, tr

if TYPE_CHECKING:
    from robots.naoqi.discovery import FoundRobot

log = logging.getLogger(__name__)


class RobotSearch(Job):
    """Robots that announce themselves in the network."""

    found = Signal(str, str)
    """The name and the address of a robot."""

    def start(self, seconds: float, interfaces: Sequence[str] = ()) -> None:
        """Listen for some seconds; ``interfaces`` as in ``find_robots``."""

        def work(cancelled: threading.Event, tell: Tell) -> None:
            from robots.naoqi.discovery import find_robots

            find_robots(tell, cancelled, seconds=seconds, interfaces=interfaces)

        self._start(work, self._tell_found)

    def _tell_found(self, what: object) -> None:
        robot = cast("FoundRobot", what)
        self.found.emit(robot.name, robot.address)


class RobotTest(Job):
    """The steps on the way to a robot."""

    checked = Signal(object)
    """The Check of a step."""

    def start(self, address: str, user: str, password: str, robot: str) -> None:
        """Try every step; the login is used when there is a password."""

        def work(cancelled: threading.Event, tell: Tell) -> None:
            from robots.naoqi.probe import probe
            from robots.naoqi.wire.line import Login

            login = Login(user, password) if password else None
            for check in probe(address, login, robot):
                if cancelled.is_set():
                    return
                tell(check)

        self._start(work, self.checked.emit)


# The robots that were found in the network, with the search that finds them.

SEARCH_S = 4.0
ADDRESS = Qt.ItemDataRole.UserRole
ROWS = 3


class FoundList(QWidget):
    """``chosen`` gives the address of the robot that a person picks."""

    chosen = Signal(str)

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self.interfaces: tuple[str, ...] = ()
        self.search = RobotSearch(self)
        self.robots = QListWidget()
        self.told = QLabel(wordWrap=True)
        self.progress = QProgressBar(textVisible=False)
        self.button = QPushButton()
        line = self.fontMetrics().height()
        self.robots.setAccessibleName(tr("Robots in this network"))
        self.robots.setIconSize(QSize(round(line * 1.4), round(line * 1.4)))
        self.robots.setFixedHeight(round(line * 1.9) * ROWS)
        self.told.setProperty("role", "hint")
        self.progress.setRange(0, 0)
        self.progress.setAccessibleName(tr("Looking for robots…"))
        foot = in_row((self.told, 1), self.button)
        in_column(self.robots, self.progress, foot, of=self, margins=0, spacing=line // 3)
        self.search.found.connect(self._on_found)
        self.search.ended.connect(self._on_ended)
        self.robots.currentItemChanged.connect(self._on_chosen)
        self.robots.itemClicked.connect(self._on_chosen)
        self.button.clicked.connect(self._on_pressed)

    def start(self) -> None:
        """Look for robots, for a few seconds."""
        self.robots.clear()
        self.told.setText(tr("Looking for robots…"))
        self.button.setText(tr("Stop looking"))
        self.progress.setVisible(True)
        self.search.start(SEARCH_S, self.interfaces)

    def stop(self) -> None:
        """Look no longer."""
        self.search.stop()
        self._show_end("")

    def _on_pressed(self) -> None:
        if self.search.is_running:
            self.stop()
        else:
            self.start()

    def _on_found(self, name: str, address: str) -> None:
        item = QListWidgetItem(icon("bot", self._look.theme), f"{name}   {address}")
        item.setData(ADDRESS, address)
        item.setToolTip(address)
        self.robots.addItem(item)

    def _on_ended(self, problem: str) -> None:
        self.search.stop()
        self._show_end(problem)

    def _show_end(self, problem: str) -> None:
        self.progress.setVisible(False)
        self.button.setText(tr("Look again"))
        self.told.setText(self._outcome(problem))

    def _outcome(self, problem: str) -> str:
        count = self.robots.count()
        if count:
            return count_words(count, "1 robot was found.", "{n} robots were found.")
        if problem:
            return tr(
                "This computer cannot look for robots: it is in no network. Connect it to the"
                " network of the robot."
            )
        return tr(
            "No robot has announced itself. Press its chest button once: it says its address."
            " Write it below."
        )

    def _on_chosen(self, item: QListWidgetItem | None) -> None:
        if item is not None:
            self.chosen.emit(item.data(ADDRESS))

    def hideEvent(self, event: QHideEvent) -> None:
        """Nobody looks at what is found any more."""
        super().hideEvent(event)
        self.search.stop()
