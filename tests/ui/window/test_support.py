"""Help for those who need it: the report, safe mode, and updates that a person asked for."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import pytest
from PySide6.QtCore import QCoreApplication, QObject, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QFileDialog, QPushButton
from pytestqt.qtbot import QtBot

from nep_core.places import PORTABLE_VARIABLE
from nep_core.processes import process
from nep_studio.support import portable, safe_mode
from nep_studio.support.updates import Newest, UpdateChoice
from nep_studio.ui.shell import settings_dialog
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.shell.settings_dialog import SettingsDialog
from nep_studio.ui.shell.support import AfterACrash, SupportDialog, tell_how_it_runs

pytestmark = pytest.mark.long


@pytest.fixture
def site() -> Iterator[tuple[str, list[str]]]:
    """A server on loopback that tells version 99, and what it was asked."""
    asked: list[str] = []

    class Pages(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            asked.append(self.path)
            self.send_response(200)
            self.end_headers()
            self.wfile.write(b'{"version": "99.0", "page": "https://example.org/"}')

        def log_message(self, *_: object) -> None:
            """Say nothing in tests."""

    with HTTPServer(("127.0.0.1", 0), Pages) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}/newest", asked
        server.shutdown()
        thread.join()


def titles(window: MainWindow) -> list[str]:
    return [told.message.title for told in window.messages.history]


def test_the_report_is_read_before_it_is_copied_and_saved(
    window: MainWindow, tmp_path: Path, qtbot: QtBot
) -> None:
    window.actions_by_name["report"].trigger()
    [dialog] = window.findChildren(SupportDialog)
    could_save = dialog.save_button.isEnabled()
    qtbot.waitUntil(lambda: dialog.report is not None)

    qtbot.mouseClick(dialog.copy_button, Qt.MouseButton.LeftButton)
    copied = QGuiApplication.clipboard().text()
    qtbot.mouseClick(dialog.save_button, Qt.MouseButton.LeftButton)
    [asked] = dialog.findChildren(QFileDialog)
    asked.fileSelected.emit(str(tmp_path / "report.zip"))
    asked.close()

    assert not could_save
    assert dialog.report is not None
    assert copied == dialog.report.text() == dialog.preview.toPlainText()
    assert "theme=light" in copied
    assert (tmp_path / "report.zip").is_file()
    assert "report.zip" in dialog.state.text()
    dialog.save(tmp_path / "missing" / "report.zip")
    assert "no such file or directory. Choose another folder." in dialog.state.text()


def test_a_report_that_is_closed_early_ends_its_process(window: MainWindow) -> None:
    window.actions_by_name["report"].trigger()
    [dialog] = window.findChildren(SupportDialog)

    dialog.close()

    assert dialog.report is None  # that nothing runs any more, each test looks itself


@pytest.mark.parametrize("words", [["--version"], ["no such job"]])
def test_a_report_that_cannot_be_made_is_told(
    window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch, words: list[str]
) -> None:
    command = process.program_command
    monkeypatch.setattr(process, "program_command", lambda *_: command(*words))

    dialog = SupportDialog(window)
    qtbot.waitUntil(lambda: "could not be made" in dialog.state.text())

    assert not dialog.save_button.isEnabled()
    assert dialog.copy_button.isEnabled()
    dialog.close()


def test_safe_mode_says_so_and_can_set_the_settings_aside(
    window: MainWindow, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(safe_mode.VARIABLE, "1")
    window.settings.write()

    tell_how_it_runs(window)
    [told] = window.messages.history
    told.message.answers[0].do()
    told.message.answers[0].do()

    assert titles(window) == [
        "This is safe mode",
        "The next usual start is as the first one",
        "There are no settings to set aside",
    ]
    assert (home / "settings.old.ini").is_file()


def test_a_stick_that_cannot_be_written_is_told(
    window: MainWindow, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / portable.ORIGIN).write_text("/stick/NEP Studio data", encoding="utf-8")
    monkeypatch.setenv(PORTABLE_VARIABLE, str(tmp_path))

    tell_how_it_runs(window)

    [told] = window.messages.history
    assert told.message.title == "Nothing is kept"
    assert "/stick/NEP Studio data" in told.message.sentence


def test_after_a_crash_safe_mode_is_what_enter_chooses_and_esc_ends(qtbot: QtBot) -> None:
    box = AfterACrash()
    qtbot.addWidget(box)

    assert box.defaultButton() is box.safe_button
    assert box.escapeButton() is box.close_button


def test_a_newer_version_is_told_once_if_the_person_wants_that(
    window: MainWindow, site: tuple[str, list[str]], qtbot: QtBot
) -> None:
    address, asked = site
    choice = UpdateChoice(window.settings)
    choice.address = address
    tell_how_it_runs(window)
    while_off = list(asked)
    choice.is_wanted = True

    tell_how_it_runs(window)
    qtbot.waitUntil(lambda: titles(window) == ["There is a new version of NEP Studio: 99.0"])
    tell_how_it_runs(window)

    assert while_off == []
    assert asked == ["/newest"]
    assert choice.announced == "99.0"


def test_the_settings_ask_nobody_until_they_are_told_to_and_cancel_takes_it_back(
    window: MainWindow, site: tuple[str, list[str]], qtbot: QtBot
) -> None:
    window.open_settings()
    [dialog] = window.findChildren(SettingsDialog)
    page = dialog.privacy
    at_first = page.check.isChecked(), page.check.isHidden(), page.ask_button.isHidden()
    told_at_first = page.unknown.text()

    page.address.setText("")
    qtbot.keyClicks(page.address, site[0])
    page.check.click()
    wanted = UpdateChoice(window.settings).is_wanted
    nobody_asked = list(site[1])
    page.ask_button.click()
    qtbot.waitUntil(lambda: "99.0" in page.state.text())
    qtbot.mouseClick(dialog.cancel_button, Qt.MouseButton.LeftButton)

    assert at_first == (False, True, True)
    assert "no address yet" in told_at_first
    assert page.unknown.isHidden()
    assert (wanted, nobody_asked, site[1]) == (True, [], ["/newest"])
    assert not UpdateChoice(window.settings).is_wanted
    assert UpdateChoice(window.settings).address == ""


def test_whoever_answers_without_end_is_not_waited_for(
    qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    parent, answers = QObject(), list[Newest | None]()
    monkeypatch.setattr(settings_dialog, "LONGEST_MS", 50)
    question = settings_dialog.Asking(parent)
    question.answered.connect(answers.append)
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()

        question.begin(f"http://127.0.0.1:{silent.getsockname()[1]}/")
        qtbot.waitUntil(lambda: answers == [None])

    waiting = [one for one in threading.enumerate() if one.name == "updates"]
    for one in waiting:
        one.join(5)
    QCoreApplication.processEvents()
    assert answers == [None]


def test_an_error_that_nobody_expected_offers_the_report(window: MainWindow) -> None:
    from nep_studio.ui.shell.crash_handler import _message

    message = _message(window, "details", Path("nep-studio.log"))
    message.answers[0].do()

    [dialog] = window.findChildren(SupportDialog)
    assert [button.text() for button in dialog.findChildren(QPushButton)][:1] == ["Copy"]
    dialog.close()
