"""Save and copy the Python from the window."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from nep_studio.ui.plugins.exporting import save_python
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]


def told(window: MainWindow) -> list[str]:
    return [card.message.title for card in window.message_area.cards]


def test_the_saved_python_is_python_and_says_how_to_run_it(
    karate: MainWindow, tmp_path: Path
) -> None:
    assert save_python(karate.host, tmp_path / "karate.py")

    text = (tmp_path / "karate.py").read_text(encoding="utf-8")
    assert text.startswith("# To run this program")
    assert "nep-studio exec karate.py" in text
    check = [sys.executable, "-m", "py_compile", str(tmp_path / "karate.py")]
    assert subprocess.run(check, check=False).returncode == 0
    assert told(karate) == ["Saved “karate.py”. At its top it says how to run it."]


def test_the_dialog_suggests_a_name_that_python_can_import(
    karate: MainWindow, qtbot: QtBot
) -> None:
    karate.actions_by_name["save_python"].trigger()

    [dialog] = karate.findChildren(QFileDialog)
    [name] = dialog.selectedFiles()
    assert Path(name).name == "karate_greeting.py"
    dialog.reject()


def test_copying_puts_the_python_on_the_clipboard(karate: MainWindow) -> None:
    karate.actions_by_name["copy_python"].trigger()

    assert 'nao.say("Impressive!")' in QGuiApplication.clipboard().text()


@pytest.mark.parametrize("place", ["missing/folder/x.py", "a_folder"])
def test_a_place_that_cannot_be_written_is_told_and_leaves_nothing(
    karate: MainWindow, tmp_path: Path, place: str
) -> None:
    (tmp_path / "a_folder").mkdir()

    assert not save_python(karate.host, tmp_path / place)

    assert told(karate) == ["The Python could not be saved"]
    assert [path.name for path in tmp_path.iterdir() if path.name != "home"] == ["a_folder"]


def test_without_a_project_nothing_happens(window: MainWindow, tmp_path: Path) -> None:
    assert not save_python(window, tmp_path / "x.py")
    assert not (tmp_path / "x.py").exists()
