"""A window that really runs programs: a master, nodes and programs of its own."""

from __future__ import annotations

from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]
