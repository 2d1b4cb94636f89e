"""The scene in a real window: its keys are its own, and what is placed is kept in the file."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from nep_studio.blocks.files import load
from nep_studio.project.surroundings import kept_things
from nep_studio.run.installation import studio_language
from nep_studio.ui.plugins.robots.panel import RobotsPanel
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.words import tr
from tests.ui.window.conftest import Chooser, answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]


def shown(window: MainWindow, qtbot: QtBot) -> RobotsPanel:
    panel = window.findChild(RobotsPanel)
    window.workbench.panels.show(panel)
    qtbot.waitUntil(panel.stage.view.isVisible)
    return panel


def test_delete_takes_the_chosen_thing_away_and_no_block(karate: MainWindow, qtbot: QtBot) -> None:
    panel, project = shown(karate, qtbot), karate.files.document.project
    blocks = set(project.blocks)
    karate.workbench.canvas.selection.set([next(iter(blocks))])
    panel.stage.place("person")
    karate.activateWindow()
    panel.stage.view.setFocus()

    qtbot.keyClick(panel.stage.view, Qt.Key.Key_Delete)

    assert kept_things(project) == []
    assert set(project.blocks) == blocks


def test_what_is_placed_is_saved_and_undone_like_blocks(
    karate: MainWindow, chooser: Chooser, tmp_path: Path, qtbot: QtBot
) -> None:
    panel = shown(karate, qtbot)
    panel.stage.place("person")
    panel.stage.place("wall")
    karate.actions_by_name["undo"].trigger()
    chooser.path = tmp_path / "with_anna.nep"

    karate.actions_by_name["save_as"].trigger()

    qtbot.waitUntil(chooser.path.exists)
    qtbot.waitUntil(lambda: not karate.files.document.is_modified)
    assert [thing.name for thing in kept_things(load(chooser.path, studio_language()))] == ["Anna"]


def test_a_new_language_of_the_window_keeps_what_stands_there(
    karate: MainWindow, qtbot: QtBot
) -> None:
    panel = shown(karate, qtbot)
    panel.stage.place("person")

    karate.studio.choose_language("de")

    assert karate.findChildren(RobotsPanel) == [panel]
    assert [thing.kind for thing in panel.stage.view.room.things] == ["person"]
    assert panel.stage.tools.view.text() == tr("View") != "View"


def test_things_can_be_moved_while_the_program_runs_which_needs_no_new_start(
    karate: MainWindow, qtbot: QtBot
) -> None:
    panel, running = shown(karate, qtbot), karate.running
    running.runner.run()
    qtbot.waitUntil(lambda: running.runner.state == "running", timeout=30_000)

    panel.stage.place("person")

    assert not running.is_stale
    karate.files.document.editor.add_variable("times2")
    assert running.is_stale
