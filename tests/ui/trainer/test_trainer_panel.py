"""The panel "Gestures" in the window: made when it is shown, with the window's project."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPushButton
from pytestqt.qtbot import QtBot
from shiboken6 import isValid

from nep_core.wire.messages import Imu
from nep_studio.ui.plugins.gestures import TrainerPanel
from nep_studio.ui.plugins.gestures.page import next_step
from nep_studio.ui.plugins.gestures.results.training import Training
from nep_studio.ui.running.runner import Heard
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import MainWindow


@pytest.fixture
def panel(window: MainWindow, monkeypatch: pytest.MonkeyPatch) -> Iterator[TrainerPanel]:
    monkeypatch.setattr(Training, "warm", lambda _self: None)
    made = window.workbench.findChild(TrainerPanel)
    yield made
    if isValid(made) and made.page is not None:
        made.page.training.close()


def test_the_panel_is_made_when_it_is_shown_and_follows_the_project(
    panel: TrainerPanel, window: MainWindow, qtbot: QtBot
) -> None:
    window.files.new()
    assert panel.page is None

    window.workbench.panels.show(panel)

    page = panel.page
    assert page is not None
    assert next_step(page.controller)[0] == "connect"
    page.keeping.new_gesture("Wave")
    page.cards.refresh()
    page.cards.cards["wave"].chip.add_block()
    blocks = window.workbench.canvas.editor.project.blocks.values()
    hats = [block for block in blocks if block.type == "event.gesture"]
    assert [block.fields["gesture"] for block in hats] == ["wave"]
    assert window.files.document.editor.history.steps == 2

    window.files.document.editor.history.drop(0)
    with qtbot.waitSignal(page.controller.changed):
        window.files.close()
    page.cards.refresh()
    assert next_step(page.controller) == ("project", "")
    assert not page.cards.new_button.isEnabled()
    assert not page.bar.everyday.isEnabled()


def test_in_another_language_the_panel_goes_on_with_what_was_heard(
    panel: TrainerPanel, window: MainWindow, studio: Studio, qtbot: QtBot
) -> None:
    window.files.new()
    window.workbench.panels.show(panel)
    desk = panel.page.controller
    panel.page.keeping.new_gesture("Wave")
    message = Imu(source="watch", rate_hz=50, t=[0.0, 0.02], acc=[(0, 0, 9.8)] * 2)

    studio.choose_language("qps-rtl")
    desk.hear([Heard(0.0, message, "node")])

    assert window.workbench.findChildren(TrainerPanel) == [panel]
    assert list(panel.page.cards.cards) == ["wave"]
    assert panel.page.bar.button.text().startswith("[")
    assert panel.page.strip.samples.t.size == 2
    panel.page.grab()
    panel.page.training.close()


def test_a_gesture_dragged_out_of_the_room_is_seen_in_the_program(
    panel: TrainerPanel, window: MainWindow, qtbot: QtBot
) -> None:
    window.files.new()
    window.workbench.panels.show(panel)
    panel.page.keeping.new_gesture("Wave")
    panel.page.cards.refresh()
    chip = panel.page.cards.cards["wave"].chip
    qtbot.waitUntil(chip.isVisible)
    canvas, start = window.workbench.canvas, chip.rect().center()

    QTest.mousePress(chip, Qt.MouseButton.LeftButton, pos=start)
    for step in (20, 60, 120):
        QTest.mouseMove(chip, start + QPoint(step, -step))
    QTest.mouseRelease(chip, Qt.MouseButton.LeftButton, pos=start + QPoint(120, -120))

    blocks = canvas.editor.project.blocks.values()
    [block] = [one for one in blocks if one.type == "event.gesture"]
    assert block.fields["gesture"] == "wave"
    assert canvas.isVisible() and canvas.pointing.gesture is None
    shown = canvas.sight.view_rect_of(block.id)
    assert canvas.viewport().rect().contains(shown.center().toPoint())


def test_what_is_next_to_record_has_no_second_button(
    panel: TrainerPanel, window: MainWindow, qtbot: QtBot
) -> None:
    window.files.new()
    window.workbench.panels.show(panel)
    page = panel.page
    page.keeping.new_gesture("Wave")
    page.cards.refresh()
    page.controller.hear(
        [Heard(0.0, Imu(source="watch", rate_hz=50, t=[0.0], acc=[(0, 0, 9.8)]), "")]
    )
    page.head.hint.refresh()
    qtbot.waitUntil(page.bar.button.isVisible)

    buttons = [one for one in page.findChildren(QPushButton) if one.isVisible()]
    assert [one.text() for one in buttons if "Record" in one.text()] == ["Record “Wave”"]
