"""Palette, show mode, cues and exporting stand together in one window."""

from __future__ import annotations

from collections import Counter

from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from nep_studio.ui.plugins.cues.panel import add_cues_panel
from nep_studio.ui.plugins.exporting import NEEDS_PROJECT, add_exporting
from nep_studio.ui.plugins.show import add_show_mode
from nep_studio.ui.shell.command_palette import add_command_palette
from nep_studio.ui.shell.main_window import MainWindow


def add_missing(window: MainWindow) -> None:
    """Add what the window does not have by itself."""
    actions = window.actions_by_name.by_name
    if "show_mode" not in actions:
        add_show_mode(window)
    if "print" not in actions:
        add_exporting(window)
    if not any(panel.name == "CuePanel" for panel in window.workbench.panels.all):
        add_cues_panel(window)
    if "palette" not in actions:
        add_command_palette(window)


def test_no_two_actions_want_the_same_key(karate: MainWindow) -> None:
    add_missing(karate)

    keys = Counter(
        key.toString()
        for action in karate.actions_by_name.by_name.values()
        for key in action.shortcuts()
    )

    assert [key for key, count in keys.items() if count > 1] == []


def test_the_palette_finds_what_the_rooms_brought(karate: MainWindow, qtbot: QtBot) -> None:
    add_missing(karate)

    qtbot.keyClick(karate, Qt.Key.Key_K, Qt.KeyboardModifier.ControlModifier)

    palette = next(w for w in karate.children() if w.objectName() == "command_palette")
    ids = {row.command.id for row in palette.rows}
    assert {f"action:{name}" for name in (*NEEDS_PROJECT, "show_mode", "show_at_start")} <= ids
    assert "panel:CuePanel" in ids
