"""The log of a node: it follows the end, can be searched, copied and saved."""

from __future__ import annotations

import shutil
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import Qt, QTimer, QUrl, Signal
from PySide6.QtGui import (
    QDesktopServices,
    QGuiApplication,
    QHideEvent,
    QKeySequence,
    QShortcut,
    QShowEvent,
    QTextCursor,
    QTextDocument,
)
from PySide6.QtWidgets import QLineEdit, QPlainTextEdit, QPushButton, QToolButton, QWidget

from faults import text_of
from faults.files import whole_file, write_whole
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import ElidedLabel
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.widgets.questions import ask_for_path
from nep_studio.ui.words import count_words, tr

# The end of a node's log, read bit by bit; however much it writes, a piece stays small.

PIECE_BYTES = 65_536
PIECE_LINES = 500
"""What can be shown at once without a stutter; of more, the last is shown."""
COMPARED_LINES = 200


@dataclass(frozen=True)
class Piece:
    """New lines; ``is_new_log`` when the node began anew, ``has_gap`` when lines are left out."""

    lines: tuple[str, ...] = ()
    is_new_log: bool = False
    has_gap: bool = False


class LogTail:
    """Reads a log file that may grow, begin anew, be full, or not be there.

    ``last_lines`` gives the last lines that the node wrote, for when the file has them not.
    """

    def __init__(self, path: Path, last_lines: Callable[[], list[str]]) -> None:
        self._path, self._last_lines = path, last_lines
        self._offset = 0
        self._rest = b""
        self._shown: deque[str] = deque(maxlen=COMPARED_LINES)
        self._still = 0

    def read(self) -> Piece:
        """What is new since the last time."""
        try:
            size = self._path.stat().st_size
            is_new_log = size < self._offset
            if is_new_log:
                self._offset, self._rest, self._still = 0, b"", 0
                self._shown.clear()
            piece = self._read_file(size, is_new_log)
        except OSError:
            piece = Piece()
        if not piece.lines and not piece.is_new_log:
            piece = self._beside_file()
        self._shown.extend(piece.lines)
        return piece

    def _read_file(self, size: int, is_new_log: bool) -> Piece:
        has_gap = size - self._offset > PIECE_BYTES
        if has_gap:
            self._offset, self._rest = size - PIECE_BYTES, b""
        if size == self._offset:
            return Piece(is_new_log=is_new_log)
        with self._path.open("rb") as file:
            file.seek(self._offset)
            data = self._rest + file.read(PIECE_BYTES)
            self._offset = file.tell()
        self._still = 0
        *whole, self._rest = data.split(b"\n")
        if has_gap:
            whole = whole[1:]  # half a line
        return self._piece([one.decode(errors="replace") for one in whole], is_new_log, has_gap)

    def _beside_file(self) -> Piece:
        """The node's last lines, when the file stands still though the node writes."""
        lines = self._last_lines()
        if not lines or (self._shown and lines[-1] == self._shown[-1].rstrip()):
            self._still = 0
            return Piece()
        self._still += 1
        if self._still < 2:  # the file may get the line in a moment
            return Piece()
        self._rest = b""
        known = _overlap([line.rstrip() for line in self._shown], lines)
        return self._piece(lines[known:], False, has_gap=known == 0 and bool(self._shown))

    def _piece(self, lines: list[str], is_new_log: bool, has_gap: bool) -> Piece:
        kept = lines[-PIECE_LINES:]
        has_gap = has_gap or len(kept) < len(lines)
        return Piece(tuple(line.rstrip("\r") for line in kept), is_new_log, has_gap)


def _overlap(before: list[str], after: list[str]) -> int:
    """How many of the first lines of ``after`` are the last of ``before``."""
    for count in range(min(len(before), len(after)), 0, -1):
        if before[-count:] == after[:count]:
            return count
    return 0


READ_MS = 100
MOST_LINES = 5000
"""So many lines are kept in the view; the file has more."""


