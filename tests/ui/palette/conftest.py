"""What the tests of palette, insert bar, find bar, minimap and trash share: a real canvas."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtWidgets import QHBoxLayout, QWidget

from nep_studio.run.installation import studio_language
from nep_studio.settings import Settings
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.theme.colours import load_theme
from nep_studio.ui.workbench.palette.palette import Palette
from tests.blocks.block_building import B, build, karate

LANGUAGE = studio_language()


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    """Those of a person who wants all blocks; test_palette_levels.py has a new person's."""
    settings = Settings(tmp_path)
    settings.palette_level = "all"
    return settings


@pytest.fixture
def window(qtbot) -> QWidget:
    window = QWidget()
    QHBoxLayout(window).setContentsMargins(0, 0, 0, 0)
    window.resize(1100, 700)
    qtbot.addWidget(window)
    return window


@pytest.fixture
def canvas(qtbot, window) -> Canvas:
    canvas = Canvas(karate(LANGUAGE), load_theme("light"))
    window.layout().addWidget(canvas, 1)
    window.show()
    qtbot.waitExposed(window)
    window.activateWindow()
    canvas.setFocus()
    canvas.sight.move_camera(0, 0)
    return canvas


@pytest.fixture
def palette(qtbot, window, canvas, settings) -> Palette:
    palette = Palette(canvas, settings)
    palette.setFixedWidth(400)
    window.layout().insertWidget(0, palette)
    palette.show()
    qtbot.waitUntil(lambda: canvas.x() >= palette.width() == 400)
    palette.layout().activate()
    return palette


def program_of(*stacks: list[B], **more):
    return build(LANGUAGE, *stacks, **more)
