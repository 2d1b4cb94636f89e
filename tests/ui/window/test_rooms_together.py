"""Palette, show mode, cues and exporting stand together in one window."""

from __future__ import annotations

from collections import Counter

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractButton
from pytestqt.qtbot import QtBot

from nep_studio.ui.shell.main_window import MainWindow


def test_no_two_actions_want_the_same_key(karate: MainWindow) -> None:
    keys = Counter(
        key.toString()
        for action in karate.actions_by_name.by_name.values()
        for key in action.shortcuts()
    )

    assert [key for key, count in keys.items() if count > 1] == []


def test_the_palette_finds_what_the_plugins_brought(karate: MainWindow, qtbot: QtBot) -> None:
    qtbot.keyClick(karate, Qt.Key.Key_K, Qt.KeyboardModifier.ControlModifier)

    palette = next(w for w in karate.children() if w.objectName() == "command_palette")
    ids = {row.command.id for row in palette.rows}
    names = ("save_python", "copy_python", "print", "show_mode")
    assert {f"action:{name}" for name in names} <= ids
    assert "panel:CuePanel" in ids


@pytest.mark.parametrize(
    "name",
    ["LogPanel", "CuePanel", "NodesPanel", "HelpPanel", "NetworkPanel", "SensorsPanel"],
)
def test_the_icons_of_a_panel_that_is_made_later_are_as_large_as_its_words(
    karate: MainWindow, qtbot: QtBot, name: str
) -> None:
    panels = karate.workbench.panels
    panel = next(one.widget for one in panels.all if one.name == name)
    panels.show(panel)
    qtbot.waitUntil(lambda: bool(panel.findChildren(QAbstractButton)))

    small = [
        button.text() or button.toolTip()
        for button in panel.findChildren(QAbstractButton)
        if not button.icon().isNull() and button.iconSize().height() < button.fontMetrics().height()
    ]

    assert small == []