class LogView(QWidget):
    """Reads a log while it is visible; ``closed`` when the person is done with it."""

    closed = Signal()
    saving_failed = Signal(str, str)

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self._tail: LogTail | None = None
        self._path = Path()
        self._waiting: deque[str] = deque(maxlen=MOST_LINES)
        self.node = ""
        self.title = ElidedLabel()
        self.title.setProperty("role", "heading")
        self.text = QPlainTextEdit(
            readOnly=True,
            maximumBlockCount=MOST_LINES,
            lineWrapMode=QPlainTextEdit.LineWrapMode.NoWrap,
            undoRedoEnabled=False,
        )
        self.text.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.text.setTextInteractionFlags(
            Qt.TextInteractionFlag.TextSelectableByMouse
            | Qt.TextInteractionFlag.TextSelectableByKeyboard
        )
        self.search = QLineEdit(clearButtonEnabled=True)
        labelled(self.search, placeholder="Find in the log", name="Find in the log")
        self.follow_button = QPushButton()
        self.follow_button.setProperty("kind", "quiet")
        self.follow_button.hide()
        self.copy_button = _tool("Copy", tip="Copy what is selected, or all of it")
        self.save_button = _tool("Save as…", tip="Save the whole log")
        self.folder_button = _tool("Open folder", tip="Show the log's file in its folder")
        self.close_button = _tool("Close the log", tip="Close the log")
        self._timer = QTimer(self, interval=READ_MS)
        self._lay_out()
        self._connect()
        self._on_theme_changed()
        follow_words(self, self._say)

    def _lay_out(self) -> None:
        tools = self.copy_button, self.save_button, self.folder_button, self.close_button
        bar = in_row((self.title, 1), (self.search, 1), *tools)
        follow = self.follow_button, 0, Qt.AlignmentFlag.AlignTrailing
        in_column(bar, (self.text, 1), follow, of=self, margins=0)

    def _connect(self) -> None:
        self._timer.timeout.connect(self._on_read)
        self.text.verticalScrollBar().valueChanged.connect(self._on_scrolled)
        self.follow_button.clicked.connect(self.follow)
        self.search.returnPressed.connect(self.find_next)
        self.search.textEdited.connect(self._on_find_edited)
        self.copy_button.clicked.connect(self.copy)
        self.save_button.clicked.connect(self._on_save_clicked)
        self.folder_button.clicked.connect(self._on_folder_clicked)
        self.close_button.clicked.connect(self.closed)
        self._look.theme_changed.connect(self._on_theme_changed)
        context = Qt.ShortcutContext.WidgetWithChildrenShortcut
        find = QKeySequence(QKeySequence.StandardKey.Find)
        QShortcut(find, self, self.search.setFocus, context=context)
        QShortcut(QKeySequence("Shift+Return"), self.search, self.find_before, context=context)
        QShortcut(QKeySequence("Escape"), self, self.closed.emit, context=context)

    @property
    def is_reading(self) -> bool:
        """Whether it looks for new lines."""
        return self._timer.isActive()

    def show_log(self, node: str, path: Path, last_lines: Callable[[], list[str]]) -> None:
        """Show the log of a node from now on."""
        if node != self.node:
            self.node, self._path = node, path
            self._tail = LogTail(path, last_lines)
            self._waiting.clear()
            self.text.clear()
            self._say()
            labelled(self.text, name=text_of("Log of {node}", node=node))
        if self.isVisible():
            self._start()

    def follow(self) -> None:
        """Go to the end and stay there."""
        bar = self.text.verticalScrollBar()
        bar.setValue(bar.maximum())
        self._write_waiting()
        bar.setValue(bar.maximum())

    def find_next(self) -> bool:
        """Go to where the searched words are next; from the end on at the beginning."""
        return self._find(QTextDocument.FindFlag(0), QTextCursor.MoveOperation.Start)

    def find_before(self) -> bool:
        """Go to where they were before."""
        return self._find(QTextDocument.FindFlag.FindBackward, QTextCursor.MoveOperation.End)

    def copy(self) -> None:
        """Copy what is selected, or all."""
        selected = self.text.textCursor().selection().toPlainText()
        QGuiApplication.clipboard().setText(selected or self.text.toPlainText())

    def save_to(self, path: Path) -> None:
        """Save the whole log, from its file if there is one."""
        try:
            if self._path.is_file():
                with self._path.open("rb") as kept, whole_file(path) as file:
                    shutil.copyfileobj(kept, file)
            else:
                write_whole(path, self.text.toPlainText())
        except OSError as error:
            self.saving_failed.emit(str(path), error.strerror or str(error))

    def showEvent(self, event: QShowEvent) -> None:
        """Read."""
        super().showEvent(event)
        self._start()

    def hideEvent(self, event: QHideEvent) -> None:
        """Read nothing while nobody looks."""
        super().hideEvent(event)
        self._timer.stop()

    def _start(self) -> None:
        if self._tail is not None:
            self._on_read()
            self._timer.start()

    def _on_read(self) -> None:
        assert self._tail is not None
        lines = _lines_of(self._tail.read())
        if not lines:
            return
        self._waiting.extend(lines)
        if self._is_at_end():
            self._write_waiting()
        else:
            self._say()
            self.follow_button.show()

    def _say(self) -> None:
        self.title.set_words(tr("Log of {node}", node=self.node) if self.node else "")
        words = count_words(len(self._waiting), "1 new line below", "{n} new lines below")
        self.follow_button.setText(words)

    def _write_waiting(self) -> None:
        """Show the lines that have come while the person was reading above."""
        if self._waiting:
            lines = "\n".join(self._waiting)
            self._waiting.clear()  # first: the text scrolls, and that asks for what waits
            self.text.appendPlainText(lines)
        self.follow_button.hide()

    def _is_at_end(self) -> bool:
        bar = self.text.verticalScrollBar()
        return bar.value() >= bar.maximum() - 1

    def _on_scrolled(self) -> None:
        if self._waiting and self._is_at_end():
            self._write_waiting()

    def _find(self, flags: QTextDocument.FindFlag, again: QTextCursor.MoveOperation) -> bool:
        words = self.search.text()
        found = bool(words) and self.text.find(words, flags)
        if words and not found:
            cursor = self.text.textCursor()
            self.text.moveCursor(again)
            found = self.text.find(words, flags)
            if not found:
                self.text.setTextCursor(cursor)
        self.search.setProperty("state", "wrong" if words and not found else "")
        self.search.style().unpolish(self.search)
        self.search.style().polish(self.search)
        return found

    def _on_find_edited(self) -> None:
        cursor = self.text.textCursor()
        cursor.setPosition(cursor.selectionStart())
        self.text.setTextCursor(cursor)
        self.find_next()

    def _on_save_clicked(self) -> None:
        place = Path.home() / self._path.name
        ask_for_path(self, tr("Save the log"), place, self.save_to, "save")

    def _on_folder_clicked(self) -> None:
        QDesktopServices.openUrl(QUrl.fromLocalFile(str(self._path.parent)))

    def _on_theme_changed(self) -> None:
        icons = {
            self.copy_button: "copy",
            self.save_button: "download",
            self.folder_button: "folder-open",
            self.close_button: "x",
        }
        for button, name in icons.items():
            button.setIcon(icon(name, self._look.theme))
        self.follow_button.setIcon(icon("arrow-down-to-line", self._look.theme.colour("link")))


def _lines_of(piece: Piece) -> list[str]:
    """The lines of a piece, with what has to be said about it."""
    lines = list(piece.lines)
    if piece.has_gap and lines:
        lines.insert(0, tr("— Some lines are left out here —"))
    if piece.is_new_log:
        lines.insert(0, tr("— The node has started anew —"))
    return lines


def _tool(words: str, *, tip: str) -> QToolButton:
    return labelled(QToolButton(), text=words, name=words, tip=tip)
