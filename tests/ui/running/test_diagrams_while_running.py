"""A program with states really runs, and its diagram shows where it is."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from nep_studio.ui.plugins.diagrams import DiagramPanel
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B
from tests.ui.running.window_use import WAIT_MS, press, state_is

pytestmark = pytest.mark.long


def test_the_diagram_goes_along_with_the_program(
    window: MainWindow, open_program, qtbot: QtBot
) -> None:
    open_program(
        [B("state.begins", {"state": "waiting"}, groups={"first": 1})],
        [B("state.after", {"state": "waiting", "seconds": 0.3, "target": "talking"})],
        [B("state.begins", {"state": "talking"}), B("control.wait", {"seconds": 600})],
    )
    panel = window.findChild(DiagramPanel)
    window.workbench.panels.show(panel)
    qtbot.waitUntil(lambda: panel.page is not None and panel.page.isVisible())
    view = panel.opened().view
    seen: list[str] = []
    window.running.runner.arrived.connect(lambda _: seen.extend(view.statuses))

    press(window, qtbot, "run")
    qtbot.waitUntil(lambda: view.statuses == {"talking": "running"}, timeout=WAIT_MS)
    press(window, qtbot, "stop")
    state_is(window, qtbot, "idle")

    assert "waiting" in seen
    assert view.statuses == {}
