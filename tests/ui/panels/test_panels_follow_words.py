"""In another language a panel says what a panel would say that is made in that language."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator

import pytest
from PySide6.QtCore import QAbstractItemModel, QAbstractListModel, QEvent, QModelIndex, QObject, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QAbstractItemView,
    QApplication,
    QComboBox,
    QDialog,
    QMenu,
    QTabWidget,
    QTextEdit,
    QWidget,
)
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.blocks.own_animations import OwnAnimation
from nep_studio.ui.plugins.help.help_controller import HelpWindow
from nep_studio.ui.plugins.motion import MotionKit
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import FIRST_SIZE, MainWindow
from nep_studio.ui.widgets.forms import ElidedLabel
from tests.conftest import a_part_of
from tests.ui.window.conftest import chooser, home, studio, window
from tests.ui.window.putting_away import put_away

__all__ = ["chooser", "home", "studio", "window"]

KARATE = paths.examples() / "karate_greeting.nep"
LANGUAGES = a_part_of(("qps-rtl", "de", "ja"))
PANELS = (
    "TrainerPanel",
    "HumanPanel",
    "RobotsPanel",
    "CuePanel",
    "NodesPanel",
    "NetworkPanel",
    "SensorsPanel",
    "LogPanel",
    "HelpPanel",
)
SAID = (
    "text",
    "title",
    "windowTitle",
    "toolTip",
    "placeholderText",
    "accessibleName",
    "accessibleDescription",
    "suffix",
)
"""What of a widget or an action has words."""

Words = list[tuple[str, str]]


# All words of a widget.


def words_of(widget: QObject, place: str = "") -> Iterator[tuple[str, str]]:
    """The words, each with where it is."""
    place = f"{place}/{type(widget).__name__}"
    for kind in SAID:
        said = getattr(widget, kind, None)
        is_cut = kind in ("text", "toolTip") and isinstance(widget, ElidedLabel)
        if callable(said) and not is_cut and isinstance(words := said(), str) and words:
            yield f"{place}.{kind}", words
    yield from ((f"{place} item", words) for words in items_of(widget))
    for child in widget.children():
        if is_spoken(child):
            yield from words_of(child, place)


def is_spoken(child: QObject) -> bool:
    """Whether words of a part are seen: not those of Qt's own menus, nor of what is gone."""
    if isinstance(child, QDialog) or (isinstance(child, QMenu) and not child.actions()):
        return False
    if isinstance(child, QAction):
        return bool(child.text())
    return isinstance(child, QWidget) and not child.objectName().startswith("qt_spinbox")


def items_of(widget: QObject) -> Iterator[str]:
    """What is in lists, tables, choices, tabs and texts."""
    if isinstance(widget, QComboBox):
        yield from (widget.itemText(row) for row in range(widget.count()))
    elif isinstance(widget, QTabWidget):
        yield from (widget.tabText(index) for index in range(widget.count()))
    elif isinstance(widget, QTextEdit):
        yield from filter(None, widget.toPlainText().splitlines())
    elif isinstance(widget, QAbstractItemView) and widget.model() is not None:
        model, across = widget.model(), Qt.Orientation.Horizontal
        columns = 0 if isinstance(model, QAbstractListModel) else model.columnCount()
        yield from (str(model.headerData(at, across)) for at in range(columns))
        yield from rows_of(model, QModelIndex())


def rows_of(model: QAbstractItemModel, parent: QModelIndex) -> Iterator[str]:
    for row in range(model.rowCount(parent)):
        columns = 1 if isinstance(model, QAbstractListModel) else model.columnCount(parent)
        for column in range(columns):
            index = model.index(row, column, parent)
            for role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.ToolTipRole):
                if words := index.data(role):
                    yield str(words)
        yield from rows_of(model, model.index(row, 0, parent))


def sorted_words(widget: QWidget) -> Words:
    for _ in range(3):  # what is told a moment later; what is to go is gone
        QApplication.processEvents()
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    return sorted(words_of(widget))


# The panels, in a window that changes its language and in one that has it from the beginning.


def open_karate(made: MainWindow, qtbot: QtBot) -> None:
    made.files.open_example(KARATE)
    qtbot.waitUntil(lambda: made.workbench.canvas.isVisible())


def show(made: MainWindow, name: str) -> QWidget:
    panels = [one.widget for one in made.workbench.panels.all]
    panel = next(one for one in panels if type(one).__name__ == name)
    made.workbench.panels.show(panel)
    QApplication.processEvents()
    gc.collect()  # words are put on widgets again even when only Qt holds on to them
    return panel


