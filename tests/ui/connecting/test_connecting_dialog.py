"""The dialog that connects a robot, with a robot that really answers over NAOqi."""

from __future__ import annotations

import socket
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot
from zeroconf import ServiceInfo, Zeroconf

from nep_studio.ui.plugins.connecting.dialog import ADDRESS, ConnectDialog
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.theme.colours import themes
from nep_studio.ui.theme.look import Look
from robots.naoqi.discovery import FOLDER_VARIABLE, SERVICE, SavedLogin, saved_login
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "robots" / "naoqi"))
from driver_stage import ServedNao

pytestmark = pytest.mark.long

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]

LOOPBACK = "127.0.0.1"


@pytest.fixture(autouse=True)
def own_logins(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))


@pytest.fixture
def robot() -> Iterator[ServedNao]:
    made = ServedNao(password="secret")
    yield made
    made.close()


@pytest.fixture
def dialog(qtbot: QtBot, qapp: QApplication) -> Iterator[ConnectDialog]:
    made = ConnectDialog(["NAO", "Anna"], Look(qapp, "light"))
    made.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    made.found.interfaces = (LOOPBACK,)
    qtbot.addWidget(made)
    made.show()
    yield made
    made.close()


def press(qtbot: QtBot, button) -> None:
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def test_a_robot_that_announces_itself_can_be_chosen(dialog: ConnectDialog, qtbot: QtBot) -> None:
    network = Zeroconf(interfaces=[LOOPBACK])
    addresses = [socket.inet_aton(LOOPBACK)]
    name = f"nao-green.{SERVICE}"
    info = ServiceInfo(SERVICE, name, port=9777, addresses=addresses, server="nao-green.local.")
    network.register_service(info)

    dialog.found.start()
    qtbot.waitUntil(lambda: dialog.found.robots.count() == 1)
    dialog.found.robots.setCurrentRow(0)
    network.close()

    assert dialog.found.robots.item(0).text().startswith("nao-green")
    assert dialog.found.robots.item(0).data(ADDRESS) == f"{LOOPBACK}:9777"
    assert dialog.address.text() == f"{LOOPBACK}:9777"


def test_the_search_can_be_stopped_and_says_what_to_do_when_nobody_is_there(
    dialog: ConnectDialog, qtbot: QtBot
) -> None:
    dialog.found.start()
    assert dialog.found.progress.isVisible()

    press(qtbot, dialog.found.button)

    assert not dialog.found.progress.isVisible()
    assert not dialog.found.search.is_running
    assert "chest button" in dialog.found.told.text()
    assert dialog.found.button.text() == "Look again"


def test_the_steps_tick_off_and_the_robot_says_how_it_is(
    dialog: ConnectDialog, robot: ServedNao, qtbot: QtBot
) -> None:
    dialog.show_address(robot.address, "nao", "secret")
    used: list[tuple[str, ...]] = []
    dialog.used.connect(lambda *chosen: used.append(chosen))

    press(qtbot, dialog.test_button)
    qtbot.waitUntil(dialog.use_button.isEnabled)

    assert set(dialog.steps.states.values()) == {"ok"}
    assert "Battery:" in dialog.about.text() and "NAOqi: 2." in dialog.about.text()
    dialog.robot.setCurrentText("Anna")
    press(qtbot, dialog.use_button)
    assert used == [("Anna", robot.address, "nao", "secret", "")]


def test_a_robot_that_asks_for_a_password_opens_the_fields_for_it(
    dialog: ConnectDialog, robot: ServedNao, qtbot: QtBot
) -> None:
    dialog.show_address(robot.address)

    press(qtbot, dialog.test_button)
    qtbot.waitUntil(lambda: dialog.steps.states["login"] == "failed")

    assert dialog.steps.states["naoqi"] == "ok"
    assert dialog.password.isVisible() and dialog.asks_password.isChecked()
    assert "user and password" in dialog.steps.advice.text()
    assert not dialog.use_button.isEnabled()
    qtbot.waitUntil(dialog.test_button.isEnabled)
    qtbot.keyClicks(dialog.password, "secret")
    press(qtbot, dialog.test_button)
    qtbot.waitUntil(dialog.use_button.isEnabled)


def test_an_address_where_nobody_answers_shows_what_to_try(
    dialog: ConnectDialog, free_port: int, qtbot: QtBot
) -> None:
    dialog.show_address(f"{LOOPBACK}:{free_port}")

    press(qtbot, dialog.test_button)
    qtbot.waitUntil(lambda: dialog.steps.states["port"] == "failed")

    assert dialog.steps.states["naoqi"] == "waiting"
    assert "chest button should glow" in dialog.steps.advice.text()
    assert dialog.steps.advice_card.isVisible()
    dialog.address.clear()
    qtbot.keyClicks(dialog.address, LOOPBACK)
    assert set(dialog.steps.states.values()) == {"waiting"}
    assert not dialog.steps.advice_card.isVisible()


def test_it_can_be_closed_while_it_looks_and_tests(dialog: ConnectDialog, qtbot: QtBot) -> None:
    with socket.create_server((LOOPBACK, 0)) as silent:
        dialog.show_address(f"{LOOPBACK}:{silent.getsockname()[1]}")
        dialog.found.start()
        press(qtbot, dialog.test_button)

        press(qtbot, dialog.close_button)

        assert not dialog.isVisible()
        assert not dialog.found.search.is_running and not dialog.test.is_running


def test_what_is_pressed_in_the_window_changes_the_block_and_can_be_undone(
    karate: MainWindow, robot: ServedNao, qtbot: QtBot
) -> None:
    editor = karate.workbench.canvas.editor
    before = {
        one.block_id: dict(editor.project.blocks[one.block_id].fields) for one in robots(karate)
    }
    karate.actions_by_name.by_name["connect_robot"].trigger()
    opened = karate.findChild(ConnectDialog)
    opened.found.stop()
    opened.show_address(robot.address, "nao", "secret")
    press(qtbot, opened.test_button)
    qtbot.waitUntil(opened.use_button.isEnabled)

    press(qtbot, opened.use_button)

    [entry] = robots(karate)
    assert (entry.name, entry.driver, entry.address) == ("NAO", "naoqi", robot.address)
    assert saved_login(robot.address) == SavedLogin("nao", "secret")
    assert "secret" not in repr(editor.project.blocks)
    editor.history.undo()
    assert {
        one.block_id: dict(editor.project.blocks[one.block_id].fields) for one in robots(karate)
    } == before


def robots(window: MainWindow):
    from nep_studio.blocks.deployment import robot_entries

    editor = window.workbench.canvas.editor
    return robot_entries(editor.project, editor.language)


@pytest.mark.parametrize("theme", themes())
@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_no_word_of_it_is_cut_off_in_any_look(
    qtbot: QtBot, qapp: QApplication, theme: str, scale: float
) -> None:
    look = Look(qapp, theme, scale)
    made = ConnectDialog(["NAO"], look)
    qtbot.addWidget(made)

    made.show()

    for button in (made.test_button, made.use_button, made.close_button, made.found.button):
        words = button.fontMetrics().horizontalAdvance(button.text())
        assert button.width() >= words, button.text()
    assert made.address.width() > made.fontMetrics().horizontalAdvance("192.168.100.100")
    made.close()
    Look(qapp, "light")
