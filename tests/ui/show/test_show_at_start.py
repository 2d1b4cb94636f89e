"""One switch of the settings lets the show start with the computer; it shows what it writes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QCheckBox, QWidget
from pytestqt.qtbot import QtBot

from nep_studio.support.startup import Place
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.shell.settings_dialog import PagesArea, SettingsDialog
from nep_studio.ui.shell.show_at_start import FilesDialog, ShowAtStart
from nep_studio.ui.widgets.forms import room_around
from tests.blocks.block_building import B

Open = Callable[..., SettingsDialog]


@pytest.fixture
def open_dialog(window: MainWindow, tmp_path: Path) -> Open:
    """Opens the settings at the page about shows, as for this project."""

    def open_(project: Path | None = tmp_path / "my play.nep") -> SettingsDialog:
        place = Place("linux", tmp_path, tmp_path / "settings", has_systemd=True)
        made = SettingsDialog(window.studio, window, project=project, place=place)
        made.pages.setCurrentWidget(made.show_page)
        made.open()
        return made

    return open_


@pytest.fixture
def at_start(open_dialog: Open) -> ShowAtStart:
    return open_dialog().show_page.at_start


def written(tmp_path: Path) -> list[Path]:
    return sorted(path for path in (tmp_path / "settings").rglob("*") if path.is_file())


def press(box: QCheckBox, qtbot: QtBot) -> None:
    qtbot.mouseClick(box, Qt.MouseButton.LeftButton, pos=QPoint(8, box.height() // 2))


def test_it_shows_every_file_with_its_place_and_writes_none_of_them(
    at_start: ShowAtStart, tmp_path: Path, qtbot: QtBot
) -> None:
    qtbot.mouseClick(at_start.details_button, Qt.MouseButton.LeftButton)

    [shown] = at_start.findChildren(FilesDialog)
    text = shown.text.toPlainText()
    assert shown.isVisible()
    for file in at_start.files:
        assert str(file.path) in text
        assert file.text.strip() in text
    assert str(tmp_path / "my play.nep") in text
    assert "--run" in text
    assert written(tmp_path) == []
    assert not at_start.switch.isChecked()


def test_the_switch_writes_the_files_and_takes_them_away(
    at_start: ShowAtStart, tmp_path: Path, qtbot: QtBot
) -> None:
    press(at_start.switch, qtbot)
    after_on = written(tmp_path), at_start.state.text(), at_start.switch.isChecked()
    press(at_start.switch, qtbot)

    files = sorted(file.path for file in at_start.files)
    assert after_on == (files, "The show starts with the computer.", True)
    assert written(tmp_path) == []
    assert not at_start.switch.isChecked()


def test_what_the_show_does_changes_while_the_switch_is_on(
    at_start: ShowAtStart, qtbot: QtBot
) -> None:
    press(at_start.switch, qtbot)

    press(at_start.runs_at_once, qtbot)

    assert all(file.is_as_written for file in at_start.files)
    assert not any("--run" in file.text for file in at_start.files)


def test_the_switch_is_as_it_was_left(
    at_start: ShowAtStart, open_dialog: Open, qtbot: QtBot
) -> None:
    press(at_start.switch, qtbot)
    press(at_start.runs_at_once, qtbot)

    again = open_dialog().show_page.at_start

    assert again.switch.isChecked() and not again.runs_at_once.isChecked()


def test_another_show_is_replaced_by_off_and_on(
    at_start: ShowAtStart, open_dialog: Open, tmp_path: Path, qtbot: QtBot
) -> None:
    press(at_start.switch, qtbot)
    other = open_dialog(tmp_path / "another.nep").show_page.at_start
    told = other.state.text()

    press(other.switch, qtbot)
    press(other.switch, qtbot)

    assert told.startswith("Another show starts with the computer")
    assert all(file.is_as_written for file in other.files)
    assert any("another.nep" in file.text for file in other.files)


@pytest.mark.parametrize("was_on", [False, True])
def test_cancel_takes_the_switch_back(
    open_dialog: Open, tmp_path: Path, qtbot: QtBot, was_on: bool
) -> None:
    if was_on:
        press(open_dialog().show_page.at_start.switch, qtbot)
    before = [(path, path.read_bytes()) for path in written(tmp_path)]
    dialog = open_dialog()
    press(dialog.show_page.at_start.switch, qtbot)
    during = len(written(tmp_path))

    qtbot.mouseClick(dialog.cancel_button, Qt.MouseButton.LeftButton)

    assert during == (0 if was_on else 2)
    assert [(path, path.read_bytes()) for path in written(tmp_path)] == before


def test_a_place_that_cannot_be_written_is_told(
    at_start: ShowAtStart, tmp_path: Path, qtbot: QtBot
) -> None:
    (tmp_path / "settings").write_text("in the way", encoding="utf-8")

    press(at_start.switch, qtbot)

    assert at_start.state.text().startswith("That did not work. The computer says:")
    assert not at_start.switch.isChecked()


def test_a_project_that_was_never_saved_cannot_start_with_the_computer(
    window: MainWindow, open_program: Callable[..., None], qtbot: QtBot
) -> None:
    open_program([B("event.started")])
    window.open_settings()
    [dialog] = window.findChildren(SettingsDialog)

    at_start = dialog.show_page.at_start

    assert not at_start.switch.isEnabled()
    assert at_start.state.text() == "Save the project first: the computer has to find it."


@pytest.mark.parametrize(("room", "scale"), [((1366, 768), 1.25), ((1024, 640), 1.0)])
def test_all_of_it_fits_on_a_small_screen(
    window: MainWindow, open_dialog: Open, qtbot: QtBot, room: tuple[int, int], scale: float
) -> None:
    """A screen of 1280 x 800 at 125 % has room for 1024 x 640."""
    window.studio.choose_language("de")
    window.studio.choose_text_scale(scale)
    title_bar = 40

    dialog = open_dialog()

    def has_room(page: QWidget) -> bool:
        inside = [part for part in page.findChildren(QWidget) if part.isVisible()]
        ends = [part.mapTo(dialog.pages, part.rect().bottomRight()) for part in inside]
        is_seen = all(dialog.pages.rect().contains(end) for end in ends)
        is_seen = is_seen and dialog.pages.geometry().bottom() < dialog.close_button.y()
        return is_seen and all(part.height() >= part.minimumSizeHint().height() for part in inside)

    for number in range(dialog.pages.count()):
        dialog.pages.setCurrentIndex(number)
        qtbot.waitUntil(lambda: has_room(dialog.pages.currentWidget()))
    assert dialog.width() <= room[0] and dialog.height() + title_bar <= room[1]


def test_with_words_of_twice_the_size_its_buttons_are_on_a_small_screen(
    window: MainWindow, open_dialog: Open, qtbot: QtBot
) -> None:
    window.studio.choose_text_scale(2.0)
    title_bar = 40

    dialog = open_dialog()
    dialog.pages.setCurrentWidget(dialog.show_page)
    last = dialog.show_page.at_start.details_button

    def is_reached() -> bool:
        bar = dialog.findChild(PagesArea).verticalScrollBar()
        bar.setValue(bar.maximum())
        return not last.visibleRegion().isEmpty()

    qtbot.waitUntil(is_reached)
    assert dialog.height() + title_bar <= room_around(dialog).height()
    assert dialog.rect().contains(dialog.close_button.geometry())
    window.studio.choose_text_scale(1.0)
