"""A small window that asks for a name, or whether something is to be done."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QFileDialog, QFrame, QWidget

from faults.files import as_file_name
from nep_studio.blocks.errors import EditRefused
from nep_studio.problems import Problem
from nep_studio.settings import usual_folder
from nep_studio.ui.canvas.fields.field_edit import ReasonBubble
from nep_studio.ui.canvas.fields.popup import Question
from nep_studio.ui.messages import Message, Messages
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr

from .forms import room_around

if TYPE_CHECKING:
    from PySide6.QtPrintSupport import QPrinter


class Asking(QFrame):
    """Asks over a widget; what the answer does may refuse it, and the window says why."""

    def __init__(
        self,
        over: QWidget,
        theme: Theme,
        words: str,
        yes: str,
        answer: Callable[[str], object],
        name: str | None = None,
    ) -> None:
        super().__init__(over, Qt.WindowType.Popup)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setAccessibleName(words)
        self.setObjectName("asking")
        self.setStyleSheet(
            f"#asking {{ background: {theme.colour('menu').name()};"
            f" border: 1px solid {theme.colour('field_line').name()}; }}"
        )
        self._answer = answer
        self.question = Question(
            words, yes, answered=self._on_answered, refused=self._on_refused, name=name
        )
        self.reason = ReasonBubble(theme, self)
        in_column(self.question, self.reason, of=self)
        self.setMinimumWidth(self.fontMetrics().averageCharWidth() * 38)

    def show_at(self, place: QPoint) -> None:
        """Show at a place of the screen, inside the screen."""
        self.adjustSize()
        room = room_around(self.parentWidget())
        x = min(max(place.x(), room.left()), room.right() - self.width())
        y = min(max(place.y(), room.top()), room.bottom() - self.height())
        self.move(x, y)
        self.show()
        self.question.first().setFocus(Qt.FocusReason.PopupFocusReason)

    def _on_refused(self) -> None:
        self.close()

    def _on_answered(self, name: str) -> None:
        try:
            self._answer(name)
        except EditRefused as refusal:
            self.reason.tell(refusal.sentence)
            self.adjustSize()
            return
        self.close()


# Asks for files and folders, and where a text is to be kept; tells when it cannot be.


def ask_for_path(
    parent: QWidget,
    title: str,
    start: Path,
    on_chosen: Callable[[Path], object],
    mode: Literal["open", "save", "folder"] = "open",
    kinds: Sequence[str] = (),
) -> QFileDialog:
    """Ask with the system's dialog for a file to open or to save, or for a folder.

    ``start`` is the folder where one begins to look; of a file to save it is the suggestion.
    ``kinds`` are such as "Recordings (*.csv)". Nothing is called when the person thinks better.
    """
    is_save = mode == "save"
    dialog = QFileDialog(parent, title, str(start.parent if is_save else start))
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    if kinds:
        dialog.setNameFilters(list(kinds))
    if is_save:
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix(start.suffix.removeprefix("."))
        dialog.selectFile(start.name)
    elif mode == "folder":
        dialog.setFileMode(QFileDialog.FileMode.Directory)
        dialog.setOption(QFileDialog.Option.ShowDirsOnly)
    else:
        dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
    dialog.fileSelected.connect(lambda name: on_chosen(Path(name)))
    dialog.open()
    return dialog


def name_what_is_printed(printer: QPrinter, title: str) -> None:
    """Name it for who waits at the printer; where there is none, name the file that is made.

    Without a name Qt's dialog offers a folder, and refuses it.
    """
    printer.setDocName(title)
    if printer.outputFormat() == printer.OutputFormat.PdfFormat and not printer.outputFileName():
        folder = usual_folder("projects")
        place = folder if folder.is_dir() else Path.home()
        printer.setOutputFileName(str(place / f"{as_file_name(title)}.pdf"))


def save_text(
    window: QWidget,
    messages: Messages,
    name: str,
    save: Callable[[Path], object],
    then: Callable[[Path], object] | None = None,
) -> QFileDialog:
    """Ask for a file, first called ``name``, and ``save`` it; ``then`` follows when it is there."""

    def on_chosen(path: Path) -> None:
        if _is_saved(messages, path, save) and then is not None:
            then(path)

    return ask_for_path(window, tr("Save as"), usual_folder("projects") / name, on_chosen, "save")


def _is_saved(messages: Messages, path: Path, save: Callable[[Path], object]) -> bool:
    try:
        save(path)
    except OSError as error:
        reason = tr((error.strerror or str(error)).lower())
        steps = (tr("Is there room on the disk?"), tr("May you write into this folder?"))
        words = tr("{name}: {reason}.", name=path.name, reason=reason)
        title = tr("The file could not be saved")
        messages.tell(Message("error", title, words, steps, str(error)))
        return False
    return True


def tell_not_saved(messages: Messages, path: str, reason: str) -> None:
    """Say that a file could not be written, and what to try."""
    why = tr(reason.lower())
    sentence = tr("The file {path} could not be written: {reason}.", path=path, reason=why)
    steps = ("Choose another folder.", "Is there room on the disk?")
    messages.tell_problem(Problem("The file was not saved", sentence, steps))
