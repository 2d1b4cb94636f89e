"""The dialog as it is seen: every look, long words, and empty places."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QObject
from PySide6.QtWidgets import QApplication, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from nep_core.networks.discovery import Found
from nep_studio.settings import Settings
from nep_studio.sharing import Refusal, Sharing
from nep_studio.ui.plugins.sharing.dialog import SharingDialog
from nep_studio.ui.plugins.sharing.refusal_words import Place
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme.colours import themes
from nep_studio.ui.theme.look import Look
from nep_studio.ui.words import use_language

pytestmark = pytest.mark.long

HOST = "127.0.0.1"


class Stage:
    """A dialog of a network that is opened for real, and what it stands on."""

    def __init__(self, folder: Path, port: int, look: Look) -> None:
        self.owner = QObject()
        self.runner = Runner(list, self.owner, logs=folder)
        self.sharing = Sharing(
            self.runner.local,
            self.owner,
            keys=folder / "own.keys",
            ports=(port, port + 1),
            is_announced=False,
        )
        self.places = [Place("192.168.1.5", "wlan0"), Place("10.0.0.7", "eth0"), Place(HOST)]
        self.dialog = SharingDialog(
            self.sharing, self.runner, Settings(folder), look, None, lambda: self.places
        )


@pytest.fixture
def stage(tmp_path: Path, free_port: int, qapp: QApplication, qtbot: QtBot) -> Iterator[Stage]:
    made = Stage(tmp_path, free_port, Look(qapp, "light"))
    made.dialog.begin()
    yield made
    made.dialog.close()
    made.sharing.end()
    made.runner.close()
    use_language("en")
    Look(qapp, "light")


def test_every_address_has_words_and_none_is_an_empty_place(stage: Stage) -> None:
    page = stage.dialog.closed_page
    offered = [page.addresses.itemText(row) for row in range(page.addresses.count())]
    could_open = stage.dialog.main_button.isEnabled()

    stage.places.clear()
    stage.dialog.look_for_places()

    assert offered == ["Wi-Fi: 192.168.1.5", "Cable: 10.0.0.7", HOST]
    assert could_open
    assert page.missing.isVisibleTo(page)
    assert not page.choice.isVisibleTo(page)
    assert not stage.dialog.main_button.isEnabled()


def test_a_single_network_that_is_found_is_filled_in(stage: Stage) -> None:
    page = stage.dialog.join_page

    page._on_found([Found("NEP Studio", "lab-pc", "1", "tcp://192.168.1.5:7100", 7555)])
    page._on_ended("")

    assert page.address.text() == "192.168.1.5:7555"
    assert page.told.text() == "1 open network was found."


@pytest.mark.parametrize("language", ["en", "de", "ja"])
def test_nothing_is_cut_off_in_any_look(
    language: str, tmp_path: Path, free_port: int, qapp: QApplication, qtbot: QtBot
) -> None:
    use_language(language)
    stage = Stage(tmp_path, free_port, Look(qapp, "light"))
    stage.dialog.begin()
    stage.sharing.open(HOST)
    qtbot.waitUntil(lambda: stage.sharing.state == "open")
    assert stage.sharing.opening is not None
    stage.sharing.opening.file.let_in("a computer with a rather long name", "a" * 40, "10.0.0.9")
    for kind in ("stranger", "own_program", "unable", "code_used_up"):
        stage.sharing._note(Refusal(kind, "192.168.1.99", time.time()))
    stage.dialog.open_page._on_remove("lab")
    for theme, scale in [*((theme, 1.0) for theme in themes()), ("dark", 2.0)]:
        Look(qapp, theme, scale)
        stage.dialog.resize(stage.dialog.minimumSizeHint())
        QApplication.processEvents()

        buttons = [one for one in stage.dialog.findChildren(QPushButton) if one.isVisible()]
        labels = [one for one in stage.dialog.open_page.findChildren(QLabel) if one.isVisible()]

        assert len(buttons) >= 7
        for button in buttons:
            words = button.fontMetrics().horizontalAdvance(button.text())
            assert button.width() >= words, (theme, scale, button.text())
            assert button.accessibleName() or button.text()
        for label in labels:
            if label.wordWrap():
                assert label.height() >= label.heightForWidth(label.width()) - 1, label.text()
    stage.dialog.close()
    stage.sharing.end()
    stage.runner.close()
    use_language("en")
    Look(qapp, "light")
