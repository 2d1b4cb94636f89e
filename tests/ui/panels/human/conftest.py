"""The simulated human over a program of the test, which really runs."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.ui.documents import Document
from nep_studio.ui.plugins.person.panel import HumanPanel
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B, build
from tests.ui.window.conftest import answer, chooser, home, studio, window

__all__ = ["answer", "chooser", "home", "studio", "window"]

RUN_MS = 30_000


@pytest.fixture
def human(window: MainWindow, qtbot: QtBot) -> Iterator[Callable[..., HumanPanel]]:
    """The panel, shown, over a program of these stacks, with robots of these names."""

    def show(*stacks: list[B], robots: tuple[str, ...] = ("NAO",)) -> HumanPanel:
        editor = build(window.studio.language, *stacks, variables=("x",))
        for name in robots:
            fields = {"name": name}
            build(window.studio.language, [B("robots.robot", fields)], page="robots", editor=editor)
        made = window.findChild(HumanPanel)
        assert isinstance(made, HumanPanel)
        window.files.document = Document(editor, parent=window)
        window.files.document_changed.emit(window.files.document)
        window.workbench.panels.show(made)
        for section in made.sections:
            section.open(True)
        qtbot.waitUntil(made.isVisible)
        made.refresh()
        return made

    yield show
    window.running.close()


@pytest.fixture
def run(window: MainWindow, qtbot: QtBot) -> Callable[[], list[object]]:
    """Runs the program until its robots are there; gives all that is heard from then on."""

    def start() -> list[object]:
        heard: list[object] = []
        runner = window.running.runner
        runner.arrived.connect(lambda batch: heard.extend(one for _, one in batch))
        runner.run()
        qtbot.waitUntil(lambda: runner.state == "running", timeout=RUN_MS)
        qtbot.waitUntil(
            lambda: any(isinstance(one, m.ProgramState) for one in heard) or "Ready" in said(heard),
            timeout=RUN_MS,
        )
        return heard

    return start


def said(heard: list[object]) -> list[str]:
    """What robots were asked to say."""
    requests = [one for one in heard if isinstance(one, m.ActionRequest) and one.action == "say"]
    return [str(one.args["text"]) for one in requests]
