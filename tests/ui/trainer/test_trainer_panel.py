"""The panel "Gestures" in the window: made when it is shown, with the window's project."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from pytestqt.qtbot import QtBot

from nep_studio.ui.main_window import MainWindow
from nep_studio.ui.trainer.hint import next_step
from nep_studio.ui.trainer.panel import TrainerPanel, add_trainer_panel
from nep_studio.ui.trainer.results.training import Training


@pytest.fixture
def panel(window: MainWindow, monkeypatch: pytest.MonkeyPatch) -> Iterator[TrainerPanel]:
    monkeypatch.setattr(Training, "warm", lambda _self: None)
    made = window.workbench.findChild(TrainerPanel) or add_trainer_panel(window)
    yield made
    if made.page is not None:
        made.page.training.close()


def test_the_panel_is_made_when_it_is_shown_and_follows_the_project(
    panel: TrainerPanel, window: MainWindow, qtbot: QtBot
) -> None:
    window.files.new()
    assert panel.page is None

    window.workbench.panels.show(panel)

    page = panel.page
    assert page is not None
    assert next_step(page.desk)[0] == "connect"
    page.keeping.new_gesture("Wave")
    page.cards.refresh()
    page.cards.cards["wave"].chip.add_block()
    blocks = window.workbench.canvas.editor.project.blocks.values()
    assert [block.fields["gesture"] for block in blocks] == ["wave"]
    assert window.files.document.editor.history.steps == 2

    window.files.document.editor.history.drop(0)
    with qtbot.waitSignal(page.desk.changed):
        window.files.close()
    page.cards.refresh()
    assert next_step(page.desk) == ("project", "")
    assert not page.cards.new_button.isEnabled()
    assert not page.bar.everyday.isEnabled()
