"""A text with line numbers and marked lines, in which a click says on which line it was."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QPoint, QRect, QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QColor,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QResizeEvent,
    QTextCursor,
    QTextFormat,
)
from PySide6.QtWidgets import QApplication, QPlainTextEdit, QTextEdit, QWidget

from nep_studio.ui.theme import Look, code_font
from nep_studio.ui.words import tr

from .code_keys import press_code_key
from .highlighter import PythonHighlighter

CHUNK_LINES = 600
"""So many lines are written and coloured within a frame of the screen."""

BETWEEN_CHUNKS_MS = 4


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
        self.setTextInteractionFlags(
            Qt.TextInteractionFlag.TextSelectableByMouse
            | Qt.TextInteractionFlag.TextSelectableByKeyboard
        )
        self.setAccessibleName(tr("Python code"))
        self.blockCountChanged.connect(self._on_block_count_changed)
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
        flags = Qt.TextInteractionFlag.TextEditorInteraction
        if not is_editable:
            flags = (
                Qt.TextInteractionFlag.TextSelectableByMouse
                | Qt.TextInteractionFlag.TextSelectableByKeyboard
            )
            self._lines = self._wanted = self.toPlainText().split("\n")
        self.setTextInteractionFlags(flags)

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

    def numbers_width(self) -> int:
        """How wide the line numbers are."""
        digits = max(2, len(str(self.blockCount())))
        return self.fontMetrics().horizontalAdvance("9") * (digits + 2)

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

    def _on_block_count_changed(self) -> None:
        self._place_numbers()

    def _on_update_request(self, rect: QRect, dy: int) -> None:
        if dy:
            self.numbers.scroll(0, dy)
        else:
            self.numbers.update(0, rect.y(), self.numbers.width(), rect.height())

    def _place_numbers(self) -> None:
        width = self.numbers_width()
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

    def sizeHint(self) -> QSize:
        return QSize(self._text.numbers_width(), 0)

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
