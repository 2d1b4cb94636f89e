"""What menus, buttons and keys do with the selected blocks of a canvas."""

from __future__ import annotations

import atexit
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Literal

from PySide6.QtCore import QMimeData, QPointF
from PySide6.QtGui import QGuiApplication

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import BlocksError, CodeRefused, EditRefused
from nep_studio.blocks.operations.copying import (
    Clip,
    copy,
    delete,
    duplicate,
    from_text,
    paste,
    python_of,
    to_text,
)
from nep_studio.blocks.operations.moving import tidy
from nep_studio.blocks.operations.wrapping import Flag, toggle
from nep_studio.ui.words import count_words, tr

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


# Blocks on the clipboard: as a project for NEP Studio, as Python for everybody else.

BLOCKS = "application/x-nep-studio-blocks"
"""The MIME type of blocks; their text is that of a project file."""


def put_on_clipboard(editor: Editor, ids: Iterable[str]) -> None:
    """Copy blocks to the clipboard of the system."""
    ids = list(ids)
    text = to_text(copy(editor.project, editor.language, ids))
    data = QMimeData()
    data.setData(BLOCKS, text.encode())
    try:
        data.setText(python_of(editor.project, editor.language, ids))
    except CodeRefused:
        data.setText(text)  # blocks that make no code yet can still be kept as text
    QGuiApplication.clipboard().setMimeData(data)
    atexit.unregister(_keep_text_only)
    atexit.register(_keep_text_only)


def _keep_text_only() -> None:
    """At the end of the program, leave a plain text on the clipboard.

    WORKAROUND: PySide 6.11 crashes when data made in Python is on the clipboard after Python has
    gone.
    """
    clipboard = QGuiApplication.clipboard() if QGuiApplication.instance() is not None else None
    data = clipboard.mimeData() if clipboard is not None else None
    if clipboard is not None and data is not None and data.hasFormat(BLOCKS):
        clipboard.setText(clipboard.text())


def clip_from_clipboard(editor: Editor) -> Clip:
    """What is on the clipboard as blocks; raises EditRefused when it is none."""
    data = QGuiApplication.clipboard().mimeData()
    if data is None:  # nothing was copied since the computer started
        return clip_of_text(editor, "")
    if data.hasFormat(BLOCKS):
        return clip_of_text(editor, bytes(data.data(BLOCKS).data()).decode(errors="replace"))
    return clip_of_text(editor, data.text())


def clip_of_text(editor: Editor, text: str) -> Clip:
    """Read blocks from the text of a project or from Python; raises EditRefused."""
    if not text.strip():
        raise EditRefused(
            tr("There is nothing on the clipboard that can become blocks."),
            checklist=(tr("Copy blocks, or lines of Python, first."),),
        )
    try:
        if text.lstrip().startswith("{"):
            return from_text(text, editor.language)
        from nep_studio.blocks.from_python.pasting import read_snippet

        return read_snippet(text, editor.language, editor.project)
    except BlocksError as error:
        raise EditRefused(error.sentence, checklist=error.checklist) from error


PASTE_STEP = 32.0
"""How far from the corner of the view pasted blocks lie, in canvas units."""


