"""A window with the panel What runs and the page Network, which really runs nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import pytest
from pytestqt.qtbot import QtBot

from nep_studio.run.plan import PlannedNode
from nep_studio.ui.plugins.network import NetworkPanel
from nep_studio.ui.plugins.network.panel import NetworkWorkspace
from nep_studio.ui.plugins.nodes import NodesPanel
from nep_studio.ui.plugins.nodes.panel import NodesPage
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]

KARATE = PlannedNode("perceptual/gesture", "karate", {"gesture": "karate"}, "a rule waits for it")
WATCH = PlannedNode("sensory/virtual_watch", "virtual_watch", {})
WAIT_MS = 30_000


@dataclass
class Bench:
    """The karate example in a window with both panels shown."""

    window: MainWindow
    nodes: NodesPage
    room: NetworkPanel

    @property
    def network(self) -> NetworkWorkspace:
        return self.room.opened()

    @property
    def runner(self):
        return self.window.running.runner

    def told(self) -> list[str]:
        return [card.message.title for card in self.window.message_area.cards]


@pytest.fixture
def bench(karate: MainWindow, qtbot: QtBot) -> Iterator[Bench]:
    panel = karate.findChild(NodesPanel)
    karate.workbench.panels.show(panel)
    made = Bench(karate, panel.opened(), karate.findChild(NetworkPanel))
    qtbot.waitUntil(made.nodes.isVisible)
    yield made
    karate.running.close()


@pytest.fixture
def start(bench: Bench, qtbot: QtBot) -> Callable[[PlannedNode], None]:
    """Starts a node by hand, and waits until it is ready."""

    def run(planned: PlannedNode) -> None:
        bench.runner.start_node(planned)
        nodes = bench.runner.board.nodes
        qtbot.waitUntil(
            lambda: planned.name in nodes and nodes[planned.name].health == "ready", timeout=WAIT_MS
        )

    return run
