"""The window follows what a person chooses, at once, and remembers it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.settings import Settings
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.shell.settings_dialog import SettingsDialog
from nep_studio.ui.words import PSEUDO

pytestmark = pytest.mark.long

KARATE = paths.examples() / "karate_greeting.nep"


def choose(window: MainWindow, menu: str, words: str) -> None:
    """Choose an entry of a menu inside the View menu."""
    inner = next(a.menu() for a in window.menus["view"].actions() if a.text() == menu)
    next(a for a in inner.actions() if a.text() == words).trigger()


@pytest.mark.parametrize(("words", "name"), [("Dark", "dark"), ("High contrast", "high_contrast")])
def test_a_theme_is_in_force_at_once(karate: MainWindow, words: str, name: str) -> None:
    choose(karate, "Theme", words)

    assert karate.workbench.canvas.look.theme.name == name
    assert karate.settings.theme == name


def test_the_language_of_the_program_is_chosen_and_taken_back(karate: MainWindow) -> None:
    editor = karate.files.document.editor
    menu = next(
        a.menu() for a in karate.menus["run"].actions() if a.text() == "Language of the program"
    )

    next(a for a in menu.actions() if a.text() == "Deutsch").trigger()

    assert editor.project.spoken_language == "de"
    menu.aboutToShow.emit()
    assert [a.text() for a in menu.actions() if a.isChecked()] == ["Deutsch"]
    editor.history.undo()
    assert editor.project.spoken_language == "en"


def test_what_an_error_ends_is_chosen_and_taken_back(karate: MainWindow) -> None:
    editor = karate.files.document.editor
    ends = next(
        a
        for a in karate.menus["run"].actions()
        if a.text() == "Stop everything when one rule fails"
    )

    ends.trigger()

    assert editor.project.ends_on_error
    editor.history.undo()
    karate.menus["run"].aboutToShow.emit()
    assert not editor.project.ends_on_error and not ends.isChecked()


def test_larger_text_makes_blocks_larger_but_moves_none(karate: MainWindow) -> None:
    canvas = karate.workbench.canvas
    block = karate.files.document.project.pages["behaviour"][1].body[0]
    before, seen = canvas.page_layout.placed(block).rect, canvas.sight.view_rect_of(block)

    choose(karate, "Size of the text", "200%")

    assert canvas.page_layout.placed(block).rect == before
    assert canvas.sight.view_rect_of(block).height() == pytest.approx(2 * seen.height(), rel=0.1)


def test_another_language_leaves_the_panel_on_top_that_alone_is_shown(karate: MainWindow) -> None:
    bottom = karate.workbench.panels.areas["bottom"]
    for panel in karate.workbench.panels.all:
        if panel.area is bottom:
            panel.action.setChecked(panel.name == "NodesPanel")

    karate.studio.choose_language(PSEUDO)

    bottom = karate.workbench.panels.areas["bottom"]
    assert bottom.isTabVisible(bottom.currentIndex())
    assert type(bottom.currentWidget()).__name__ == "NodesPanel"


def test_another_language_keeps_project_history_and_selection(
    karate: MainWindow, qtbot: QtBot
) -> None:
    document = karate.files.document
    document.editor.apply(RenameProject("Kept"))
    block = document.project.pages["behaviour"][1].body[1]
    karate.workbench.canvas.selection.set([block])

    karate.studio.choose_language(PSEUDO)

    assert karate.files.document is document
    assert karate.workbench.canvas.selection.ids == (block,)
    assert karate.workbench.canvas.look.measures.is_mirrored
    assert karate.isRightToLeft()
    assert karate.menus["file"].title() != "&File"
    karate.actions_by_name["undo"].trigger()
    assert document.project.name == "Karate greeting"


def test_after_a_change_of_language_nothing_of_the_old_window_listens(
    karate: MainWindow, qtbot: QtBot
) -> None:
    karate.studio.choose_language(PSEUDO)
    karate.studio.choose_language("en")

    karate.files.document.editor.apply(RenameProject("Heard"))

    assert karate.actions_by_name["undo"].isEnabled()


def test_the_settings_dialog_changes_the_theme(karate: MainWindow, qtbot: QtBot) -> None:
    karate.actions_by_name["settings"].trigger()
    [dialog] = karate.findChildren(SettingsDialog)

    dialog.theme.setFocus()
    qtbot.keyClicks(dialog.theme, "Dark")
    dialog.theme.activated.emit(dialog.theme.currentIndex())

    assert karate.look.theme.name == "dark"


def test_the_settings_dialog_changes_the_size_of_the_text(karate: MainWindow, qtbot: QtBot) -> None:
    karate.actions_by_name["settings"].trigger()
    [dialog] = karate.findChildren(SettingsDialog)

    qtbot.keyClick(dialog.text_size, Qt.Key.Key_Right)

    assert karate.settings.text_scale == pytest.approx(1.05)
    assert karate.look.scale == pytest.approx(1.05)


def test_a_hidden_panel_is_hidden_the_next_time(karate: MainWindow, qtbot: QtBot) -> None:
    area = karate.workbench.panels.areas["right"]
    karate.workbench.panels.show(karate.workbench.code)

    qtbot.mouseClick(area.close_button, Qt.MouseButton.LeftButton)

    assert not karate.workbench.code.isVisible()
    assert not Settings(karate.settings.folder).is_shown("CodePane", default=True)


@pytest.mark.parametrize("text", ["nonsense", "-3", "nan", "1e999"])
def test_a_size_that_makes_no_sense_is_a_sensible_one(home: Path, text: str) -> None:
    home.mkdir()
    (home / "settings.ini").write_text(f"[look]\ntext_scale={text}\n", encoding="utf-8")

    assert 0.8 <= Settings(home).text_scale <= 2.5


def test_actions_can_be_used_only_when_they_have_something_to_do(
    window: MainWindow, qtbot: QtBot
) -> None:
    def enabled() -> set[str]:
        actions = window.actions_by_name.by_name.items()
        return {name for name, action in actions if action.isEnabled()}

    at_start = enabled()
    window.files.open_example(KARATE)
    opened = enabled()
    window.workbench.canvas.selection.set(
        [window.files.document.project.pages["behaviour"][0].body[1]]
    )
    selected = enabled()

    assert not at_start & {"save", "undo", "redo", "copy", "delete", "zoom_in", "check", "paste"}
    assert opened - at_start >= {"save", "save_as", "close", "zoom_in", "check", "select_all"}
    assert selected - opened == {"cut", "copy", "duplicate", "delete", "disable", "collapse"}


def test_copy_and_paste_by_keys_add_blocks(karate: MainWindow, qtbot: QtBot) -> None:
    canvas, project = karate.workbench.canvas, karate.files.document.project
    canvas.selection.set([project.pages["behaviour"][0].body[1]])
    before = len(project.blocks)

    qtbot.keyClick(canvas, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    qtbot.keyClick(canvas, Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)

    assert len(project.blocks) == before + 1


SMOKE = """
import sys
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from nep_studio.ui.shell import app

make, timer = app.make_application, []

def look():
    window = next(w for w in QApplication.topLevelWidgets() if w.inherits("QMainWindow"))
    if window.files.document is not None and window.workbench.canvas.isVisible():
        timer[0].stop()
        print(QApplication.platformName(), window.files.document.title, flush=True)
        window.close()

def make_and_look():
    application = make()
    timer.append(QTimer(application, interval=50))
    timer[0].timeout.connect(look)
    timer[0].start()
    return application

app.make_application = make_and_look
sys.exit(app.main(sys.argv[1:]))
"""


def test_the_program_opens_its_window_on_a_display(
    xvfb: dict[str, str], home: Path, tmp_path: Path
) -> None:
    file = tmp_path / "karate.nep"
    file.write_bytes(KARATE.read_bytes())
    environment = {**xvfb, "NEP_STUDIO_FOLDER": str(home)}

    shown = subprocess.run(
        [sys.executable, "-c", SMOKE, str(file)],
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
    )

    assert shown.stdout.split() == ["xcb", "karate"], shown.stderr
    assert shown.returncode == 0, shown.stderr
    assert list((home / "journals").iterdir()) == []
