"""A window that really runs programs: a master, nodes and programs of its own."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from pytestqt.qtbot import QtBot

from nep_studio.blocks.editor import Editor
from nep_studio.ui.documents import Document
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B, build
from tests.ui.running.window_use import Seen
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]


@pytest.fixture
def open_program(window: MainWindow, qtbot: QtBot) -> Callable[..., Seen]:
    """Opens a program of these stacks in the window."""

    def show(*stacks: list[B], **more) -> Seen:
        editor: Editor = build(window.studio.language, *stacks, **more)
        build(window.studio.language, [B("robots.robot")], page="robots", editor=editor)
        window.files.document = Document(editor, parent=window)
        window.files.document_changed.emit(window.files.document)
        qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())
        return Seen(window)

    return show
