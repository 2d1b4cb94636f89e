"""What the tests of the window share: every theme, and the fonts that come with the program."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import pytest
from PySide6.QtCore import QCoreApplication, QEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from nep_studio.ui.theme.colours import Theme, load_theme, themes
from nep_studio.ui.theme.look import Fonts, load_fonts

PATIENCE_MS = 20_000


@pytest.fixture
def qtbot(qapp: QApplication, request: pytest.FixtureRequest) -> QtBot:
    """The one of pytest-qt, which waits longer: what comes late on a busy computer still comes."""
    patient = QtBot(request)
    for name in ("waitUntil", "waitSignal", "waitExposed", "waitActive"):
        setattr(patient, name, partial(getattr(patient, name), timeout=PATIENCE_MS))
    return patient


@pytest.fixture(autouse=True)
def leaves_no_windows() -> Iterator[None]:
    """What is to be deleted goes now: without a running event loop it would stay.

    Every later change of look would then dress the windows of all earlier tests too.
    """
    yield
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


@pytest.fixture(params=themes())
def theme(request: pytest.FixtureRequest) -> Theme:
    """Each theme in turn."""
    return load_theme(request.param)


@pytest.fixture
def fonts(qtbot: QtBot) -> Fonts:
    """The families of the shipped fonts, known to Qt."""
    return load_fonts()
