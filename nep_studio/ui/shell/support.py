"""The report for support: all that is in it can be read before it is copied or saved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QDateTime, QLocale, QProcess, QSize, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import (
    QDialog,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QMessageBox,
    QPlainTextEdit,
    QPushButton,
    QWidget,
)

from nep_studio import settings
from nep_studio.blocks.editor import Editor
from nep_studio.project.journal import Recoverable
from nep_studio.settings import usual_folder
from nep_studio.support import portable, safe_mode
from nep_studio.support.updates import UpdateChoice
from nep_studio.ui import words
from nep_studio.ui.canvas.block_pictures import picture_of
from nep_studio.ui.labels import plain_tip
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.services import Studio
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import code_font, load_fonts
from nep_studio.ui.widgets.forms import fit_on_screen, hint, plain_label, styled
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.widgets.questions import ask_for_path
from nep_studio.ui.words import count_words, is_right_to_left, tr
from nep_studio.ui.workbench.workbench import block_font

from .dialogs import show_report

if TYPE_CHECKING:
    from nep_studio.support.report import Report

    from .main_window import MainWindow


COLUMNS, LINES = 88, 26
"""The size of the preview, in letters of code and lines."""


class SupportDialog(QDialog):
    """Lets ``nep-studio doctor`` make the report, in a process of its own, and shows it all."""

    def __init__(self, parent: QWidget | None, folder: Path | None = None) -> None:
        from nep_studio.support.report import FILE  # each start looks into this module

        super().__init__(parent)
        self._suggested = (folder or usual_folder("projects")) / FILE
        self.report: Report | None = None
        self.setWindowTitle(tr("Report for support"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, parent is not None)
        self.state = plain_label()
        self.preview = QPlainTextEdit(readOnly=True)
        self.preview.setAccessibleName(tr("All that is in the report"))
        self.preview.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.preview.setFont(code_font(self.font().pointSizeF()))
        self.preview.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.copy_button = QPushButton(tr("Copy"), autoDefault=False)
        self.save_button = styled(QPushButton(tr("Save…"), autoDefault=False), kind="primary")
        self.close_button = QPushButton(tr("Close"), autoDefault=False)
        self._lay_out()
        self.copy_button.clicked.connect(self._on_copy)
        self.save_button.clicked.connect(self._on_save)
        self.close_button.clicked.connect(self.reject)
        self._process = QProcess(self)
        self._process.finished.connect(self._on_finished)
        self._process.errorOccurred.connect(self._on_error)
        self._show_buttons()
        self.state.setText(tr("Looking at this computer…"))
        from nep_core.processes.process import program_command  # each start looks into this module

        program, *arguments = program_command("doctor", "--json")
        self._process.start(program, arguments)
        self._process.closeWriteChannel()

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
        about = tr(
            "This tells those who help you what they need to know. NEP Studio sends it to"
            " nobody: read it, then copy or save it, and send it yourself."
        )
        told = QLabel(about, wordWrap=True)
        buttons = in_row((self.state, 1), self.copy_button, self.save_button, self.close_button)
        in_column(told, (self.preview, 1), buttons, of=self, margins=line, spacing=line // 2)
        letter = self.preview.fontMetrics()
        width = letter.averageCharWidth() * COLUMNS + 2 * line
        height = letter.lineSpacing() * LINES + 6 * line
        fit_on_screen(self, width / line, height / line)

    def _on_finished(self) -> None:
        from nep_studio.support.report import report_of

        try:
            self.report = report_of(bytes(self._process.readAllStandardOutput().data()))
        except ValueError:
            self._tell_failure(
                bytes(self._process.readAllStandardError().data()).decode(errors="replace")
            )
            return
        self.preview.setPlainText(self.report.text())
        looks = [one for part in self.report.parts for one in part.findings if one.state == "look"]
        found = count_words(len(looks), "1 thing to look at", "{n} things to look at")
        self.state.setText(found if looks else tr("Nothing of what was checked is wrong."))
        self._show_buttons()

    def _on_error(self, error: QProcess.ProcessError) -> None:
        if error == QProcess.ProcessError.FailedToStart:
            self._tell_failure(self._process.errorString())

    def _tell_failure(self, details: str) -> None:
        from nep_studio.support.anonymous import Anonymous

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
        ask_for_path(self, tr("Save as"), self._suggested, self.save, "save")


# Asks what is to be done when the last start failed, before anything of the person's is read.


class AfterACrash(QMessageBox):
    """Safe mode, a usual start, or a report; it has no look of ours, which may be the reason."""

    def __init__(self) -> None:
        super().__init__()
        role = QMessageBox.ButtonRole
        self.setIcon(QMessageBox.Icon.Warning)
        self.setWindowTitle("NEP Studio")
        self.setText(tr("NEP Studio did not get through its last start."))
        self.setInformativeText(
            tr(
                "Safe mode leaves out your settings, snippets and own nodes, and the graphics"
                " card. Nothing of it is deleted."
            )
        )
        self.safe_button = self.addButton(tr("Start in safe mode"), role.AcceptRole)
        self.usual_button = self.addButton(tr("Start as usual"), role.AcceptRole)
        self.report_button = self.addButton(tr("Report for support…"), role.ActionRole)
        self.close_button = self.addButton(tr("Close"), role.RejectRole)
        self.setDefaultButton(self.safe_button)
        self.setEscapeButton(self.close_button)


def ask() -> bool:
    """Let the person choose; whether to start, in safe mode when they want it."""
    words.use_language(settings.system_language(words.available_languages()))
    load_fonts()  # some computers have no letters of the person's language
    while True:
        box = AfterACrash()
        box.exec()
        if box.clickedButton() is not box.report_button:
            break
        SupportDialog(None).exec()
    if box.clickedButton() is box.safe_button:
        safe_mode.begin()
    return box.clickedButton() in (box.safe_button, box.usual_button)


# What a window tells after its start: that it runs in safe mode, or that nothing is kept.


def tell_how_it_runs(window: MainWindow) -> None:
    """Tell what is unusual, and look for a newer version if the person wants that."""
    if safe_mode.is_on():
        sentence = tr(
            "Your settings, snippets and own nodes are left out, and settings that you change are"
            " not kept. Work that was not saved is offered again at the next usual start."
        )
        steps = (
            tr("Does all work here? Then set your settings aside, and start as usual."),
            tr("If it fails again, send a report to those who help you."),
        )
        answers = (
            Answer(tr("Set the settings aside"), lambda: _set_aside(window)),
            Answer(tr("Report for support…"), lambda: show_report(window)),
        )
        title = tr("This is safe mode")
        window.messages.tell(
            Message("info", title, sentence, steps, answers=answers, outlives_project=True)
        )
    if folder := portable.not_kept():
        sentence = tr(
            "The program cannot write into {folder}. Settings, logs and unsaved work are gone when"
            " it ends.",
            folder=str(folder),
        )
        steps = (
            tr("Is the stick write-protected, or full?"),
            tr("Save your projects in another place."),
        )
        title = tr("Nothing is kept")
        window.messages.tell(Message("warning", title, sentence, steps, outlives_project=True))
    if UpdateChoice(window.settings).is_wanted and not safe_mode.is_on():
        from .settings_dialog import ask_if_due

        ask_if_due(window)


def _set_aside(window: MainWindow) -> None:
    folder = settings.user_folder()
    if safe_mode.set_settings_aside(folder):
        title = tr("The next usual start is as the first one")
        sentence = tr("Your old settings are in {file}.", file=str(folder / "settings.old.ini"))
        window.messages.tell(Message("success", title, sentence, outlives_project=True))
    else:
        title = tr("There are no settings to set aside")
        window.messages.tell(Message("info", title, outlives_project=True))


# Offers work that was not saved when the program ended without warning.

WIDTH_LINES, HEIGHT_LINES = 26, 13


class RecoveryDialog(QDialog):
    """A list of what can be restored; nothing is thrown away unless the person says so."""

    def __init__(
        self,
        found: Sequence[Recoverable],
        studio: Studio,
        restore: Callable[[Recoverable], object],
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self._found, self._studio, self._restore = list(found), studio, restore
        self.setWindowTitle(tr("Restore your work"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.list = QListWidget()
        self.picture = QLabel()
        self.restore_button = styled(QPushButton(tr("Restore"), default=True), kind="primary")
        self.look_button = QPushButton(tr("Look"))
        self.discard_button = QPushButton(tr("Discard"))
        self.later_button = QPushButton(tr("Decide later"))
        title = styled(QLabel(tr("Some work was not saved"), wordWrap=True), role="title")
        about = hint("NEP Studio ended without warning. This is what you had done until then.")
        foot = in_row(
            self.discard_button, self.look_button, 1, self.later_button, self.restore_button
        )
        line = self.fontMetrics().height()
        parts = (title, about, (self.list, 1), self.picture, foot)
        in_column(*parts, of=self, margins=line, spacing=line // 2)
        self.picture.hide()
        self.picture.setAccessibleName(tr("The blocks of this project"))
        self.list.setMinimumSize(line * WIDTH_LINES, line * 5)
        self.list.setAccessibleName(tr("Work that was not saved"))
        self.list.itemDoubleClicked.connect(self._on_restore)
        self.list.currentRowChanged.connect(self._on_row_changed)
        self.restore_button.clicked.connect(self._on_restore)
        self.look_button.clicked.connect(self._on_look)
        self.discard_button.clicked.connect(self._on_discard)
        self.later_button.clicked.connect(self.reject)
        self._fill()

    def _fill(self) -> None:
        for work in self._found:
            blocks = count_words(len(work.project.blocks), "1 block", "{n} blocks")
            moment = QDateTime.fromSecsSinceEpoch(int(work.time))
            when = QLocale().toString(moment, QLocale.FormatType.ShortFormat)
            words = f"{work.name}   —   {when}, {blocks}"
            item = QListWidgetItem(icon("history", self._studio.look.theme), words)
            item.setToolTip(plain_tip(str(work.path or tr("It had no file yet."))))
            self.list.addItem(item)
        self.list.setCurrentRow(0)

    def _chosen(self) -> Recoverable | None:
        row = self.list.currentRow()
        return self._found[row] if 0 <= row < len(self._found) else None

    def _on_row_changed(self) -> None:
        if self.picture.isVisible():
            self._on_look()

    def _on_restore(self) -> None:
        work = self._chosen()
        if work is not None:
            self.accept()
            self._restore(work)

    def _on_look(self) -> None:
        work = self._chosen()
        if work is None:
            self.picture.hide()
            return
        line = self.fontMetrics().height()
        language = self._studio.language
        picture = picture_of(
            Editor(work.project, language),
            self._studio.look.theme,
            block_font(self._studio),
            QSize(max(self.list.width(), line * WIDTH_LINES), line * HEIGHT_LINES),
            self.devicePixelRatioF(),
            is_mirrored=is_right_to_left(),
        )
        self.picture.setPixmap(picture)
        self.picture.show()

    def _on_discard(self) -> None:
        work, row = self._chosen(), self.list.currentRow()
        if work is None:
            return
        work.discard()
        del self._found[row]
        self.list.takeItem(row)
        if not self._found:
            self.reject()
