"""The dialog that lets a show start with the computer; it shows what is written, and where."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QHBoxLayout,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QVBoxLayout,
)

from nep_core.processes.process import program_command
from nep_studio.support import startup
from nep_studio.support.startup import Place, StartupFile, startup_files
from nep_studio.ui.theme.look import code_font
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.host import Host


class StartupDialog(QDialog):
    """Writes nothing until its button is pressed, and takes away what it wrote."""

    def __init__(self, host: Host, place: Place | None = None) -> None:
        super().__init__(host.widget)
        self.setWindowTitle(tr("Start with the computer"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._host, self._place = host, place or Place.here()
        document = host.services.document
        self.project: Path | None = document.path if document is not None else None
        self.runs_at_once = QCheckBox(tr("Run at once, without anybody pressing Run"))
        self.runs_at_once.setChecked(True)
        self.has_cues = QCheckBox(tr("With the cue buttons, for an operator"))
        self.state = QLabel()
        self.state.setWordWrap(True)
        self.text = QPlainTextEdit()
        self.text.setReadOnly(True)
        self.text.setAccessibleName(tr("What is written, and where"))
        self.text.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.text.setFont(code_font(self.font().pointSizeF()))
        self.text.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.write_button = QPushButton(tr("Write these files"))
        self.remove_button = QPushButton(tr("Remove these files"))
        self.close_button = QPushButton(tr("Close"))
        self._lay_out()
        self.runs_at_once.toggled.connect(self.refresh)
        self.has_cues.toggled.connect(self.refresh)
        self.write_button.clicked.connect(lambda: self._attempt(startup.write))
        self.remove_button.clicked.connect(lambda: self._attempt(startup.remove))
        self.close_button.clicked.connect(self.accept)
        self.refresh()

    @property
    def files(self) -> list[StartupFile]:
        """What would be written now."""
        words = ["show", str(self.project or "PROJECT.nep")]
        words += ["--run"] if self.runs_at_once.isChecked() else []
        words += ["--cues"] if self.has_cues.isChecked() else []
        return startup_files(self._place, program_command(*words))

    def refresh(self) -> None:
        """Show what would be written, and what is there."""
        files = self.files
        self.text.setPlainText("\n\n".join(f"{file.path}\n\n{file.text}" for file in files))
        is_there = any(file.is_there for file in files)
        is_same = all(file.is_as_written for file in files)
        self.write_button.setEnabled(self.project is not None and not is_same)
        self.remove_button.setEnabled(is_there)
        if self.project is None:
            words = tr("Save the project first: the computer has to find it.")
        elif is_same:
            words = tr("The show starts with the computer, as it is written here.")
        elif is_there:
            words = tr("Another show starts with the computer now. These files would replace it.")
        else:
            words = tr("Nothing starts with the computer yet. These files would be written:")
        self.state.setText(words)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        about = QLabel(
            tr(
                "The show starts when somebody logs in to this computer, and starts again if it "
                "ends by accident. To end it, leave the show and quit NEP Studio."
            )
        )
        about.setWordWrap(True)
        buttons = QHBoxLayout()
        buttons.addWidget(self.remove_button)
        buttons.addStretch(1)
        buttons.addWidget(self.close_button)
        buttons.addWidget(self.write_button)
        box = QVBoxLayout(self)
        box.setContentsMargins(line, line, line, line)
        for widget in (about, self.runs_at_once, self.has_cues, self.state):
            box.addWidget(widget)
        box.addWidget(self.text, 1)
        box.addLayout(buttons)
        self.resize(line * 42, line * 34)

    def _attempt(self, do: Callable[[list[StartupFile]], None]) -> None:
        try:
            do(self.files)
        except OSError as error:
            self.refresh()
            reason = tr((error.strerror or str(error)).lower())
            self.state.setText(tr("That did not work. The computer says: {reason}.", reason=reason))
            return
        self.refresh()
