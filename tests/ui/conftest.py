"""What the tests of the window share: every theme, and the fonts that come with the program."""

from __future__ import annotations

from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from nep_studio.ui.theme import Fonts, Theme, load_fonts, load_theme, themes

HERE = Path(__file__).parent


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Let the screenless platform say what it cannot do: nothing of ours is wrong then."""
    for item in items:
        if item.path.is_relative_to(HERE):
            item.add_marker(pytest.mark.qt_log_ignore("This plugin does not support"))


@pytest.fixture(params=themes())
def theme(request: pytest.FixtureRequest) -> Theme:
    """Each theme in turn."""
    return load_theme(request.param)


@pytest.fixture
def fonts(qtbot: QtBot) -> Fonts:
    """The families of the shipped fonts, known to Qt."""
    return load_fonts()
