"""The panel What runs in a real window with real nodes: cards, buttons, messages, logs."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QPushButton
from pytestqt.qtbot import QtBot

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.node import Node
from nep_studio.blocks.edits.content import SetField
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.plugins.connecting.dialog import ConnectDialog
from nep_studio.ui.plugins.nodes.card import NodeCard
from tests.ui.panels.conftest import KARATE, WAIT_MS, Bench

pytestmark = pytest.mark.long

Start = Callable[[PlannedNode], None]


def card_of(bench: Bench, name: str, qtbot: QtBot) -> NodeCard:
    qtbot.waitUntil(lambda: bench.nodes.card(name) is not None, timeout=WAIT_MS)
    return bench.nodes.card(name)


def press(bench: Bench, words: str, qtbot: QtBot) -> None:
    """Press a button of a message."""
    cards = bench.window.message_area.cards
    [button] = [b for card in cards for b in card.findChildren(QPushButton) if b.text() == words]
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def pid_of(bench: Bench, name: str) -> int:
    return bench.runner.local.launcher.nodes[name].pid


def test_the_nodes_that_the_project_needs_have_cards_before_it_runs(bench: Bench) -> None:
    names = {card.entry.name: card for card in bench.nodes.cards}

    assert {"NAO", "karate"} <= set(names)
    assert "Not started" in names["karate"].state.words
    assert names["karate"].reason.words == "Needed: it is on a page of your project"
    assert names["karate"].start_button.isEnabled()
    assert not names["karate"].stop_button.isEnabled()


def test_a_card_starts_its_node_and_says_what_it_costs(bench: Bench, qtbot: QtBot) -> None:
    card = card_of(bench, "karate", qtbot)

    qtbot.mouseClick(card.start_button, Qt.MouseButton.LeftButton)

    qtbot.waitUntil(lambda: card.entry.status.health == "ready", timeout=WAIT_MS)
    qtbot.waitUntil(lambda: "MB" in card.figures.words, timeout=WAIT_MS)
    assert card.stop_button.isEnabled()
    assert not card.start_button.isEnabled()
    qtbot.waitUntil(lambda: bench.told() == ["“karate” is ready"], timeout=WAIT_MS)


def test_a_card_stops_its_node_and_that_is_told_in_passing(
    bench: Bench, start: Start, qtbot: QtBot
) -> None:
    start(KARATE)
    card = card_of(bench, "karate", qtbot)
    qtbot.waitUntil(card.stop_button.isEnabled)

    qtbot.mouseClick(card.stop_button, Qt.MouseButton.LeftButton)

    qtbot.waitUntil(lambda: card.entry.status.health == "stopped", timeout=WAIT_MS)
    qtbot.waitUntil(lambda: bench.told() == ["“karate” was stopped"])


def test_a_restart_is_told_once_by_its_end(bench: Bench, start: Start, qtbot: QtBot) -> None:
    start(KARATE)
    card = card_of(bench, "karate", qtbot)
    before = pid_of(bench, "karate")
    qtbot.waitUntil(card.restart_button.isEnabled)

    qtbot.mouseClick(card.restart_button, Qt.MouseButton.LeftButton)

    qtbot.waitUntil(lambda: bench.told() == ["“karate” is ready"], timeout=WAIT_MS)
    assert pid_of(bench, "karate") != before


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there is no SIGKILL here")
def test_a_killed_node_is_told_and_the_message_goes_when_it_is_back(
    bench: Bench, start: Start, qtbot: QtBot
) -> None:
    start(KARATE)

    os.kill(pid_of(bench, "karate"), signal.SIGKILL)

    title = "“karate” ended unexpectedly and is started again"
    qtbot.waitUntil(lambda: title in bench.told(), timeout=WAIT_MS)
    qtbot.waitUntil(lambda: title not in bench.told(), timeout=WAIT_MS)
    card = card_of(bench, "karate", qtbot)
    qtbot.waitUntil(lambda: "restarted once" in card.figures.words, timeout=WAIT_MS)


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="there is no SIGSTOP here")
def test_a_frozen_node_is_restarted_by_the_button_of_its_message(
    bench: Bench, start: Start, qtbot: QtBot
) -> None:
    start(KARATE)
    frozen = pid_of(bench, "karate")

    os.kill(frozen, signal.SIGSTOP)
    qtbot.waitUntil(lambda: "“karate” does not answer" in bench.told(), timeout=WAIT_MS)
    press(bench, "Restart it", qtbot)

    board = bench.runner.board.nodes
    qtbot.waitUntil(lambda: pid_of(bench, "karate") != frozen, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: board["karate"].health == "ready", timeout=WAIT_MS)
    assert "“karate” does not answer" not in bench.told()


def test_a_robot_that_cannot_be_reached_is_replaced_by_the_one_on_the_screen(
    bench: Bench, free_port: int, qtbot: QtBot
) -> None:
    editor = bench.window.workbench.canvas.editor
    nao = next(one for one in bench.runner.planned() if one.name == "NAO")
    with editor.transaction("a real robot"):
        editor.apply(SetField(nao.block_id, "driver", "naoqi"))
        editor.apply(SetField(nao.block_id, "address", f"127.0.0.1:{free_port}"))
    real = next(one for one in bench.runner.planned() if one.name == "NAO")

    bench.runner.start_node(real)
    qtbot.waitUntil(lambda: "NAO does not answer" in bench.told(), timeout=WAIT_MS)
    press(bench, "Use the robot on the screen", qtbot)

    board = bench.runner.board.nodes
    qtbot.waitUntil(lambda: board["NAO"].health == "ready", timeout=WAIT_MS)
    assert editor.project.blocks[nao.block_id].fields["driver"] == "virtual"
    qtbot.waitUntil(lambda: "NAO does not answer" not in bench.told())


def test_a_wrong_address_is_changed_in_the_dialog_that_tests_it(
    bench: Bench, free_port: int, qtbot: QtBot
) -> None:
    nao = next(one for one in bench.runner.planned() if one.name == "NAO")
    place = {"robot": "NAO", "driver": "naoqi", "address": f"127.0.0.1:{free_port}"}
    page = bench.window.workbench.canvas.page

    bench.runner.start_node(replace(nao, parameters=place))
    qtbot.waitUntil(lambda: "NAO does not answer" in bench.told(), timeout=WAIT_MS)
    press(bench, "Find it and test the connection", qtbot)

    [dialog] = bench.window.findChildren(ConnectDialog)
    assert dialog.isVisible() and dialog.robot.currentText() == "NAO"
    assert bench.window.workbench.canvas.page == page
    dialog.reject()


def test_a_node_that_could_not_start_says_so_with_buttons(bench: Bench, qtbot: QtBot) -> None:
    broken = replace(KARATE, parameters={"gesture": "no such gesture"})

    bench.runner.start_node(broken)

    def cards() -> list:
        return [card for card in bench.window.message_area.cards if card.message.kind == "error"]

    qtbot.waitUntil(lambda: bool(cards()), timeout=WAIT_MS)
    [card] = cards()
    assert {"Start it again", "Show its log"} <= {button.text() for button in card.buttons}


def test_a_node_from_elsewhere_has_a_card_without_buttons(
    bench: Bench, start: Start, qtbot: QtBot
) -> None:
    start(KARATE)

    master = bench.runner.local.launcher.master
    with (
        PeerNetwork("guest", master=master) as network,
        Node("guest", "sensory", network=network) as node,
    ):
        node.ready()
        card = card_of(bench, "guest", qtbot)
        qtbot.waitUntil(lambda: card.entry.status.health == "ready")

        assert not any(button.isVisible() for button in card.buttons)
        assert "Started elsewhere" in card.reason.words


def test_the_log_opens_from_the_card_by_keyboard(bench: Bench, start: Start, qtbot: QtBot) -> None:
    start(KARATE)
    card = card_of(bench, "karate", qtbot)
    qtbot.waitUntil(card.log_button.isEnabled)

    card.setFocus()
    qtbot.keyClick(card, Qt.Key.Key_Return)

    assert bench.nodes.log.isVisible()
    assert bench.nodes.log.title.words == "Log of karate"
    assert bench.nodes.log.is_reading
    qtbot.keyClick(bench.nodes.log.text, Qt.Key.Key_Escape)
    qtbot.waitUntil(lambda: not bench.nodes.log.isVisible())


def test_the_arrow_keys_go_from_card_to_card(bench: Bench, qtbot: QtBot) -> None:
    first, second = bench.nodes.cards[:2]
    first.setFocus()

    qtbot.keyClick(first, Qt.Key.Key_Right)

    qtbot.waitUntil(second.hasFocus)


def test_a_hidden_panel_does_no_work(bench: Bench, qtbot: QtBot) -> None:
    assert bench.nodes._feed.is_watching

    bench.nodes.hide()

    qtbot.waitUntil(lambda: not bench.nodes._feed.is_watching)


def test_a_run_is_told_once_for_all_nodes(bench: Bench, qtbot: QtBot) -> None:
    bench.runner.run()

    def ready() -> list[str]:
        return [title for title in bench.told() if "ready" in title or "runs" in title]

    qtbot.waitUntil(lambda: bool(ready()), timeout=WAIT_MS)

    assert ready() == ["The program runs"]
    card = card_of(bench, "program", qtbot)
    assert card.stop_button.isEnabled()
    qtbot.mouseClick(card.stop_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bench.runner.state == "idle", timeout=WAIT_MS)
    assert not [card for card in bench.window.message_area.cards if card.message.kind == "error"]


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there is no SIGKILL here")
def test_an_unexpected_end_is_told_within_300_ms(bench: Bench, start: Start, qtbot: QtBot) -> None:
    start(KARATE)
    os.kill(pid_of(bench, "karate"), signal.SIGKILL)

    title = "“karate” ended unexpectedly and is started again"
    with qtbot.waitSignal(bench.runner.nodes_changed, timeout=WAIT_MS):
        pass
    qtbot.waitUntil(lambda: title in bench.told(), timeout=300)
