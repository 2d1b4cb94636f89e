"""Programs on their way out of the studio: as Python files and on paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtGui import QAction, QGuiApplication, QKeySequence
from PySide6.QtWidgets import QFileDialog

from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.generate.program import generate_program
from nep_studio.run.python_file import SUFFIX, python_file, write_kept
from nep_studio.ui.documents import Document
from nep_studio.ui.messages import Message
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.shell.main_window import MainWindow


# Save the Python of the open project as a file, and copy it.


def choose_python_file(window: MainWindow) -> None:
    """Ask where the Python is to be saved, and save it there."""
    document = window.files.document
    if document is None or python_text(window, document, "") is None:
        return
    folder = document.folder if document.path is not None else window.settings.last_folder
    dialog = QFileDialog(window, tr("Save the Python as"), str(folder))
    dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
    dialog.setNameFilters([tr("Python programs (*.py)"), tr("All files (*)")])
    dialog.setDefaultSuffix(SUFFIX.removeprefix("."))
    dialog.selectFile(_file_name(document))
    dialog.fileSelected.connect(lambda name: save_python(window, Path(name)))
    dialog.open()


def save_python(window: MainWindow, path: Path) -> bool:
    """Write the Python of the open project; whether that went well, which the person is told."""
    document = window.files.document
    text = python_text(window, document, path.name) if document is not None else None
    if text is None:
        return False
    beside = path.with_name(f".{path.name}.part")
    try:
        if document is not None:
            write_kept(document.project, document.editor.language, path)
        beside.write_text(text, encoding="utf-8")
        beside.replace(path)
    except OSError as error:
        beside.unlink(missing_ok=True)
        window.messages.tell(_not_written(error))
        return False
    window.messages.confirm(tr("Saved “{name}”. At its top it says how to run it.", name=path.name))
    return True


def copy_python(window: MainWindow) -> bool:
    """Put the Python of the open project on the clipboard."""
    document = window.files.document
    text = python_text(window, document) if document is not None else None
    if text is None:
        return False
    QGuiApplication.clipboard().setText(text)
    window.messages.confirm(tr("The Python is copied. Paste it where you like."))
    return True


def python_text(window: MainWindow, document: Document, file_name: str = "") -> str | None:
    """The Python of a project with its comment; None, told, when the blocks make none yet."""
    name = file_name or _file_name(document)
    try:
        return python_file(document.project, document.editor.language, document.folder, name)
    except BlocksError as error:
        window.messages.tell_error(error)
        return None


def _file_name(document: Document) -> str:
    """A name that every system and Python itself can take."""
    letters = [letter if letter.isalnum() else "_" for letter in document.title.casefold()]
    return ("".join(letters).strip("_") or "program") + SUFFIX


def _not_written(error: OSError) -> Message:
    return Message(
        "error",
        tr("The Python could not be saved"),
        tr("The computer says: {reason}.", reason=tr((error.strerror or str(error)).lower())),
        (tr("Is there room on the disk?"), tr("Choose another folder.")),
        str(error),
    )


# The actions that bring a program out of the studio, for the File menu.

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
            lambda: open_print_dialog(window),
            icon_name="printer",
            keys=QKeySequence.StandardKey.Print,
        ),
    ]


def open_print_dialog(window: MainWindow) -> None:
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
