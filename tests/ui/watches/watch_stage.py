"""A dialog for watches whose runner notes what it is asked, and what a person does in it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import Imu, NodeState
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.plugins.watches import dialog as dialog_module
from nep_studio.ui.plugins.watches.dialog import Plan, WatchDialog
from nep_studio.ui.running.runner import Heard, Runner
from nep_studio.ui.theme.look import Look

ADDRESS, TOKEN = "192.168.1.23", "abcDEF123456"


class RecordingRunner(Runner):
    """Notes which nodes are to run, and runs none."""

    def __init__(self, owner: QObject, logs: Path) -> None:
        super().__init__(list, owner, logs=logs)
        self.asked: list[tuple[str, object]] = []

    def start_node(self, planned: PlannedNode, *, is_wanted: bool = False) -> None:
        self.asked.append(("start", planned))
        self.local.planned[planned.name] = planned

    def stop_node(self, name: str) -> None:
        self.asked.append(("stop", name))

    @property
    def launches(self) -> list[PlannedNode]:
        return [what for verb, what in self.asked if isinstance(what, PlannedNode)]

    def tell(self, event: str, description: str = "", pid: int = 7, **measures: float) -> None:
        """What the node would tell."""
        state = NodeState(
            node="watch",
            type="sensory",
            event=event,
            description=description,
            pid=pid,
            measures=measures,
        )
        self.board.update(state)
        self.nodes_changed.emit(["watch"])


@pytest.fixture
def runner(qapp: QApplication, tmp_path: Path) -> Iterator[RecordingRunner]:
    owner = QObject()
    made = RecordingRunner(owner, tmp_path)
    yield made
    made.close()


@pytest.fixture(autouse=True)
def settles_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dialog_module, "SETTLE_MS", 0)


Open = Callable[..., WatchDialog]


@pytest.fixture
def open_dialog(runner: RecordingRunner, qapp: QApplication, qtbot: QtBot) -> Iterator[Open]:
    made: list[WatchDialog] = []

    def make(plan: Plan | None = None, addresses: tuple[str, ...] = (ADDRESS,)) -> WatchDialog:
        look = Look(qapp, "light")
        one = WatchDialog(runner, plan or Plan("watch"), TOKEN, look, None, lambda: addresses)
        one.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
        qtbot.addWidget(one)
        one.begin()
        made.append(one)
        return one

    yield make
    for one in made:
        one.close()


def press(qtbot: QtBot, button) -> None:
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def choose(dialog: WatchDialog, way: str, qtbot: QtBot) -> None:
    """Click the card of a way, and the app in the list if it is one of several."""
    cards = dialog.choosing.cards
    press(qtbot, cards[way] if way in cards else cards["sensor_logger"])
    if way not in cards:
        app = dialog.page.app
        app.setCurrentIndex(app.findData(way))
        app.activated.emit(app.currentIndex())
    qtbot.waitUntil(lambda: not dialog._settling.isActive())


def send(dialog: WatchDialog, *, moves: bool) -> None:
    acc = [(0.0, 0.0, 9.8), (8.0 if moves else 0.1, 0.0, 9.8)]
    message = Imu(source="192.168.1.7", rate_hz=50.0, t=[1.0, 1.02], acc=acc)
    dialog.listener.hear([Heard(time.time(), message, "watch")])
    dialog._update()


def press_switch(switch, qtbot: QtBot) -> None:
    place = switch.rect().center()
    place.setX(switch.fontMetrics().height() // 2)
    qtbot.mouseClick(switch, Qt.MouseButton.LeftButton, pos=place)


def choose_other(dialog: WatchDialog, way: str, qtbot: QtBot) -> None:
    press(qtbot, dialog.back_button)
    choose(dialog, way, qtbot)
