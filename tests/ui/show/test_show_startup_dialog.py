"""The dialog writes what it shows, where it says, when its button is pressed and not before."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from nep_studio.support.startup import Place
from nep_studio.ui.plugins.show.window import StartupDialog
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B


@pytest.fixture
def dialog(window: MainWindow, open_program: Callable[..., None], tmp_path: Path) -> StartupDialog:
    open_program([B("event.started")])
    window.files.document.save(tmp_path / "my play.nep")
    place = Place("linux", tmp_path, tmp_path / "settings", has_systemd=True)
    made = StartupDialog(window.host, place)
    made.open()
    return made


def written(tmp_path: Path) -> list[Path]:
    return sorted(path for path in (tmp_path / "settings").rglob("*") if path.is_file())


def test_it_shows_every_file_with_its_place_and_writes_none_of_them(
    dialog: StartupDialog, tmp_path: Path
) -> None:
    text = dialog.text.toPlainText()

    for file in dialog.files:
        assert str(file.path) in text
        assert file.text.strip() in text
    assert str(tmp_path / "my play.nep") in text
    assert "--run" in text
    assert written(tmp_path) == []
    assert not dialog.remove_button.isEnabled()


def test_its_buttons_write_the_files_and_take_them_away(
    dialog: StartupDialog, tmp_path: Path, qtbot: QtBot
) -> None:
    qtbot.mouseClick(dialog.write_button, Qt.MouseButton.LeftButton)
    after_writing = written(tmp_path), dialog.state.text()
    qtbot.mouseClick(dialog.remove_button, Qt.MouseButton.LeftButton)

    assert after_writing[0] == sorted(file.path for file in dialog.files)
    assert after_writing[1] == "The show starts with the computer, as it is written here."
    assert written(tmp_path) == []


def test_other_choices_are_another_show_which_can_replace_it(
    dialog: StartupDialog, qtbot: QtBot
) -> None:
    qtbot.mouseClick(dialog.write_button, Qt.MouseButton.LeftButton)

    dialog.has_cues.click()

    assert dialog.state.text().startswith("Another show starts with the computer now.")
    assert dialog.write_button.isEnabled()
    dialog.write_button.click()
    assert all(file.is_as_written for file in dialog.files)


def test_a_place_that_cannot_be_written_is_told(
    dialog: StartupDialog, tmp_path: Path, qtbot: QtBot
) -> None:
    (tmp_path / "settings").write_text("in the way", encoding="utf-8")

    qtbot.mouseClick(dialog.write_button, Qt.MouseButton.LeftButton)

    assert dialog.state.text().startswith("That did not work. The computer says:")


def test_a_project_that_was_never_saved_cannot_start_with_the_computer(
    window: MainWindow, open_program: Callable[..., None], tmp_path: Path
) -> None:
    open_program([B("event.started")])

    dialog = StartupDialog(window.host, Place("darwin", tmp_path, tmp_path))

    assert not dialog.write_button.isEnabled()
    assert dialog.state.text() == "Save the project first: the computer has to find it."
    dialog.deleteLater()
