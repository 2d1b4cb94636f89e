"""Blocks on the clipboard: as a project for NEP Studio, as Python for everybody else."""

from __future__ import annotations

import atexit
from collections.abc import Iterable

from PySide6.QtCore import QMimeData
from PySide6.QtGui import QGuiApplication

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import BlocksError, CodeRefused, EditRefused
from nep_studio.blocks.from_python.reading_programs import read_snippet
from nep_studio.blocks.operations.copying import Clip, copy, from_text, to_text
from nep_studio.blocks.operations.to_python import python_of
from nep_studio.ui.words import tr

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
    if clipboard is not None and clipboard.mimeData().hasFormat(BLOCKS):
        clipboard.setText(clipboard.text())


def clip_from_clipboard(editor: Editor) -> Clip:
    """What is on the clipboard as blocks; raises EditRefused when it is none."""
    data = QGuiApplication.clipboard().mimeData()
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
        return read_snippet(text, editor.language, editor.project)
    except BlocksError as error:
        raise EditRefused(error.sentence, checklist=error.checklist) from error
