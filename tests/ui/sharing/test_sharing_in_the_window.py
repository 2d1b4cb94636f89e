"""Opening the network in the window: real masters, real keys, real programs that run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from pytestqt.qtbot import QtBot

from nep_core.networks.security.curve import Refusals
from nep_studio.ui.plugins.network import NetworkPanel
from nep_studio.ui.plugins.sharing import SharingKit
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.shell.settings_dialog import SettingsDialog
from tests.blocks.block_building import B
from tests.ui.running.conftest import open_program
from tests.ui.running.window_use import LONG_WAIT, press, state_is
from tests.ui.sharing.sharing_stage import (
    HOST,
    WAIT_MS,
    here_only,
    is_on,
    kit,
    opened_dialog,
    pair_by,
)
from tests.ui.window.conftest import chooser, home, studio, window

pytestmark = pytest.mark.long

__all__ = ["chooser", "here_only", "home", "kit", "open_program", "studio", "window"]


def told(window: MainWindow) -> list[str]:
    return [one.message.title for one in window.messages.history]


def test_a_network_is_opened_a_computer_let_in_and_removed_and_all_closed(
    window: MainWindow, kit: SharingKit, here_only, tmp_path: Path, qtbot: QtBot
) -> None:
    [room] = window.findChildren(NetworkPanel)
    panel = room.opened()
    dialog = opened_dialog(window, kit)
    page = dialog.open_page
    qtbot.keyClick(dialog.main_button, Qt.Key.Key_Space)
    is_on(dialog, qtbot, "open")
    code = page.code.line.text.text()
    command = page.command.text.text()

    page.code.line.button.click()
    copied = QGuiApplication.clipboard().text()
    pair_by(code, kit.sharing.opening.door_port, tmp_path / "guest.keys")
    qtbot.waitUntil(lambda: len(page.computers.buttons) == 1, timeout=WAIT_MS)
    is_marked, mark = not panel.sharing_button.isHidden(), panel.sharing_button.toolTip()
    [(name, remove)] = page.computers.buttons.items()
    left = page.code.left.text()
    remove.click()

    assert copied == code
    assert command == f"nep pair {kit.sharing.address} {code}"
    assert is_marked
    assert mark == "1 computer may come in."
    assert left == "No code holds now. Make a new one for the next computer."
    assert page.computers.buttons == {}
    assert name in page.removed.text()
    assert dialog.focusWidget() is page.anew_button

    page.anew_button.click()
    is_on(dialog, qtbot, "busy")
    is_on(dialog, qtbot, "open")
    dialog.main_button.click()
    is_on(dialog, qtbot, "closed")

    assert panel.sharing_button.isHidden()
    assert told(window)[-1] == "Only this computer takes part now"


def test_a_program_that_runs_is_stopped_first_and_may_be_run_again(
    window: MainWindow, kit: SharingKit, here_only, open_program: Callable, qtbot: QtBot
) -> None:
    open_program([B("event.started"), LONG_WAIT])
    press(window, qtbot, "run")
    state_is(window, qtbot, "running")
    dialog = opened_dialog(window, kit)
    warned = dialog.closed_page.restart_told.text()

    dialog.main_button.click()
    is_on(dialog, qtbot, "open")

    assert warned.startswith("The program is stopped for it")
    assert window.running.runner.state == "idle"
    told = [answer for one in window.messages.history for answer in one.message.answers]
    [answer] = [answer for answer in told if answer.words == "Run again"]
    answer.do()
    state_is(window, qtbot, "running")
    window.running.stop()
    state_is(window, qtbot, "idle")


def test_it_is_opened_again_at_the_next_start_only_when_that_was_chosen(
    window: MainWindow, kit: SharingKit, here_only, qtbot: QtBot
) -> None:
    dialog = opened_dialog(window, kit)
    dialog.main_button.click()
    is_on(dialog, qtbot, "open")
    before = window.settings.kept_open_at

    dialog.open_page.keep.click()
    during = window.settings.kept_open_at
    dialog.main_button.click()
    is_on(dialog, qtbot, "closed")

    assert (before, during) == ("", HOST)
    qtbot.waitUntil(lambda: window.settings.kept_open_at == "")


def test_a_window_that_is_closed_at_once_opens_no_network(studio: Studio, qtbot: QtBot) -> None:
    studio.settings.kept_open_at = "127.0.0.1"
    made = MainWindow(studio)
    qtbot.addWidget(made)
    made.show()
    made.start(None)

    made.close()
    qtbot.wait(50)

    assert made.running.runner.network is None
    assert told(made) == []


def test_who_is_refused_is_told_once_with_what_to_do(window: MainWindow, kit: SharingKit) -> None:
    refusals = Refusals("own.keys")
    refusals.refuse("192.0.2.7")
    warning = refusals.take()

    kit.sharing._on_heard(warning)
    kit.sharing._on_heard(warning)

    [message] = [one.message for one in window.messages.history]
    assert message.title == "A computer was not let in"
    assert "192.0.2.7" in message.sentence
    assert len(message.checklist) == 2
    message.answers[0].do()
    assert kit.dialog is not None


def test_a_wrong_address_is_told_in_the_dialog_and_what_was_typed_stays(
    window: MainWindow, kit: SharingKit, here_only, qtbot: QtBot
) -> None:
    dialog = opened_dialog(window, kit)
    qtbot.keyClick(dialog.other_button, Qt.Key.Key_Space)
    page = dialog.join_page
    focused = dialog.focusWidget()
    qtbot.keyClicks(page.address, "192.168.1.5:door")
    may_join_early = dialog.main_button.isEnabled()
    qtbot.keyClicks(page.code, "123 456")

    dialog.main_button.click()
    qtbot.waitUntil(lambda: not dialog.problem.isHidden(), timeout=WAIT_MS)

    assert focused is page.address
    assert not may_join_early
    assert dialog.page == "join"
    assert page.address.text() == "192.168.1.5:door"
    assert kit.sharing.state == "closed"


@pytest.mark.parametrize("is_kept", [True, False])
def test_programs_of_the_original_nep_join_when_that_is_chosen(
    window: MainWindow, kit: SharingKit, is_kept: bool
) -> None:
    window.open_settings()
    [dialog] = window.findChildren(SettingsDialog)
    options = window.running.runner.local.master_options
    before = list(options())

    dialog.network_page.original.click()
    during = list(options())
    (dialog.close_button if is_kept else dialog.cancel_button).click()

    assert (before, during) == ([], ["--original"])
    assert list(options()) == (["--original"] if is_kept else [])


def test_a_page_opened_later_knows_that_the_network_is_open(window: MainWindow) -> None:
    [room] = window.findChildren(NetworkPanel)
    room.show_sharing("Open to 1 computer", "", "share-2")
    assert room.page is None

    page = room.opened()

    assert not page.sharing_button.isHidden()
    assert page.sharing_button.text() == "Open to 1 computer"
