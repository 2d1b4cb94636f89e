"""A window with the command palette."""

from __future__ import annotations

import pytest

from nep_studio.ui.shell.command_palette import CommandPalette
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "palette", "studio", "window"]


@pytest.fixture
def palette(karate: MainWindow) -> CommandPalette:
    """The palette of a window with the karate example."""
    made = karate.findChild(CommandPalette)
    assert isinstance(made, CommandPalette)
    return made
