"""Texts prepared for painting, one for each string."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QFont, QFontMetricsF, QStaticText

MOST_TEXTS = 20_000


class Texts:
    """Static texts of one font; preparing one costs more than painting it often."""

    def __init__(self) -> None:
        self._texts: dict[str, QStaticText] = {}

    def of(self, text: str) -> QStaticText:
        """The prepared text."""
        known = self._texts.get(text)
        if known is None:
            if len(self._texts) > MOST_TEXTS:
                self._texts.clear()
            known = self._texts[text] = QStaticText(text)
            known.setTextFormat(Qt.TextFormat.PlainText)
            known.setPerformanceHint(QStaticText.PerformanceHint.AggressiveCaching)
        return known


class TextWidths:
    """How wide texts are in a font, each measured once."""

    def __init__(self, font: QFont) -> None:
        self._metrics = QFontMetricsF(font)
        self._widths: dict[str, float] = {}

    @property
    def line(self) -> float:
        """The height of a line."""
        return self._metrics.height()

    def __call__(self, text: str) -> float:
        """The width of a text, rounded up to a whole unit."""
        width = self._widths.get(text)
        if width is None:
            width = self._widths[text] = float(-(-self._metrics.horizontalAdvance(text) // 1))
        return width
