"""The dialog that connects a watch or phone: its questions, its steps, what it shows."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from nep_studio.ui.plugins.watches.choosing import offers
from nep_studio.ui.plugins.watches.connectors import CONNECTORS
from nodes.sensory.connectors import CONNECTORS as WAYS_OF_THE_NODE
from nodes.sensory.phone_page.server import page_urls
from tests.ui.watches.watch_stage import (
    ADDRESS,
    TOKEN,
    Open,
    RecordingRunner,
    choose,
    open_dialog,
    press,
    press_switch,
    runner,
    send,
    settles_at_once,
)
from tests.ui.window_eye import WindowEye

__all__ = ["open_dialog", "runner", "settles_at_once"]


def test_it_asks_what_one_has_the_easiest_first(open_dialog: Open) -> None:
    dialog = open_dialog()

    ways = [one.connector.name for one in offers()]

    assert ways == list(dialog.choosing.cards)
    assert ways[:2] == ["phone_page", "sensor_logger"]
    assert not dialog.isModal()
    assert dialog.focusWidget() is dialog.choosing.cards["phone_page"]
    assert not dialog.use_button.isVisible()


def test_every_way_of_the_node_can_be_reached_and_has_its_usual_port() -> None:
    for name, kind in WAYS_OF_THE_NODE.items():
        assert name in CONNECTORS
        assert not CONNECTORS[name].listens or CONNECTORS[name].port == kind.port
        assert CONNECTORS[name].needs_address == (kind.needs_address and name != "bluetooth")


@pytest.mark.parametrize("way", CONNECTORS)
def test_the_steps_of_every_way_fit_in_plain_words(
    way: str, open_dialog: Open, qtbot: QtBot
) -> None:
    dialog = open_dialog()

    choose(dialog, way, qtbot)

    steps = dialog.page.steps
    assert 1 <= len(steps.words) <= 4
    assert all(label.text() for label in steps.words)
    if CONNECTORS[way].listens:
        copied = "".join(line.text.text() for line in steps.copy_lines if line is not None)
        assert ADDRESS in copied


def test_the_code_of_the_phone_page_is_shown_once_the_network_is_let_in(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "phone_page", qtbot)
    page = dialog.page
    assert not page.qr_code.isVisible()
    assert runner.launches[-1].parameters["listen_on"] == "this computer"
    runner.tell("ready", "waits for a phone")

    press_switch(page.network.switch, qtbot)

    qtbot.waitUntil(lambda: len(runner.launches) == 2)
    assert page.qr_code.isVisible()
    [url] = page_urls(8443, TOKEN, [ADDRESS])
    assert page.qr_code.accessibleName() == url
    assert dict(runner.launches[-1].parameters) == {
        "through": "phone_page",
        "port": 8443,
        "listen_on": "network",
        "token": TOKEN,
    }
    runner.tell("ready", "waits for a phone", pid=8)
    send(dialog, moves=False)
    assert not page.qr_code.isVisible()  # it is not needed while the phone sends


def test_the_address_is_copied_with_one_press(open_dialog: Open, qtbot: QtBot) -> None:
    dialog = open_dialog()
    choose(dialog, "sensor_logger", qtbot)
    [line] = [one for one in dialog.page.steps.copy_lines if one is not None]

    press(qtbot, line.button)

    assert QGuiApplication.clipboard().text() == f"http://{ADDRESS}:8000/data"
    assert line.button.text() == "Copied"


def test_another_port_and_columns_of_ones_own_reach_the_node(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)
    runner.tell("ready")
    page = dialog.page
    page.more.toggle.click()

    page.more.port.setValue(9001)
    qtbot.keyClicks(page.more.columns, "t,ax,ay,az")
    qtbot.keyClick(page.more.columns, Qt.Key.Key_Return)

    qtbot.waitUntil(lambda: runner.launches[-1].parameters.get("columns") == "t,ax,ay,az")
    assert runner.launches[-1].parameters["port"] == 9001
    assert page.steps.copy_lines[3].text.text() == "9001"


def test_where_it_is_worn_is_asked_and_told_to_the_node(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "paper_watch", qtbot)
    assert runner.launches[-1].parameters["wrist"] == "left"
    runner.tell("ready")

    dialog.page.worn.buttons["right"].click()

    qtbot.waitUntil(lambda: runner.launches[-1].parameters["wrist"] == "right")


def test_nothing_is_started_until_the_address_of_the_app_is_written(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "phyphox", qtbot)
    assert runner.launches == []
    assert dialog.page.live.title.text() == "Something is still missing"

    qtbot.keyClicks(dialog.page.address, "192.168.1.44:8080")
    qtbot.keyClick(dialog.page.address, Qt.Key.Key_Return)

    qtbot.waitUntil(lambda: runner.launches != [])
    assert runner.launches[-1].parameters["address"] == "192.168.1.44:8080"


def test_a_movement_turns_the_dot_green_and_the_numbers_are_told(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)
    live = dialog.page.live
    assert live.dot.state == "waiting"
    assert not dialog.use_button.isEnabled()

    runner.tell("ready", "waits for a watch on UDP port 8085")
    assert dialog.use_button.isEnabled()
    send(dialog, moves=False)
    assert (live.dot.state, live.title.text()) == ("still", "It sends. Now move it")
    told = "192.168.1.7 sends 50 samples a second; reads t, ax, ay, az"
    runner.tell("connected", told, rate_hz=49.8, loss=0.2, drift_ppm=12.0, gaps=1, delay_ms=38)
    send(dialog, moves=True)

    assert (live.dot.state, live.title.text()) == ("moved", "It moves: all is well")
    assert live.understood.text() == told
    numbers = [row[2].text() for row in live.rows]
    assert numbers == ["50 a second", "20 %", "1", "38 ms", "+0.04 s an hour"]
    assert live.curve.isVisible()
    press(qtbot, live.correct_button)
    assert dialog.focusWidget() is dialog.page.more.columns


def test_after_ten_silent_seconds_it_says_what_to_look_at(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)
    runner.tell("ready")
    dialog._update()
    assert not dialog.page.live.advice_card.isVisible()

    dialog._waiting_since_s -= 11
    dialog._update()

    advice = dialog.page.live.advice.text()
    assert dialog.page.live.advice_card.isVisible()
    assert "“Let this network in” is off" in advice
    assert f"{ADDRESS}:8085" in advice
    assert "firewall" in advice and "UDP port 8085" in advice
    assert "same Wi-Fi" in advice


def test_a_computer_in_no_network_says_so_and_looks_again(open_dialog: Open, qtbot: QtBot) -> None:
    dialog = open_dialog(addresses=())
    choose(dialog, "phone_page", qtbot)
    network = dialog.page.network
    assert network.missing.isVisible()
    dialog._find_addresses = lambda: [ADDRESS]

    press(qtbot, network.again)

    assert not network.missing.isVisible()
    assert network.address == ADDRESS


@pytest.mark.parametrize("way", CONNECTORS)
def test_no_part_of_a_page_is_a_window_for_a_moment(
    way: str, open_dialog: Open, qapp: QApplication
) -> None:
    dialog = open_dialog()

    with WindowEye(qapp) as eye:
        dialog.show_connector(way)

    assert dialog.page.isVisible()
    assert not eye.seen
