"""Keys of a text with Python: Enter keeps the indentation, Tab moves lines, Ctrl+/ comments."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent, QTextBlock, QTextCursor
from PySide6.QtWidgets import QPlainTextEdit

INDENT = "    "


def press_code_key(text: QPlainTextEdit, event: QKeyEvent) -> bool:
    """Do what a key means in Python; False when it is a key like any other."""
    key, held = event.key(), event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
    plain, control = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ControlModifier
    if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and held == plain:
        _break_line(text)
    elif key == Qt.Key.Key_Tab and held == plain:
        _indent(text)
    elif key == Qt.Key.Key_Backtab:
        _change_lines(text, _outdented)
    elif key == Qt.Key.Key_Slash and held in (control, control | Qt.KeyboardModifier.ShiftModifier):
        _comment(text)  # with Shift on keyboards where the slash is above the 7
    else:
        return False
    return True


def _break_line(text: QPlainTextEdit) -> None:
    """Begin a line as deep as this one, after a colon deeper."""
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
