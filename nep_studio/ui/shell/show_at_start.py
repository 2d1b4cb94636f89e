"""The switch that lets a show start with the computer, and shows what that writes, and where."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtWidgets import QCheckBox, QDialog, QPlainTextEdit, QPushButton, QWidget

from faults import Text, text_of
from nep_core.processes.process import program_command
from nep_studio.support import startup
from nep_studio.support.startup import Place, StartupFile, startup_files
from nep_studio.ui.labels import labelled
from nep_studio.ui.theme.look import code_font
from nep_studio.ui.widgets.forms import fit_on_screen, plain_label
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

RUN = "--run"


class ShowAtStart(QWidget):
    """One switch: on writes the files, off takes them away; ``project`` is what is to be shown."""

    def __init__(self, place: Place, project: Path | None) -> None:
        super().__init__()
        self._place, self.project = place, project
        self.switch = labelled(
            QCheckBox(),
            text="Start this show with the computer",
            tip="The show starts when somebody logs in to this computer, and starts again if it"
            " ends by accident. To end it, leave the show and quit NEP Studio.",
        )
        self.runs_at_once = labelled(QCheckBox(), text="Run at once, without anybody pressing Run")
        self.details_button = labelled(QPushButton(autoDefault=False), text="What is written…")
        self.state = plain_label()
        self.runs_at_once.setChecked(not self._is_written(runs_at_once=False))
        line = self.fontMetrics().height()
        inner = in_row(self.runs_at_once, 1)
        inner.setContentsMargins(line, 0, 0, 0)
        state = in_row((self.state, 1), self.details_button)
        in_column(self.switch, inner, state, of=self, margins=0)
        self.switch.clicked.connect(self._on_switched)
        self.runs_at_once.clicked.connect(self._on_chosen)
        self.details_button.clicked.connect(lambda: FilesDialog(self.files, self).open())
        self.refresh()

    @property
    def files(self) -> list[StartupFile]:
        """What would be written now."""
        return self._files(self.runs_at_once.isChecked())

    def refresh(self) -> None:
        """Show what would be written, and what is there."""
        files = self.files
        is_there = any(file.is_there for file in files)
        with QSignalBlocker(self.switch):
            self.switch.setChecked(is_there)
        self.switch.setEnabled(is_there or self.project is not None)
        self.runs_at_once.setEnabled(self.project is not None)
        if is_there and all(file.is_as_written for file in files):
            labelled(self.state, text="The show starts with the computer.")
        elif is_there:
            labelled(
                self.state,
                text="Another show starts with the computer: off and on again makes it this one.",
            )
        elif self.project is None:
            labelled(self.state, text="Save the project first: the computer has to find it.")
        else:
            labelled(self.state, text="Nothing starts with the computer yet.")

    def _files(self, runs_at_once: bool) -> list[StartupFile]:
        words = ["show", str(self.project or "PROJECT.nep"), *([RUN] if runs_at_once else [])]
        return startup_files(self._place, program_command(*words))

    def _is_written(self, *, runs_at_once: bool) -> bool:
        return all(file.is_as_written for file in self._files(runs_at_once))

    def _on_switched(self, is_on: bool) -> None:
        self._attempt(startup.write if is_on else startup.remove)

    def _on_chosen(self, runs_at_once: bool) -> None:
        """What this show does changes at once where it starts with the computer."""
        if self._is_written(runs_at_once=not runs_at_once):
            self._attempt(startup.write)
        else:
            self.refresh()

    def _attempt(self, do: Callable[[list[StartupFile]], None]) -> None:
        try:
            do(self.files)
        except OSError as error:
            reason = Text((error.strerror or str(error)).lower())
            self.refresh()
            labelled(
                self.state,
                text=text_of("That did not work. The computer says: {reason}.", reason=reason),
            )
            return
        self.refresh()


class FilesDialog(QDialog):
    """What is written when the switch is on, to be read."""

    def __init__(self, files: list[StartupFile], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("What is written, and where"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        told = "\n\n".join(f"{file.path}\n\n{file.text}" for file in files)
        self.text = QPlainTextEdit(told, readOnly=True)
        self.text.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.text.setAccessibleName(self.windowTitle())
        self.text.setFont(code_font(self.font().pointSizeF()))
        self.text.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        close = QPushButton(tr("Close"), default=True)
        close.clicked.connect(self.accept)
        line = self.fontMetrics().height()
        in_column((self.text, 1), in_row(1, close), of=self, margins=line)
        fit_on_screen(self, 40, 24)
