"""Give back the plain look after each test, for the application is one for all tests."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QFont, QPalette
from PySide6.QtWidgets import QApplication


@pytest.fixture
def plain_app(qapp: QApplication) -> Iterator[QApplication]:
    """The application, undressed again when the test is over."""
    style, font, palette = qapp.style().name(), QFont(qapp.font()), QPalette(qapp.palette())
    yield qapp
    qapp.setStyleSheet("")
    qapp.setStyle(style)
    qapp.setPalette(palette)
    qapp.setFont(font)
    qapp.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
    qapp.styleHints().unsetColorScheme()
