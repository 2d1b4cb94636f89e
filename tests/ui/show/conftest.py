"""A window that really runs shows."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from pytestqt.qtbot import QtBot

from nep_studio.settings import ShowOptions
from nep_studio.ui.documents import Document
from nep_studio.ui.plugins.show import ShowMode
from nep_studio.ui.plugins.show.window import ShowWindow
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B, build
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "open_program", "show", "studio", "window"]


@pytest.fixture
def open_program(window: MainWindow, qtbot: QtBot) -> Callable[..., None]:
    """Opens a program of these stacks in the window, with a robot on the screen."""

    def open_(*stacks: list[B], **more: object) -> None:
        editor = build(window.studio.language, *stacks, **more)
        build(window.studio.language, [B("robots.robot")], page="robots", editor=editor)
        window.files.document = Document(editor, parent=window)
        window.files.document_changed.emit(window.files.document)
        qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())

    return open_


@pytest.fixture
def show(window: MainWindow) -> Iterator[Callable[..., ShowWindow]]:
    """Begins a show with these options; it is over at the end."""
    modes = []

    def begin(path=None, **options: object) -> ShowWindow:
        modes.append(ShowMode(window.host))
        return modes[-1].begin(ShowOptions(**options), path)

    yield begin
    window.running.close()
    for mode in modes:
        if mode.show is not None:
            mode.show.leave()