@pytest.fixture
def another(studio: Studio, qtbot: QtBot) -> Iterator[Callable[[], MainWindow]]:
    """Makes one more window, in the language that is used now."""

    def make() -> MainWindow:
        made = MainWindow(studio)
        made.resize(FIRST_SIZE)
        qtbot.addWidget(made, before_close_func=put_away)
        made.show()
        made.start(None)
        open_karate(made, qtbot)
        return made

    return make


@pytest.mark.parametrize("code", LANGUAGES)
def test_each_panel_says_what_one_says_that_is_made_in_the_language(
    window: MainWindow, studio: Studio, another: Callable, code: str, qtbot: QtBot
) -> None:
    open_karate(window, qtbot)
    told, before, again = {}, {}, {}
    for name in PANELS:
        panel = show(window, name)
        before[name] = sorted_words(panel)
        studio.choose_language(code)
        told[name] = sorted_words(panel)
        studio.choose_language("en")
        again[name] = sorted_words(panel)

    studio.choose_language(code)
    other = another()
    fresh = {name: sorted_words(show(other, name)) for name in PANELS}

    assert {name: differences(told[name], fresh[name]) for name in PANELS} == NOTHING
    assert {name: differences(before[name], again[name]) for name in PANELS} == NOTHING
    assert all(told[name] != before[name] for name in PANELS)


NOTHING: dict[str, Words] = {name: [] for name in PANELS}


def differences(one: Words, other: Words) -> Words:
    """What one says and the other does not, each with where it stands."""
    return sorted(set(one) ^ set(other))


# Windows that stay open beside the window.


def motion(made: MainWindow) -> QWidget:
    shown = made.actions_by_name.findChild(MotionKit).make()
    shown.controller.open(OwnAnimation("Dance", {}))
    return shown


def driving(made: MainWindow) -> QWidget:
    return made.actions_by_name.findChild(MotionKit).drive()


def help_window(made: MainWindow) -> QWidget:
    made.files.close()
    made.host.ask("help.open", "howto/window")
    windows = [one for one in QApplication.topLevelWidgets() if isinstance(one, HelpWindow)]
    return next(one for one in windows if one.isVisible())


def large_robots(made: MainWindow) -> QWidget:
    panel = show(made, "RobotsPanel")
    panel.show_large(True)
    return panel.large


def numbers(made: MainWindow) -> QWidget:
    workspace = show(made, "SensorsPanel").page
    workspace.choose_fields()
    return workspace.chooser


WINDOWS = (motion, driving, large_robots, numbers, help_window)


@pytest.mark.parametrize("code", LANGUAGES)
def test_a_window_that_stays_open_says_what_one_says_that_is_opened_then(
    window: MainWindow, studio: Studio, another: Callable, code: str, qtbot: QtBot
) -> None:
    open_karate(window, qtbot)
    told, before = {}, {}
    for open_one in WINDOWS:
        shown = open_one(window)
        gc.collect()
        before[open_one] = sorted_words(shown)
        studio.choose_language(code)
        told[open_one] = sorted_words(shown)
        shown.close()
        studio.choose_language("en")

    studio.choose_language(code)
    other = another()

    for open_one in WINDOWS:
        shown = open_one(other)
        assert differences(told[open_one], sorted_words(shown)) == []
        assert told[open_one] != before[open_one]
        shown.close()


# What a person did stays.


def test_what_was_typed_chosen_and_opened_stays(
    window: MainWindow, studio: Studio, qtbot: QtBot
) -> None:
    open_karate(window, qtbot)
    person = show(window, "HumanPanel")
    person.words.setText("Guten Tag")
    person.body.posture.setCurrentIndex(3)
    person.body.angle.setValue(12.0)
    person.sections[-1].open(True)
    chosen = person.body.posture.currentData()
    log = show(window, "LogPanel").page
    log.what_happens.part.setCurrentIndex(2)
    log.what_happens.search.setText("nao")
    log.setCurrentIndex(1)
    pages = show(window, "HelpPanel").page
    pages.open("howto/window")
    pages.search.setText("Roboter")

    studio.choose_language("de")

    assert person.words.text() == "Guten Tag"
    assert (person.body.posture.currentData(), person.body.angle.value()) == (chosen, 12.0)
    assert person.sections[-1].is_open
    assert log.what_happens.part.currentData() == "cognitive"
    assert (log.what_happens.search.text(), log.currentIndex()) == ("nao", 1)
    assert pages.trail.current == "howto/window" and pages.search.text() == "Roboter"
    assert "Fenster" in pages.browser.toPlainText()
    qtbot.waitUntil(lambda: pages.searching.is_whole)
    assert pages.contents.found.item(0).flags()
