"""Connecting a watch in the window: a node that really runs, and a process that really sends."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import NodeState
from nep_studio.blocks.deployment import node_entries
from nep_studio.ui.plugins.watches.dialog import WatchDialog
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.watches.watch_stage import (
    choose,
    press,
    settles_at_once,
)
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

pytestmark = pytest.mark.long

__all__ = ["answer", "chooser", "home", "karate", "settles_at_once", "studio", "window"]


SENDER = """
import socket, sys, time
door = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
for n in range(100_000):
    swing = 8.0 if n // 10 % 2 else 0.0
    line = f"{n * 20},{swing},0.1,9.8\\n"
    door.sendto(line.encode(), ("127.0.0.1", int(sys.argv[1])))
    time.sleep(0.02)
"""


def watches(window: MainWindow):
    editor = window.workbench.canvas.editor
    return [
        one
        for one in node_entries(editor.project, editor.language)
        if one.node == "sensory/smartwatch"
    ]


@pytest.fixture
def sender(free_port: int) -> Iterator[int]:
    """A process that sends lines to a port, as an app on a phone does."""
    process = subprocess.Popen([sys.executable, "-c", SENDER, str(free_port)])
    yield free_port
    process.kill()
    process.wait()


def test_a_watch_is_connected_moved_and_used_and_run_takes_it_over(
    karate: MainWindow, sender: int, qtbot: QtBot
) -> None:
    kit = karate.actions_by_name["connect_watch"]
    kit.trigger()
    dialog = karate.findChild(WatchDialog)
    choose(dialog, "udp", qtbot)
    dialog.page.more.port.setValue(sender)
    runner = karate.running.runner

    qtbot.waitUntil(lambda: dialog.page.live.dot.state == "moved")
    qtbot.waitUntil(lambda: dialog.listener.flow.rate_hz > 20)
    qtbot.waitUntil(dialog.use_button.isEnabled)
    launched = runner.local.launcher.nodes["watch"]
    pid = launched.pid
    assert "t (ms), ax, ay, az (m/s²)" in dialog.page.live.understood.text()
    press(qtbot, dialog.use_button)

    [entry] = watches(karate)
    assert entry.name == "watch"
    assert entry.parameters["port"] == sender
    planned = runner.planned()
    assert not any(node.node == "sensory/virtual_watch" for node in planned)
    [watch] = [node for node in planned if node.name == "watch"]
    assert runner.local.planned["watch"] == watch  # so that Run takes it over
    runner.local.start([watch])
    assert runner.local.launcher.nodes["watch"].pid == pid
    karate.workbench.canvas.editor.history.undo()
    assert watches(karate) == []


def test_a_simulated_person_is_used_with_one_press(karate: MainWindow, qtbot: QtBot) -> None:
    karate.actions_by_name["connect_watch"].trigger()
    dialog = karate.findChild(WatchDialog)
    choose(dialog, "virtual_watch", qtbot)
    qtbot.waitUntil(lambda: dialog.page.live.dot.state == "moved")
    runner, name = karate.running.runner, dialog.plan.name
    pid = runner.local.launcher.nodes[name].pid

    press(qtbot, dialog.use_button)

    [watch] = [node for node in runner.planned() if node.is_sensory]
    assert (watch.node, watch.name) == ("sensory/virtual_watch", name)
    runner.local.start([watch])
    assert runner.local.launcher.nodes[name].pid == pid


def test_a_port_that_is_taken_is_told_in_a_sentence(
    karate: MainWindow, free_port: int, qtbot: QtBot
) -> None:
    import socket

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", free_port))
        karate.actions_by_name["connect_watch"].trigger()
        dialog = karate.findChild(WatchDialog)
        choose(dialog, "udp", qtbot)
        dialog.page.more.port.setValue(free_port)

        qtbot.waitUntil(lambda: dialog.page.live.dot.state == "failed")

        opened = f"UDP port {free_port} cannot be opened"
        qtbot.waitUntil(lambda: dialog.page.live.sentence.text().startswith(opened))
        assert "Choose another port" in dialog.page.live.advice.text()
        press(qtbot, dialog.close_button)
        assert watches(karate) == []
        assert [told.message.title for told in karate.messages.history] == []


def test_a_watch_that_is_in_use_is_asked_about(
    karate: MainWindow, qtbot: QtBot, answer: Callable
) -> None:
    from nep_studio.blocks.operations.fixes import use_watch

    editor = karate.workbench.canvas.editor
    use_watch(editor, {"through": "udp", "port": 8085}, "use")
    state = NodeState(node="watch", type="sensory", event="connected", pid=5)
    karate.running.runner.board.update(state)

    karate.actions_by_name["connect_watch"].trigger()
    answer(karate, "Connect another one")

    qtbot.waitUntil(lambda: karate.findChild(WatchDialog) is not None)
    assert karate.findChild(WatchDialog).plan.name == "watch 2"


def test_there_is_one_dialog_and_another_project_closes_it(
    karate: MainWindow, qtbot: QtBot
) -> None:
    action = karate.actions_by_name["connect_watch"]
    action.trigger()
    action.trigger()
    [dialog] = karate.findChildren(WatchDialog)
    assert action in karate.menus["robots"].actions()

    with qtbot.waitSignal(dialog.finished):
        karate.files.new()


def test_another_language_closes_the_dialog_and_stops_what_it_started(
    karate: MainWindow, qtbot: QtBot
) -> None:
    karate.actions_by_name["connect_watch"].trigger()
    dialog = karate.findChild(WatchDialog)
    choose(dialog, "udp", qtbot)

    with qtbot.waitSignal(dialog.finished):
        karate.studio.choose_language("es")

    karate.actions_by_name["connect_watch"].trigger()
    qtbot.waitUntil(lambda: len(karate.findChildren(WatchDialog)) == 1)
    karate.findChild(WatchDialog).reject()
    karate.studio.choose_language("en")


def test_a_simulated_person_makes_the_gestures_of_the_project(
    window: MainWindow, qtbot: QtBot
) -> None:
    card = next(c for path, c in window.start_page.cards.items() if path.stem == "own_gestures")
    qtbot.mouseClick(card, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())
    window.workbench.canvas.show_page("behaviour")
    window.host.ask("watches.open")
    dialog = window.findChild(WatchDialog)
    choose(dialog, "virtual_watch", qtbot)
    assert "circle" in dialog.page.gestures.chosen
    shown = [box.text() for box in dialog.page.gestures.boxes.values()]
    assert "hand up" in shown and not any("_" in title for title in shown)
    qtbot.waitUntil(lambda: dialog.page.live.dot.state == "moved", timeout=20_000)

    press(qtbot, dialog.use_button)

    assert window.workbench.canvas.page == "behaviour"
    [watch] = [node for node in window.running.runner.planned() if node.is_sensory]
    assert watch.node == "sensory/virtual_watch"
    window.running.runner.stop_node(watch.name)
