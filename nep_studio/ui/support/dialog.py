"""The report for support: all that is in it can be read before it is copied or saved."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from PySide6.QtCore import QProcess, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import (
    QDialog,
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from nep_core.process import program_command
from nep_studio.settings import usual_folder
from nep_studio.support_report import FILE, Report, report_of
from nep_studio.ui.screens import room_around
from nep_studio.ui.theme import code_font
from nep_studio.ui.words import count_words, tr

COLUMNS, LINES = 88, 26
"""The size of the preview, in letters of code and lines."""


class SupportDialog(QDialog):
    """Lets ``nep-studio doctor`` make the report, in a process of its own, and shows it all."""

    def __init__(self, parent: QWidget | None, folder: Path | None = None) -> None:
        super().__init__(parent)
        self._folder = folder or usual_folder("projects")
        self.report: Report | None = None
        self.setWindowTitle(tr("Report for support"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, parent is not None)
        self.state = QLabel()
        self.state.setWordWrap(True)
        self.preview = QPlainTextEdit()
        self.preview.setReadOnly(True)
        self.preview.setAccessibleName(tr("All that is in the report"))
        self.preview.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.preview.setFont(code_font(self.font().pointSizeF()))
        self.preview.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.copy_button = QPushButton(tr("Copy"))
        self.save_button = QPushButton(tr("Save…"))
        self.close_button = QPushButton(tr("Close"))
        self._lay_out()
        self.copy_button.clicked.connect(self._on_copy)
        self.save_button.clicked.connect(self._on_save)
        self.close_button.clicked.connect(self.reject)
        self._process = QProcess(self)
        self._process.finished.connect(self._on_finished)
        self._process.errorOccurred.connect(self._on_error)
        self._begin()

    def done(self, result: int) -> None:
        """End what still looks at the computer; nobody reads it."""
        with suppress(RuntimeError, TypeError):
            self._process.finished.disconnect(self._on_finished)
            self._process.errorOccurred.disconnect(self._on_error)
        if self._process.state() != QProcess.ProcessState.NotRunning:
            self._process.kill()
            self._process.waitForFinished(2000)
        super().done(result)

    def save(self, path: Path) -> None:
        """Write the report, and say where it is."""
        if self.report is None:
            return
        try:
            self.report.save(path)
        except OSError as error:
            reason = tr((error.strerror or str(error)).lower())
            told = tr("{name}: {reason}.", name=path.name, reason=reason)
            self.state.setText(f"{told} {tr('Choose another folder.')}")
            return
        self.state.setText(tr("The report is in “{name}”. Send it yourself.", name=path.name))

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        about = QLabel(
            tr(
                "This tells those who help you what they need to know. NEP Studio sends it to"
                " nobody: read it, then copy or save it, and send it yourself."
            )
        )
        about.setWordWrap(True)
        buttons = QHBoxLayout()
        buttons.addWidget(self.state, 1)
        for button in (self.copy_button, self.save_button, self.close_button):
            button.setAutoDefault(False)
            buttons.addWidget(button)
        self.save_button.setProperty("kind", "primary")
        box = QVBoxLayout(self)
        box.setContentsMargins(line, line, line, line)
        box.setSpacing(line // 2)
        box.addWidget(about)
        box.addWidget(self.preview, 1)
        box.addLayout(buttons)
        letter = self.preview.fontMetrics()
        room = room_around(self.parentWidget())
        width = min(letter.averageCharWidth() * COLUMNS, room.width())
        height = min(letter.lineSpacing() * LINES, room.height() * 3 // 4)
        self.resize(width + 2 * line, height + 6 * line)

    def _begin(self) -> None:
        self._show_buttons()
        self.state.setText(tr("Looking at this computer…"))
        program, *arguments = program_command("doctor", "--json")
        self._process.start(program, arguments)
        self._process.closeWriteChannel()

    def _on_finished(self) -> None:
        try:
            self.report = report_of(bytes(self._process.readAllStandardOutput().data()))
        except ValueError:
            self._tell_failure(
                bytes(self._process.readAllStandardError().data()).decode(errors="replace")
            )
            return
        self.preview.setPlainText(self.report.text())
        looks = [one for part in self.report.parts for one in part.findings if one.state == "look"]
        sound = tr("Nothing of what was checked is wrong.")
        self.state.setText(
            count_words(len(looks), "1 thing to look at", "{n} things to look at")
            if looks
            else sound
        )
        self._show_buttons()

    def _on_error(self, error: QProcess.ProcessError) -> None:
        if error == QProcess.ProcessError.FailedToStart:
            self._tell_failure(self._process.errorString())

    def _tell_failure(self, details: str) -> None:
        from nep_studio.anonymous import Anonymous

        self.preview.setPlainText(Anonymous.here().text(details))
        self.state.setText(tr("The report could not be made. What is shown here may help too."))
        self.copy_button.setEnabled(True)

    def _show_buttons(self) -> None:
        for button in (self.copy_button, self.save_button):
            button.setEnabled(self.report is not None)

    def _on_copy(self) -> None:
        QGuiApplication.clipboard().setText(self.preview.toPlainText())
        self.state.setText(tr("The report is copied. Paste it into a message."))

    def _on_save(self) -> None:
        dialog = QFileDialog(self, tr("Save as"), str(self._folder))
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix("zip")
        dialog.selectFile(FILE)
        dialog.fileSelected.connect(lambda chosen: self.save(Path(chosen)))
        dialog.open()
