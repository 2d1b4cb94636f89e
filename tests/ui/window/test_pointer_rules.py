"""A project is dropped anywhere, and the wheel changes nothing that has not the focus."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDragMoveEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QComboBox,
    QDial,
    QDialog,
    QDoubleSpinBox,
    QLabel,
    QLineEdit,
    QScrollArea,
    QSlider,
    QSpinBox,
    QTabBar,
    QVBoxLayout,
    QWidget,
)
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.ui.plugins.exporting.picture import PictureOptions, png_of
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.shell.settings_dialog import SettingsDialog

KARATE = paths.examples() / "karate_greeting.nep"
HELD = (Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier)


def drop(file: Path, target: QWidget) -> None:
    """What the system tells the window when a file is dragged over a part of it and dropped."""
    handle, copy, data = target.window().windowHandle(), Qt.DropAction.CopyAction, QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(file))])
    data.setText(str(file))  # as file managers add it
    place = target.mapTo(target.window(), target.rect().center())
    enter = QDragEnterEvent(place, copy, data, *HELD)
    QApplication.sendEvent(handle, enter)
    assert enter.isAccepted()
    move = QDragMoveEvent(place, copy, data, *HELD)
    move.accept()  # as the system says it after what the last answer was
    QApplication.sendEvent(handle, move)
    assert move.isAccepted()
    QApplication.sendEvent(handle, QDropEvent(QPointF(place), copy, data, *HELD))


PLACES: dict[str, Callable[[MainWindow], QWidget]] = {
    "canvas": lambda window: window.workbench.canvas.viewport(),
    "palette": lambda window: window.workbench.helpers.palette,
    "search of the palette": lambda window: window.workbench.helpers.palette.search,
    "python": lambda window: window.workbench.code.text.viewport(),
    "toolbar": lambda window: window.toolbar,
}


@pytest.mark.parametrize("place", PLACES)
def test_a_project_opens_wherever_it_is_dropped(
    karate: MainWindow, tmp_path: Path, qtbot: QtBot, place: str
) -> None:
    karate.workbench.panels.show(karate.workbench.code)
    target = PLACES[place](karate)
    qtbot.waitUntil(target.isVisible)
    file = tmp_path / "dropped.nep"
    file.write_bytes(KARATE.read_bytes())
    typed = karate.workbench.helpers.palette.search.text(), karate.workbench.code.text.toPlainText()

    drop(file, target)

    qtbot.waitUntil(lambda: karate.files.document.path == file)
    assert karate.workbench.helpers.palette.search.text() == typed[0]
    qtbot.waitUntil(lambda: karate.workbench.code.text.toPlainText() == typed[1])


def test_a_picture_with_a_project_in_it_opens_too(
    karate: MainWindow, tmp_path: Path, qtbot: QtBot
) -> None:
    picture, before = tmp_path / "picture.png", karate.files.document
    picture.write_bytes(png_of(karate.workbench.canvas, PictureOptions(has_program=True)))

    drop(picture, karate.workbench.canvas.viewport())

    qtbot.waitUntil(lambda: karate.files.document not in (before, None))
    assert karate.files.document.title


def turn_wheel(target: QWidget) -> None:
    """Turn the wheel over a widget, as the system tells its window."""
    place = target.mapTo(target.window(), target.rect().center())
    QTest.wheelEvent(target.window().windowHandle(), QPointF(place), QPoint(0, -120))
    QApplication.processEvents()


VALUES: dict[str, Callable[[], QWidget]] = {
    "slider": lambda: QSlider(Qt.Orientation.Horizontal, value=50),
    "dial": lambda: QDial(value=50),
    "spin box": lambda: QSpinBox(value=50),
    "spin box with decimals": lambda: QDoubleSpinBox(value=50),
    "choice": lambda: _choice(),
    "tabs": lambda: _tabs(),
}


def _choice() -> QComboBox:
    box = QComboBox()
    box.addItems(["one", "two", "three"])
    box.setCurrentIndex(1)
    return box


def _tabs() -> QTabBar:
    bar = QTabBar()
    for words in ("one", "two", "three"):
        bar.addTab(words)
    bar.setCurrentIndex(1)
    return bar


def value_of(widget: QWidget) -> float:
    return widget.currentIndex() if hasattr(widget, "currentIndex") else widget.value()


@pytest.fixture
def dialog(window: MainWindow, qtbot: QtBot) -> QDialog:
    """A dialog with a line that has the focus, above what is taller than its room."""
    made = QDialog(window)
    made.line, made.area, inside = QLineEdit(), QScrollArea(widgetResizable=True), QWidget()
    made.inside = QVBoxLayout(inside)
    made.area.setWidget(inside)
    box = QVBoxLayout(made)
    box.addWidget(made.line)
    box.addWidget(made.area)
    made.resize(300, 300)
    return made


@pytest.mark.parametrize("kind", VALUES)
def test_the_wheel_scrolls_and_changes_only_what_has_the_focus(
    dialog: QDialog, qtbot: QtBot, kind: str
) -> None:
    widget = VALUES[kind]()
    below = QLabel("below")
    below.setMinimumHeight(900)
    dialog.inside.addWidget(widget)
    dialog.inside.addWidget(below)
    dialog.open()
    dialog.activateWindow()
    dialog.line.setFocus()
    qtbot.waitUntil(dialog.line.hasFocus)
    before = value_of(widget)

    turn_wheel(widget)

    bar = dialog.area.verticalScrollBar()
    assert (value_of(widget), widget.hasFocus(), dialog.line.hasFocus()) == (before, False, True)
    assert bar.value() > 0
    bar.setValue(0)
    widget.setFocus()
    turn_wheel(widget)
    assert value_of(widget) != before


def test_the_wheel_over_the_settings_changes_none(window: MainWindow, qtbot: QtBot) -> None:
    window.open_settings()
    [settings] = window.findChildren(SettingsDialog)
    qtbot.waitUntil(settings.isActiveWindow)
    before = window.settings.theme, window.settings.text_scale, settings.pages.currentIndex()
    settings.close_button.setFocus()

    for widget in (settings.theme, settings.text_size, settings.language, settings.pages.tabBar()):
        turn_wheel(widget)

    after = window.settings.theme, window.settings.text_scale, settings.pages.currentIndex()
    assert after == before
    assert settings.text_size.value() * 5 == 100
