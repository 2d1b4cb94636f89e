"""A text with line numbers and marked lines, in which a click says on which line it was."""

from __future__ import annotations

import keyword
import re
from collections.abc import Callable, Iterable, Iterator

from PySide6.QtCore import QPoint, QRect, Qt, QTimer, Signal
from PySide6.QtGui import (
    QColor,
    QFont,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QResizeEvent,
    QSyntaxHighlighter,
    QTextBlock,
    QTextCharFormat,
    QTextCursor,
    QTextDocument,
    QTextFormat,
)
from PySide6.QtWidgets import QApplication, QPlainTextEdit, QTextEdit, QWidget

from nep_studio.ui.labels import labelled
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.look import Look, code_font

# Keys of a text with Python: Enter keeps the indentation, Tab moves lines, Ctrl+/ comments.

INDENT = "    "


def press_code_key(text: QPlainTextEdit, event: QKeyEvent) -> bool:
    """Do what a key means in Python; False when it is a key like any other."""
    key, held = event.key(), event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
    plain, control = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ControlModifier
    if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and held == plain:
        # Begin a line as deep as this one, after a colon deeper
        cursor = text.textCursor()
        cursor.beginEditBlock()
        cursor.removeSelectedText()
        before = cursor.block().text()[: cursor.positionInBlock()]
        code = before.partition("#")[0] if not before.lstrip().startswith("#") else ""
        deeper = INDENT if code.rstrip().endswith(":") else ""
        cursor.insertText("\n" + before[: len(before) - len(before.lstrip())] + deeper)
        cursor.endEditBlock()
        text.setTextCursor(cursor)
        text.ensureCursorVisible()
    elif key == Qt.Key.Key_Tab and held == plain:
        _indent(text)
    elif key == Qt.Key.Key_Backtab:
        _change_lines(text, _outdented)
    elif key == Qt.Key.Key_Slash and held in (control, control | Qt.KeyboardModifier.ShiftModifier):
        _comment(text)  # with Shift on keyboards where the slash is above the 7
    else:
        return False
    return True


def _indent(text: QPlainTextEdit) -> None:
    """Move the selected lines in; without a selection, go on to the next stop."""
    cursor = text.textCursor()
    if cursor.hasSelection():
        _change_lines(text, lambda line: INDENT + line if line.strip() else line)
    else:
        cursor.insertText(INDENT[cursor.positionInBlock() % len(INDENT) :])


def _outdented(line: str) -> str:
    spaces = len(line) - len(line.lstrip(" "))
    return line[min(spaces, len(INDENT)) :]


def _comment(text: QPlainTextEdit) -> None:
    """Make comments of the selected lines, or lines of code again when all are comments."""
    lines = [block.text() for block in _blocks(text.textCursor()) if block.text().strip()]
    if not lines:
        return
    if all(line.lstrip().startswith("#") for line in lines):
        _change_lines(text, _uncommented)
        return
    depth = min(len(line) - len(line.lstrip()) for line in lines)
    _change_lines(text, lambda line: f"{line[:depth]}# {line[depth:]}" if line.strip() else line)


def _uncommented(line: str) -> str:
    start, sign, rest = line.partition("#")
    return start + rest.removeprefix(" ") if sign else line


def _change_lines(text: QPlainTextEdit, change: Callable[[str], str]) -> None:
    """Change each selected line, in one step for undo; the lines stay selected."""
    cursor = text.textCursor()
    cursor.beginEditBlock()
    for block in list(_blocks(cursor)):
        old = block.text()
        new = change(old)
        if new != old:
            same = next((i for i, (a, b) in enumerate(zip(old, new, strict=False)) if a != b), None)
            _replace(block, old, new, min(len(old), len(new)) if same is None else same)
    cursor.endEditBlock()


def _replace(block: QTextBlock, old: str, new: str, start: int) -> None:
    """Write what differs between two texts of a line, so that cursors stay where they are."""
    end = 0
    while end < min(len(old), len(new)) - start and old[-1 - end] == new[-1 - end]:
        end += 1
    cursor = QTextCursor(block)
    cursor.setPosition(block.position() + start)
    cursor.setPosition(block.position() + len(old) - end, QTextCursor.MoveMode.KeepAnchor)
    cursor.insertText(new[start : len(new) - end])


