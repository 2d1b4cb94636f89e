"""The colours of Python, line by line."""

from __future__ import annotations

import keyword
import re

from PySide6.QtGui import QFont, QSyntaxHighlighter, QTextCharFormat, QTextDocument

from nep_studio.ui.theme import Theme

_WORDS = "|".join(keyword.kwlist)
_TOKENS = re.compile(
    r"(?P<comment>#.*)"
    r"|(?P<text>[rRbBfFuU]{0,2}(?:\"\"\"|''')|[rRbBfFuU]{0,2}(?:\"(?:\\.|[^\"\\])*\"?|'(?:\\.|[^'\\])*'?))"
    r"|(?P<number>\b\d[\d_]*(?:\.\d[\d_]*)?(?:[eE][+-]?\d+)?\b)"
    rf"|(?P<keyword>\b(?:{_WORDS})\b)"
    r"|(?P<name>(?<=def )\w+|(?<=class )\w+|@[\w.]+)"
)
_IN_LONG = {'"""': 1, "'''": 2}
_LONG_OF = {state: quotes for quotes, state in _IN_LONG.items()}


class PythonHighlighter(QSyntaxHighlighter):
    """Colours keywords, texts, numbers, comments and the names that are given."""

    def __init__(self, document: QTextDocument, theme: Theme) -> None:
        super().__init__(document)
        self._formats: dict[str, QTextCharFormat] = {}
        self.set_theme(theme)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        for kind in ("comment", "text", "number", "keyword", "name"):
            form = self._formats[kind] = QTextCharFormat()
            form.setForeground(theme.colour(f"code_{kind}"))
        self._formats["keyword"].setFontWeight(QFont.Weight.Bold)
        self._formats["comment"].setFontItalic(True)
        self.rehighlight()

    def highlightBlock(self, text: str) -> None:
        """Colour a line; a text in three quotes may have begun lines above."""
        start = 0
        open_text = self.previousBlockState()
        self.setCurrentBlockState(0)
        if open_text in _LONG_OF:
            start = self._end_long(text, 0, 0, _LONG_OF[open_text])
        while start < len(text) and (found := _TOKENS.search(text, start)):
            start = self._colour(text, found)

    def _colour(self, text: str, found: re.Match[str]) -> int:
        kind = found.lastgroup or ""
        quotes = found[0].lstrip("rRbBfFuU")
        if kind == "text" and quotes in _IN_LONG:
            return self._end_long(text, found.start(), found.end(), quotes)
        self.setFormat(found.start(), found.end() - found.start(), self._formats[kind])
        return found.end()

    def _end_long(self, text: str, start: int, inside: int, quotes: str) -> int:
        """Colour a long text from ``start``; the next line goes on with it if it does not end."""
        end = text.find(quotes, inside)
        if end < 0:
            self.setCurrentBlockState(_IN_LONG[quotes])
            end = len(text)
        else:
            end += len(quotes)
        self.setFormat(start, end - start, self._formats["text"])
        return end
