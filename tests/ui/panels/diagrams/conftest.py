"""A window with a program of states or of a tree, and its diagram beside the blocks."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from pytestqt.qtbot import QtBot

from nep_studio.ui.documents import Document
from nep_studio.ui.plugins.diagrams import DiagramPanel
from nep_studio.ui.plugins.diagrams.panel import DiagramPage
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B, build
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]


def say(text: str) -> B:
    return B("robot.say", {"text": text})


def check(number: int) -> B:
    compared = B("logic.compare", {"a": number, "b": 2})
    return B("tree.check", inputs={"condition": compared})


VISIT = (
    [B("state.begins", {"state": "waiting"}, groups={"first": 1}), say("Hello")],
    [B("state.begins", {"state": "talking"})],
    [B("state.person", {"state": "waiting", "trigger": "touched_head", "target": "talking"})],
    [B("state.after", {"state": "talking", "seconds": 30, "target": "waiting"})],
    [B("state.told", {"state": "talking", "message": "ready", "target": "talking"})],
    [B("event.started"), B("state.go", {"state": "resting"})],
)
GREET = (
    [
        B("tree.tree", {"name": "greet"}),
        B(
            "tree.fallback",
            bodies={
                "do": [
                    B("tree.sequence", bodies={"do": [check(1), check(3)]}),
                    B(
                        "tree.retry",
                        {"times.1": 3},
                        bodies={
                            "do": [B("tree.step", {"name": "wave"}, bodies={"do": [say("Hi")]})]
                        },
                        groups={"limit": 1},
                    ),
                    B("tree.sub_tree", {"name": "rest"}),
                ]
            },
        ),
    ],
)


@pytest.fixture
def draw(window: MainWindow, qtbot: QtBot) -> Callable[..., DiagramPage]:
    """Opens a program of these stacks, and the panel with its diagrams."""

    def show(*stacks: list[B]) -> DiagramPage:
        editor = build(window.studio.language, *stacks)
        window.files.document = Document(editor, parent=window)
        window.files.document_changed.emit(window.files.document)
        panel = window.findChild(DiagramPanel)
        window.workbench.panels.show(panel)
        qtbot.waitUntil(lambda: panel.page is not None and panel.page.isVisible())
        return panel.opened()

    return show
