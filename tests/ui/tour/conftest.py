"""A real window for the tour, and a person who takes it."""

from __future__ import annotations

import pytest

from nep_studio.ui.plugins.tour.tour import Tour
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "studio", "tour", "window"]


@pytest.fixture
def tour(window: MainWindow) -> Tour:
    """The tour of the window, which nobody has begun."""
    return window.findChild(Tour)
