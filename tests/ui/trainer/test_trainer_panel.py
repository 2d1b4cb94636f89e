"""The panel "Gestures" in the window: made when it is shown, with the window's project."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
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
    assert [block.fields["gesture"] for block in blocks] == ["wave"]
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
