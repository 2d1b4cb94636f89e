"""Programs on their way out of the studio: as Python files and on paper."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from PySide6.QtGui import QGuiApplication, QKeySequence

from faults.files import as_file_name, whole_file
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.generate.program import generate_program
from nep_studio.run.python_file import SUFFIX, python_file, write_kept
from nep_studio.ui.documents import Document
from nep_studio.ui.host import Host, NewAction, Parts, Plugin
from nep_studio.ui.messages import Message
from nep_studio.ui.widgets.questions import ask_for_path, name_what_is_printed
from nep_studio.ui.words import tr

# Save the Python of the open project as a file, and copy it.


def choose_python_file(host: Host) -> None:
    """Ask where the Python is to be saved, and save it there."""
    document = host.services.document
    if document is None or python_text(host, document, "") is None:
        return
    folder = document.folder if document.path is not None else host.services.settings.last_folder
    kinds = (tr("Python programs (*.py)"), tr("All files (*)"))
    suggested, title = folder / _file_name(document), tr("Save the Python as")
    save = partial(save_python, host)
    ask_for_path(host.widget, title, suggested, save, "save", kinds)


def save_python(host: Host, path: Path) -> bool:
    """Write the Python of the open project; whether that went well, which the person is told."""
    document = host.services.document
    text = python_text(host, document, path.name) if document is not None else None
    if document is None or text is None:
        return False
    try:
        write_kept(document.project, document.editor.language, path)
        with whole_file(path) as file:
            file.write(text.encode())
    except OSError as error:
        reason = tr((error.strerror or str(error)).lower())
        sentence = tr("The computer says: {reason}.", reason=reason)
        steps = (tr("Is there room on the disk?"), tr("Choose another folder."))
        title = tr("The Python could not be saved")
        host.services.messages.tell(Message("error", title, sentence, steps, str(error)))
        return False
    words = tr("Saved “{name}”. At its top it says how to run it.", name=path.name)
    host.services.messages.confirm(words)
    return True


def copy_python(host: Host) -> bool:
    """Put the Python of the open project on the clipboard."""
    document = host.services.document
    text = python_text(host, document) if document is not None else None
    if text is None:
        return False
    QGuiApplication.clipboard().setText(text)
    host.services.messages.confirm(tr("The Python is copied. Paste it where you like."))
    return True


def python_text(host: Host, document: Document, file_name: str = "") -> str | None:
    """The Python of a project with its comment; None, told, when the blocks make none yet."""
    name = file_name or _file_name(document)
    try:
        return python_file(document.project, document.editor.language, document.folder, name)
    except BlocksError as error:
        host.services.messages.tell_error(error)
        return None


def _file_name(document: Document) -> str:
    """A name that every system and Python itself can take."""
    letters = [letter if letter.isalnum() else "_" for letter in document.title.casefold()]
    return ("".join(letters).strip("_") or "program") + SUFFIX


# The actions that bring a program out of the studio, in the File menu after the picture.


def make(host: Host) -> Parts:
    """The actions; the picture has its own in the File menu, which is there before."""
    actions = [
        NewAction(
            "save_python",
            "Save the Python…",
            lambda: choose_python_file(host),
            "file-code",
            menu="file",
            after="picture",
        ),
        NewAction(
            "copy_python",
            "Copy the Python",
            lambda: copy_python(host),
            "code",
            menu="file",
            after="save_python",
        ),
        NewAction(
            "print",
            "Print…",
            lambda: open_print_dialog(host),
            "printer",
            QKeySequence.StandardKey.Print,
            menu="file",
            after="copy_python",
        ),
    ]
    return Parts(actions=actions, commands={"exporting.picture": lambda: export_picture(host)})


def export_picture(host: Host) -> None:
    """Ask for a picture of the blocks."""
    from .picture import PictureDialog

    document = host.services.document
    if document is not None:
        folder = document.path.parent if document.path else host.services.settings.last_folder
        name = as_file_name(document.title)
        dialog = PictureDialog(host.workbench.canvas, folder, name, host.widget)
        dialog.done_well.connect(host.services.messages.confirm)
        dialog.open()


def open_print_dialog(host: Host) -> None:
    """Ask what is printed."""
    from .print_dialog import ProgramPrintDialog  # printers are looked for only now

    document = host.services.document
    if document is None:
        return
    try:
        code = generate_program(document.project, document.editor.language).text
    except BlocksError:
        code = ""
    dialog = ProgramPrintDialog(host.workbench.canvas, code, host.widget)
    name_what_is_printed(dialog.printer, document.title)
    dialog.done_well.connect(host.services.messages.confirm)
    dialog.open()


plugin = Plugin("exporting", make, order=90, needs_project=True)
