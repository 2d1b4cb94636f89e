"""The actions that bring a program out of the studio, for the File menu."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtGui import QAction, QKeySequence

from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.generate.program import generate_program
from nep_studio.ui.words import tr

from .python import choose_python_file, copy_python

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow

NEEDS_PROJECT = ("save_python", "copy_python", "print")
"""These can be used while a project is open."""


def add_exporting(window: MainWindow) -> list[QAction]:
    """Make the actions; they stand in the File menu after the picture."""
    add = window.actions_by_name.add
    return [
        add(
            "save_python",
            tr("Save the Python…"),
            lambda: choose_python_file(window),
            icon_name="file-code",
        ),
        add("copy_python", tr("Copy the Python"), lambda: copy_python(window), icon_name="code"),
        add(
            "print",
            tr("Print…"),
            lambda: print_dialog(window),
            icon_name="printer",
            keys=QKeySequence.StandardKey.Print,
        ),
    ]


def print_dialog(window: MainWindow) -> None:
    """Ask what is printed."""
    from .print_dialog import ProgramPrintDialog  # printers are looked for only now

    document = window.files.document
    if document is None:
        return
    try:
        code = generate_program(document.project, document.editor.language).text
    except BlocksError:
        code = ""
    ProgramPrintDialog(window.workbench.canvas, code, window).open()