class Commands:
    """The commands of one canvas; each is one step of undo, and each is announced."""

    def __init__(self, canvas: CanvasHost) -> None:
        self._canvas = canvas

    def copy(self) -> bool:
        """Put the selected blocks on the clipboard; False when there are none."""
        canvas, ids = self._canvas, self._canvas.selection.ids
        if not ids:
            return False
        put_on_clipboard(canvas.editor, ids)
        canvas.news.announced.emit(count_words(len(ids), "1 block copied", "{n} blocks copied"))
        return True

    def cut(self) -> bool:
        """Copy the selected blocks, and take them away."""
        return self.copy() and self.delete()

    def paste(self, at: QPointF | None = None) -> bool:
        """Put what is on the clipboard on the page, at a place of it or where the person looks."""
        canvas = self._canvas
        where = at or self._free_place()

        def change() -> Iterable[str]:
            clip = clip_from_clipboard(canvas.editor)
            return paste(canvas.editor, clip, canvas.page_layout.page, where.x(), where.y())

        return self._make(change, tr("pasted"))

    def duplicate(self) -> bool:
        """Put copies of the selected blocks beside them."""
        canvas, ids = self._canvas, self._canvas.selection.ids
        if not ids:
            return False
        return self._make(
            lambda: duplicate(canvas.editor, ids, canvas.page_layout.corners(ids)), tr("copied")
        )

    def delete(self) -> bool:
        """Take the selected blocks away; those below move up."""
        canvas, ids = self._canvas, self._canvas.selection.ids
        if not ids:
            return False
        following = _neighbour(canvas, ids)

        def change() -> None:
            canvas.news.blocks_deleted.emit(delete(canvas.editor, ids))

        if not canvas.attempt(change):
            return False
        canvas.selection.set([following] if following else ())
        canvas.news.announced.emit(count_words(len(ids), "1 block deleted", "{n} blocks deleted"))
        return True

    def toggle(self, flag: Flag) -> bool:
        """Switch the selected blocks off or on, or fold or unfold them."""
        canvas, ids = self._canvas, self._canvas.selection.ids
        if not ids:
            return False
        return canvas.attempt(lambda: toggle(canvas.editor, ids, flag))

    def select_all(self) -> None:
        """Select every stack of the page."""
        project, page = self._canvas.editor.project, self._canvas.page_layout.page
        chains = (stack.body for stack in project.pages.get(page, []))
        self._canvas.selection.set([block for chain in chains for block in chain])

    def select_stack(self) -> None:
        """Select all blocks of the stack that the keyboard is at."""
        canvas = self._canvas
        cursor = canvas.selection.cursor
        if cursor in canvas.editor.project.blocks:
            canvas.selection.set(canvas.editor.project.stack_of(cursor).body, cursor)

    def undo(self) -> None:
        """Take the last step back; blocks that come back by it are selected."""
        history, label = self._canvas.editor.history, self._canvas.editor.history.undo_label
        if self._step(history.undo):
            self._canvas.news.announced.emit(tr("undone: {step}", step=tr(label)))

    def redo(self) -> None:
        """Do the step again that was taken back last; blocks that come back are selected."""
        history, label = self._canvas.editor.history, self._canvas.editor.history.redo_label
        if self._step(history.redo):
            self._canvas.news.announced.emit(tr("done again: {step}", step=tr(label)))

    def tidy(self, *, columns: bool = False) -> bool:
        """Push stacks apart that overlap, or put all into columns; their order stays."""
        canvas = self._canvas
        sizes = {
            stack: (canvas.page_layout.index.rects[stack].width, chain.height)
            for stack, chain in canvas.page_layout.chains.items()
        }
        align: Literal["", "columns"] = "columns" if columns else ""
        is_mirrored = canvas.look.measures.is_mirrored
        return canvas.attempt(
            lambda: tidy(
                canvas.editor, canvas.page_layout.page, sizes, align=align, is_mirrored=is_mirrored
            )
        )

    def _step(self, step: Callable[[], bool]) -> bool:
        """Go one step back or forth, and select the blocks that this brings to the page."""
        project = self._canvas.editor.project
        before = set(project.blocks)
        if not step():
            return False
        back = [block for block in project.blocks if block not in before]
        came = set(back)
        outer = [block for block in back if project.parents[block].owner not in came]
        here = {stack.id for stack in project.pages.get(self._canvas.page_layout.page, [])}
        if outer and all(project.stack_of(block).id in here for block in outer):
            self._canvas.selection.set(outer)
        return True

    def _make(self, change: Callable[[], Iterable[str]], told: str) -> bool:
        """Make blocks, select them and show the first."""
        made: list[str] = []
        if not self._canvas.attempt(lambda: made.extend(change())) or not made:
            return False
        self._canvas.selection.set(made)
        self._canvas.show_block(made[0])
        self._canvas.news.announced.emit(told)
        return True

    def _free_place(self) -> QPointF:
        """Near the upper corner of the view, where no stack is."""
        canvas = self._canvas
        seen, layout = canvas.sight.visible_page_rect(), canvas.page_layout
        side = -PASTE_STEP if canvas.look.measures.is_mirrored else PASTE_STEP
        x = (seen.right if canvas.look.measures.is_mirrored else seen.x) + side
        y = seen.y + PASTE_STEP
        while layout.hit(x + side / 4, y + PASTE_STEP / 2) is not None and y < seen.bottom:
            x, y = x + side, y + PASTE_STEP
        return QPointF(x, y)


def _neighbour(canvas: CanvasHost, ids: Iterable[str]) -> str:
    """The block that the keyboard goes to when these go: the next, the one above, the owner."""
    gone, project = set(ids), canvas.editor.project
    first = next(iter(gone), "")
    if first not in project.parents:
        return ""
    parent = project.parents[first]
    chain = project.chain_of(parent) or []
    index = chain.index(first) if first in chain else 0
    after = [block for block in chain[index + 1 :] if block not in gone]
    before = [block for block in chain[:index] if block not in gone]
    near = after[:1] or before[-1:] or [parent.owner]
    return near[0] if near[0] in project.blocks else ""