def _blocks(cursor: QTextCursor) -> Iterator[QTextBlock]:
    """The lines of a selection; one that it only touches with its end is not one of them."""
    document = cursor.document()
    block = document.findBlock(cursor.selectionStart())
    last = document.findBlock(cursor.selectionEnd())
    ends_before = cursor.hasSelection() and cursor.selectionEnd() == last.position()
    number = last.blockNumber() - (1 if ends_before and last != block else 0)
    while block.isValid() and block.blockNumber() <= number:
        yield block
        block = block.next()


# The colours of Python, line by line.

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


CHUNK_LINES = 600
"""So many lines are written and coloured within a frame of the screen."""

BETWEEN_CHUNKS_MS = 4
_READING = (
    Qt.TextInteractionFlag.TextSelectableByMouse | Qt.TextInteractionFlag.TextSelectableByKeyboard
)


class CodeText(QPlainTextEdit):
    """Python, read-only unless it is made editable; lines count from 1."""

    line_clicked = Signal(int)

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self._marked: tuple[int, ...] = ()
        self._wrong: tuple[int, ...] = ()
        self._lines = self._wanted = [""]
        self._later = QTimer(self, singleShot=True, interval=BETWEEN_CHUNKS_MS)
        self._later.timeout.connect(self._write_more)
        self._pressed = QPoint()
        self.numbers = _LineNumbers(self)
        self.highlighter = PythonHighlighter(self.document(), look.theme)
        self.setLayoutDirection(Qt.LayoutDirection.LeftToRight)  # Python is, in every language
        self.setReadOnly(True)
        self.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.setTextInteractionFlags(_READING)
        labelled(self, name="Python code")
        self.blockCountChanged.connect(self._place_numbers)
        self.updateRequest.connect(self._on_update_request)
        look.theme_changed.connect(self._on_theme_changed)
        self._on_theme_changed()

    def show_text(self, text: str) -> None:
        """Show a text; only the lines that differ are written, so that the view stays.

        Of a long text the beginning comes at once, the rest bit by bit.
        """
        self._wanted = text.removesuffix("\n").split("\n")
        self._write_more()

    def show_rest(self) -> None:
        """Show all of a long text now."""
        self._write_more(len(self._wanted))

    def _write_more(self, most: int = CHUNK_LINES) -> None:
        self._later.stop()
        old, new = self._lines, self._wanted
        if old == new:
            return
        start, end = _difference(old, new)
        written = new[start : len(new) - end][:most]
        document = self.document()
        last = document.findBlockByNumber(len(old) - end - 1)
        cursor = QTextCursor(document.findBlockByNumber(start))
        cursor.setPosition(last.position() + last.length() - 1, QTextCursor.MoveMode.KeepAnchor)
        cursor.insertText("\n".join(written))
        self._lines = [*new[:start], *written, *new[len(new) - end :]]
        if len(self._lines) < len(new):
            self._later.start()
        elif self._marked:
            self._show_marks()  # some may not have been there yet

    def mark_lines(self, lines: Iterable[int]) -> None:
        """Mark the lines of what is selected, and show the first of them."""
        lines = tuple(lines)
        if lines == self._marked:
            return
        self._marked = lines
        self._show_marks()
        if lines and not self._is_in_view(lines[0]):
            self._scroll_to(lines[0])

    def mark_wrong(self, lines: Iterable[int]) -> None:
        """Mark the lines with a mistake."""
        self._wrong = tuple(lines)
        self._show_marks()
        if self._wrong:
            self._scroll_to(self._wrong[0])

    def set_editable(self, is_editable: bool) -> None:
        """Let the person change the text, or only read it."""
        self.show_rest()
        self.setReadOnly(not is_editable)
        if not is_editable:
            self._lines = self._wanted = self.toPlainText().split("\n")
        writing = Qt.TextInteractionFlag.TextEditorInteraction
        self.setTextInteractionFlags(writing if is_editable else _READING)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Let keys do what those who write Python expect."""
        if self.isReadOnly() or not press_code_key(self, event):
            super().keyPressEvent(event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Remember the place: a press without a drag is a click."""
        self._pressed = event.position().toPoint()
        super().mousePressEvent(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Say which line was clicked."""
        super().mouseReleaseEvent(event)
        at = event.position().toPoint()
        if (at - self._pressed).manhattanLength() < 4 and not self.textCursor().hasSelection():
            self.line_clicked.emit(self.cursorForPosition(at).blockNumber() + 1)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the numbers beside the text."""
        super().resizeEvent(event)
        self._place_numbers()

    def paint_numbers(self, painter: QPainter, exposed: QRect) -> None:
        """Draw the numbers of the lines in view."""
        theme, width = self._look.theme, self.numbers.width()
        painter.fillRect(exposed, theme.colour("panel"))
        block = self.firstVisibleBlock()
        top = self.blockBoundingGeometry(block).translated(self.contentOffset()).top()
        gap = self.fontMetrics().horizontalAdvance("9")
        while block.isValid() and top <= exposed.bottom():
            height = self.blockBoundingRect(block).height()
            number = block.blockNumber() + 1
            name = (
                "error" if number in self._wrong else "text" if number in self._marked else "muted"
            )
            painter.setPen(theme.colour(name))
            place = QRect(0, int(top), width - gap, int(height))
            painter.drawText(place, Qt.AlignmentFlag.AlignRight, str(number))
            block, top = block.next(), top + height

    def _on_theme_changed(self) -> None:
        self.setFont(code_font(QApplication.font().pointSizeF() * 0.95))
        self.highlighter.set_theme(self._look.theme)
        self._place_numbers()
        self._show_marks()

    def _on_update_request(self, rect: QRect, dy: int) -> None:
        if dy:
            self.numbers.scroll(0, dy)
        else:
            self.numbers.update(0, rect.y(), self.numbers.width(), rect.height())

    def _place_numbers(self) -> None:
        digits = max(2, len(str(self.blockCount())))
        width = self.fontMetrics().horizontalAdvance("9") * (digits + 2)
        self.setViewportMargins(width, 0, 0, 0)
        inner = self.contentsRect()
        self.numbers.setGeometry(inner.left(), inner.top(), width, inner.height())

    def _show_marks(self) -> None:
        theme = self._look.theme
        marks = [self._mark(line, theme.colour("code_line")) for line in self._marked]
        marks += [self._mark(line, theme.colour("error_panel")) for line in self._wrong]
        self.setExtraSelections(marks)
        self.numbers.update()

    def _mark(self, line: int, colour: QColor) -> QTextEdit.ExtraSelection:
        mark = QTextEdit.ExtraSelection()
        mark.format.setBackground(colour)
        mark.format.setProperty(QTextFormat.Property.FullWidthSelection, True)
        mark.cursor = QTextCursor(self.document().findBlockByNumber(line - 1))
        return mark

    def _is_in_view(self, line: int) -> bool:
        block = self.document().findBlockByNumber(line - 1)
        rect = self.blockBoundingGeometry(block).translated(self.contentOffset())
        return rect.top() >= 0 and rect.bottom() <= self.viewport().height()

    def _scroll_to(self, line: int) -> None:
        """Show a line in the upper third."""
        visible = self.viewport().height() // max(1, self.fontMetrics().lineSpacing())
        self.verticalScrollBar().setValue(max(0, line - 1 - visible // 3))


class _LineNumbers(QWidget):
    """The strip beside the text."""

    def __init__(self, text: CodeText) -> None:
        super().__init__(text)
        self._text = text

    def paintEvent(self, event: QPaintEvent) -> None:
        with QPainter(self) as painter:
            painter.setFont(self._text.font())
            self._text.paint_numbers(painter, event.rect())


def _difference(old: list[str], new: list[str]) -> tuple[int, int]:
    """How many lines at the start and at the end are the same; one is left of each at least."""
    most = min(len(old), len(new)) - 1
    start = next((i for i in range(most) if old[i] != new[i]), most)
    most -= start
    end = next((i for i in range(most) if old[-1 - i] != new[-1 - i]), most)
    return start, end
