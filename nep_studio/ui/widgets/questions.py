"""A small window that asks for a name, or whether something is to be done."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QFileDialog, QFrame, QWidget

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


# Asks where a text is to be kept, and tells when it cannot be.


def save_text(
    window: QWidget,
    messages: Messages,
    name: str,
    save: Callable[[Path], object],
    then: Callable[[Path], object] | None = None,
) -> QFileDialog:
    """Ask for a file, first called ``name``, and ``save`` it; ``then`` follows when it is there."""
    dialog = QFileDialog(window, tr("Save as"), str(usual_folder("projects")))
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
    dialog.setDefaultSuffix(Path(name).suffix.removeprefix("."))
    dialog.selectFile(name)

    def on_chosen(chosen: str) -> None:
        path = Path(chosen)
        if _is_saved(messages, path, save) and then is not None:
            then(path)

    dialog.fileSelected.connect(on_chosen)
    dialog.open()
    return dialog


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
