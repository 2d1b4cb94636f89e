"""The first page is there first; what is behind it comes by itself, or when it is needed."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.ui.plugins.tour.tour import Tour
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import MODULES, MainWindow


@pytest.fixture
def gradual(studio: Studio, qtbot: QtBot) -> Iterator[MainWindow]:
    """A window as the program makes it, before it has been painted."""
    made = MainWindow(studio, is_gradual=True)
    qtbot.addWidget(made)
    yield made
    made.lazy.stop()
    if made.services.made_running is not None:
        made.running.close()
    if made.lazy.made_workbench is not None:
        made.workbench.retire()
    if made.files.document is not None:
        made.files.document.close()
        made.files.document = None


def test_the_first_page_needs_no_workbench(gradual: MainWindow) -> None:
    shown = gradual.pages.currentWidget()

    assert shown is gradual.start_page
    assert gradual.lazy.made_workbench is None
    assert gradual.services.made_running is None


def test_the_rest_comes_by_itself_once_the_window_is_painted(
    gradual: MainWindow, qtbot: QtBot
) -> None:
    gradual.show()
    gradual.start(None)

    qtbot.waitUntil(lambda: gradual.lazy.is_done, timeout=30_000)

    assert gradual.pages.currentWidget() is gradual.start_page
    assert "palette" in gradual.actions_by_name.by_name
    assert not gradual.actions_by_name["show_mode"].isEnabled()


def test_the_rest_is_there_once(gradual: MainWindow, qtbot: QtBot) -> None:
    told: list[bool] = []
    gradual.lazy.completed.connect(lambda: told.append(True))
    gradual.lazy.finish()

    gradual.show()
    gradual.start(None)
    qtbot.waitExposed(gradual)
    qtbot.waitUntil(lambda: not gradual.lazy.is_waiting)

    assert told == [True]
    assert gradual.pages.count() == 2


def test_a_button_pressed_before_the_rest_is_there_does_what_it_says(
    gradual: MainWindow, qtbot: QtBot
) -> None:
    gradual.show()
    gradual.start(None)

    qtbot.mouseClick(gradual.start_page.new_button, Qt.MouseButton.LeftButton)

    assert gradual.workbench.canvas.isVisible()
    assert gradual.actions_by_name["run"].isEnabled()
    assert gradual.actions_by_name["show_mode"].isEnabled()


def test_the_tour_can_be_taken_before_the_rest_is_there(gradual: MainWindow, qtbot: QtBot) -> None:
    gradual.show()
    gradual.start(None)

    gradual.start_page.tour_requested.emit()

    tour = gradual.findChild(Tour)
    assert isinstance(tour, Tour)
    qtbot.waitUntil(lambda: tour.is_running)
    tour.end()


@pytest.mark.parametrize("steps", [0, len(MODULES) + 3])
def test_the_language_can_change_while_the_rest_is_made(gradual: MainWindow, steps: int) -> None:
    gradual.show()
    gradual.start(None)
    for _ in range(steps):
        gradual.lazy.step()

    gradual.studio.choose_language("es")
    gradual.lazy.finish()

    assert gradual.menus["file"].title() == "&Archivo"
    assert gradual.workbench.helpers.palette.search.placeholderText() == "Buscar bloques"
    assert gradual.workbench.canvas.editor.language.categories[0].title == "Cuando"


def test_a_window_closed_before_the_rest_is_there_makes_no_more(gradual: MainWindow) -> None:
    gradual.show()
    gradual.start(None)

    gradual.close()
    gradual.update_actions()  # as the clipboard asks for it

    assert gradual.lazy.made_workbench is None


def test_a_step_that_fails_ends_the_steps(
    gradual: MainWindow, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, MODULES[0], None)  # as if it could not be imported

    with pytest.raises(ImportError):
        gradual.lazy.finish()

    assert not gradual.lazy.is_done


@pytest.mark.parametrize("name", MODULES)
def test_the_modules_that_are_loaded_step_by_step_exist(name: str) -> None:
    assert find_spec(name) is not None


def test_pictures_of_projects_wait_for_what_paints_blocks(
    gradual: MainWindow, tmp_path: Path, qtbot: QtBot
) -> None:
    mine = tmp_path / "mine.nep"
    mine.write_bytes((paths.examples() / "quiz.nep").read_bytes())
    gradual.settings.add_recent(mine)
    gradual.files.recent_changed.emit()
    gradual.show()
    gradual.start(None)

    qtbot.waitUntil(lambda: gradual.lazy.is_done, timeout=30_000)

    card = gradual.start_page.recent_cards[mine]
    qtbot.waitUntil(lambda: card.picture.pixmap().width() >= card.picture_size().width())
