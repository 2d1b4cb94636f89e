"""The settings dialog: everything is in force at once, and Cancel takes it back."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from nep_studio.settings import Settings, ShowOptions, usual_folder
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.shell.settings_dialog import SettingsDialog
from nep_studio.ui.words import tr

pytestmark = pytest.mark.long


@pytest.fixture
def dialog(window: MainWindow) -> Iterator[SettingsDialog]:
    window.open_settings()
    [made] = window.findChildren(SettingsDialog)
    yield made


def choose(box, value: str) -> None:
    box.setCurrentIndex(box.findData(value))
    box.activated.emit(box.currentIndex())


def test_cancel_takes_back_look_language_folders_and_show(
    window: MainWindow, dialog: SettingsDialog, tmp_path: Path, qtbot: QtBot
) -> None:
    choose(dialog.theme, "dark")
    qtbot.keyClick(dialog.text_size, Qt.Key.Key_Right)
    choose(dialog.language, "de")
    dialog.folders.choose("projects", tmp_path)
    dialog.show_page.again.click()
    during = (window.look.theme.name, window.settings.language, window.settings.text_scale)

    qtbot.mouseClick(dialog.cancel_button, Qt.MouseButton.LeftButton)

    assert during == ("dark", "de", pytest.approx(1.05))
    assert (window.look.theme.name, window.settings.language) == ("light", "en")
    assert window.settings.text_scale == 1
    assert window.settings.chosen_folder("projects") is None
    assert window.settings.show_options == ShowOptions()


def test_done_keeps_what_was_chosen(
    window: MainWindow, dialog: SettingsDialog, tmp_path: Path, qtbot: QtBot
) -> None:
    dialog.folders.choose("recordings", tmp_path / "here")
    dialog.show_page.at_once.click()
    dialog.show_page.restarts.setValue(9)

    qtbot.mouseClick(dialog.close_button, Qt.MouseButton.LeftButton)
    window.settings.write()

    again = Settings(window.settings.folder)
    assert again.folder_for("recordings") == tmp_path / "here"
    assert again.show_options == ShowOptions(runs_at_once=True, restarts=9)


def test_the_dialog_stays_and_speaks_the_new_language(
    window: MainWindow, dialog: SettingsDialog
) -> None:
    choose(dialog.language, "de")

    assert dialog.isVisible()
    assert dialog.windowTitle() == "Einstellungen"
    assert dialog.language.currentData() == "de"


def test_put_the_panels_back_works_after_a_change_of_language(
    window: MainWindow, dialog: SettingsDialog, qtbot: QtBot
) -> None:
    window.settings.set_shown("CodePane", False)
    choose(dialog.language, "de")

    qtbot.mouseClick(dialog.reset_button, Qt.MouseButton.LeftButton)

    assert window.settings.is_shown("CodePane", default=True)


def test_folders_begin_where_they_usually_are_and_go_back_there(
    window: MainWindow, dialog: SettingsDialog, tmp_path: Path
) -> None:
    page = dialog.folders
    for name in ("projects", "recordings", "logs"):
        assert page.paths[name].words == str(usual_folder(name))
        page.choose(name, tmp_path / name)
        assert page.paths[name].words == str(tmp_path / name)

        page.reset_buttons[name].click()

        assert page.paths[name].words == str(usual_folder(name))
        assert not page.reset_buttons[name].isEnabled()


def test_a_folder_is_chosen_with_the_dialog_of_the_system(
    dialog: SettingsDialog, tmp_path: Path
) -> None:
    named = {button.accessibleName(): button for button in dialog.folders.findChildren(QPushButton)}
    named["Projects: Change…"].click()
    [asked] = dialog.folders.findChildren(QFileDialog)

    asked.fileSelected.emit(str(tmp_path))

    assert dialog.folders.paths["projects"].words == str(tmp_path)
    asked.close()


def test_new_projects_are_saved_where_the_person_said(window: MainWindow, tmp_path: Path) -> None:
    window.settings.set_folder("projects", tmp_path)

    assert window.settings.last_folder == tmp_path


def test_a_pin_is_set_and_taken_away(window: MainWindow, dialog: SettingsDialog) -> None:
    page = dialog.show_page
    page.pin.setText("77")
    page.pin_button.click()
    has_it = window.settings.is_pin("77"), window.settings.is_pin("78"), page.pin.text()
    page.pin_button.click()

    assert has_it == (True, False, "")
    assert not window.settings.has_pin


def test_it_says_that_the_program_sends_nothing_by_itself(dialog: SettingsDialog) -> None:
    words = " ".join(label.text() for label in dialog.findChildren(QLabel))

    assert "sends nothing by itself" in words


def test_it_stays_as_it_is_in_another_language(dialog: SettingsDialog) -> None:
    dialog.pages.setCurrentWidget(dialog.show_page)
    dialog.show_page.pin.setText("1234")
    choose(dialog.language, "de")

    titles = [dialog.pages.tabText(number) for number in range(dialog.pages.count())]
    assert titles[:2] == ["Ansehen", "Ordner"]
    assert dialog.language.itemText(0) == tr("Like the computer's") != "Like the computer's"
    assert dialog.pages.currentWidget() is dialog.show_page
    assert dialog.show_page.pin.text() == "1234"
    assert dialog.show_page.pin_button.text() == tr("Set the PIN")


@pytest.mark.parametrize("text", ["nonsense", "-3", "1e9", "99999999"])
def test_a_number_of_restarts_that_makes_no_sense_is_a_sensible_one(home: Path, text: str) -> None:
    home.mkdir()
    (home / "settings.ini").write_text(f"[show]\nrestarts={text}\n", encoding="utf-8")

    assert 0 <= Settings(home).show_options.restarts <= 1000
