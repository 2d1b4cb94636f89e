"""Begins a study: who takes part, under which condition, and what is recorded, in plain words."""

from __future__ import annotations

import logging
import time
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QCoreApplication, QMetaObject, QObject, QRegularExpression, Qt, Signal
from PySide6.QtGui import QRegularExpressionValidator
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QFormLayout,
    QFrame,
    QLabel,
    QLineEdit,
    QPushButton,
    QWidget,
)

from nep_studio.blocks.editor import History
from nep_studio.blocks.program import Changes
from nep_studio.run.plan import Ending
from nep_studio.study.records import (
    Event,
    Sitting,
    StudyFolder,
    What,
    conditions_for,
    next_code,
    participant_number,
)
from nep_studio.ui.documents import Document
from nep_studio.ui.messages import LoggedMessage, Message
from nep_studio.ui.widgets.forms import fit_on_screen, hint
from nep_studio.ui.widgets.layouts import in_column, in_row, scrolled
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.host import Host


# ParticipantFields takes part in a study, and under which condition: a code, never a name.

CODE = r"[\p{L}\p{N}_-]{1,20}"


class ParticipantFields(QWidget):
    """The participant's code, the conditions, and the one that is next in their order."""

    changed = Signal()

    def __init__(self, folder: StudyFolder, *, may_change_conditions: bool) -> None:
        super().__init__()
        self._folder = folder
        self._shown: list[str] = []
        self.code = QLineEdit(next_code(folder.participants()))
        self.code.setValidator(QRegularExpressionValidator(QRegularExpression(CODE)))
        self.conditions = QLineEdit(", ".join(folder.conditions()))
        self.conditions.setPlaceholderText(tr("Such as: blocks, text"))
        self.condition = QComboBox()
        self.order = hint("")
        self._form = QFormLayout(self)
        self._form.setContentsMargins(0, 0, 0, 0)
        self._form.addRow(tr("Participant"), self.code)
        self._form.addRow("", hint("A code, not a name. Its number decides the order."))
        if may_change_conditions:
            self._form.addRow(tr("Conditions"), self.conditions)
        self._form.addRow(tr("Condition now"), self.condition)
        self._form.addRow("", self.order)
        self.code.textChanged.connect(self._on_changed)
        self.conditions.textChanged.connect(self._on_changed)
        self._on_changed()

    @property
    def participant(self) -> str:
        """The code; "" while it is none."""
        return self.code.text() if self.code.hasAcceptableInput() else ""

    @property
    def chosen_condition(self) -> str:
        """The condition; "" where there is only one."""
        return str(self.condition.currentData() or "")

    def all_conditions(self) -> list[str]:
        """The conditions that are compared."""
        named = [one.strip() for one in self.conditions.text().split(",")]
        return list(dict.fromkeys(filter(None, named)))

    def show_sitting(self, participant: str, condition: str) -> None:
        """Show the participant and condition of a study that goes on."""
        self.code.setText(participant)
        if condition and self.condition.findData(condition) < 0:
            self.condition.addItem(condition, condition)
            self._form.setRowVisible(self.condition, True)
        self.condition.setCurrentIndex(self.condition.findData(condition))

    def _on_changed(self) -> None:
        conditions = self.all_conditions()
        number = participant_number(self.participant)
        ordered = conditions_for(number or 1, conditions)
        done = self._folder.conditions_done(self.participant) if self.participant else set()
        self.condition.clear()
        for place, condition in enumerate(ordered, 1):
            words = tr("{place}. {condition}", place=place, condition=condition)
            self.condition.addItem(words, condition)
        left = [condition for condition in ordered if condition not in done]
        self.condition.setCurrentIndex(self.condition.findData(left[0]) if left else 0)
        self._form.setRowVisible(self.condition, bool(conditions))
        self._form.setRowVisible(self.order, bool(conditions))
        self.order.setText(self._order_words(number, ordered))
        self.changed.emit()

    def _order_words(self, number: int | None, ordered: list[str]) -> str:
        if number is None:
            return tr("The code has no number: the order is that of the first participant.")
        order = ", ".join(ordered)
        return tr("The order for {participant}: {order}", participant=self.participant, order=order)


class StartDialog(QDialog):
    """Nothing is recorded before Start is pressed; ``started`` gives the Sitting."""

    started = Signal(object)

    def __init__(self, folder: StudyFolder, parent: QWidget) -> None:
        super().__init__(parent)
        self._folder = folder
        self.setWindowTitle(tr("Start a study"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.participant_fields = ParticipantFields(folder, may_change_conditions=True)
        self.start_button = QPushButton(tr("Start the study"))
        self.cancel_button = QPushButton(tr("Cancel"))
        line = self.fontMetrics().height()
        flags = Qt.TextInteractionFlag.TextSelectableByMouse
        told = [
            QLabel(words, wordWrap=True, textInteractionFlags=flags)
            for words in what_is_recorded(folder)
        ]
        told[0].setProperty("role", "heading")
        card = QFrame()
        card.setProperty("kind", "info")
        in_column(*told, of=card)
        self.start_button.setDefault(True)
        self.start_button.setProperty("kind", "primary")
        foot = in_row(1, self.cancel_button, self.start_button)
        page = QWidget()
        in_column(self.participant_fields, card, 1, of=page, margins=0, spacing=line)
        in_column((scrolled(page), 1), foot, of=self, margins=line, spacing=line)
        fit_on_screen(self, 34, 26)
        fields = self.participant_fields
        fields.changed.connect(lambda: self.start_button.setEnabled(bool(fields.participant)))
        self.start_button.clicked.connect(self._on_start_clicked)
        self.cancel_button.clicked.connect(self.reject)

    def _on_start_clicked(self) -> None:
        fields = self.participant_fields
        with suppress(OSError):  # who begins the study tells that its folder cannot be written
            self._folder.set_conditions(fields.all_conditions())
        self.started.emit(Sitting(fields.participant, fields.chosen_condition))
        self.accept()


def what_is_recorded(folder: StudyFolder) -> list[str]:
    """What a study keeps and what it does not, in plain words."""
    return [
        tr("What is recorded while a study is on"),
        tr(
            "Kept, each with its time: the studio and projects being opened (how many blocks, not"
            " which), how many changes are made, Run and Stop, how a run ends, the titles of"
            " errors and warnings, and which help is opened."
        ),
        tr(
            "Not kept: names of people, what the program says or does, what is typed, sound,"
            " pictures, what sensors measure, and anything of other programs."
        ),
        tr("Everything stays on this computer, in {folder}.", folder=folder.folder),
        tr("A sign in the window is there as long as something is recorded."),
    ]


# Records what happens in a session of a study, while somebody asked for it; else nothing.

log = logging.getLogger(__name__)

STUDY_FOLDER = "study"


class StudyRecorder(QObject):
    """Lives as long as the window. ``changed`` tells that a study begins or ends."""

    changed = Signal()

    def __init__(self, host: Host) -> None:
        super().__init__(host.widget)
        self._messages, self._runner = host.services.messages, host.services.runner
        self._files = host.services.files
        self.folder = StudyFolder(host.services.settings.folder / STUDY_FOLDER)
        self.sitting = self.folder.sitting()
        self._has_run = any(
            event.what == "first_run" and event.sitting == self.sitting
            for event in (self.folder.events() if self.is_on else ())
        )
        self._history: History | None = None
        self._edits = 0
        self._is_starting, self._run_started_s = False, 0.0
        self._files.document_changed.connect(self._on_document_changed)
        self._heard: list[QMetaObject.Connection] = []
        app = QCoreApplication.instance()
        if app is not None:
            app.aboutToQuit.connect(self._on_quit)
        self.note("app_opened")
        self._listen()

    @property
    def is_on(self) -> bool:
        """Whether a session is recorded now."""
        return self.sitting is not None

    def start(self, sitting: Sitting) -> None:
        """Record from now on."""
        try:
            self.folder.begin(sitting)
        except OSError as error:
            self._tell_failure(error)
            return
        self.sitting, self._has_run, self._edits = sitting, False, 0
        # a run that is under way began before the study
        self._is_starting, self._run_started_s = self._runner.state == "starting", 0.0
        self._listen()
        self.note("study_started")
        self.changed.emit()

    def stop(self) -> None:
        """Record no more."""
        if self.sitting is None:
            return
        self._note_edits()
        self.note("study_stopped")
        try:
            self.folder.finish()
        except OSError as error:
            self._tell_failure(error)
        self.sitting = None
        self._listen()
        self.changed.emit()

    def delete_all(self) -> None:
        """Throw everything away that was ever recorded; raises OSError."""
        self.sitting = None
        self._listen()
        self.folder.delete_all()
        self.changed.emit()

    def note(self, what: What, words: str = "", number: float | None = None) -> None:
        """Keep an event, if a study is on."""
        if self.sitting is None:
            return
        try:
            self.folder.add_event(Event(self.sitting, what, words, number))
        except (OSError, ValueError) as error:
            log.warning("an event of a study is lost: %s", error)

    # What happens

    def _on_document_changed(self, document: Document | None) -> None:
        self._note_edits()
        self._listen()
        if document is not None:
            self.note("project_opened", number=len(document.project.blocks))

    def _listen(self) -> None:
        """Follow runs and messages, and count changes of the project that is open now, while a
        session is recorded; only then.
        """
        runner = self._runner
        if self.is_on and not self._heard:
            self._heard = [
                self._messages.told.connect(self._on_told),
                runner.run_asked.connect(partial(self.note, "run_asked")),
                runner.state_changed.connect(self._on_state_changed),
                runner.ended.connect(self._on_ended),
            ]
        while self._heard and not self.is_on:
            QObject.disconnect(self._heard.pop())
        if self._history is not None:
            self._history.unlisten(self._on_changes)
        document = self._files.document if self.is_on else None
        self._history = None if document is None else document.editor.history
        if self._history is not None:
            self._history.listen(self._on_changes)

    def _on_changes(self, changes: Changes) -> None:
        self._edits += 1

    def _note_edits(self) -> None:
        edits, self._edits = self._edits, 0
        if edits:
            self.note("edits", number=edits)

    def _on_told(self, told: LoggedMessage) -> None:
        if told.message.kind in ("error", "warning"):
            self.note("error_told", told.message.title)

    def _on_state_changed(self, state: str) -> None:
        was_starting, self._is_starting = self._is_starting, state == "starting"
        if state == "starting":
            self._note_edits()
        elif state == "running" and was_starting:  # else it goes on after a pause
            self._run_started_s = time.time()
            self.note("run_started")
            # how long it took until the program ran for the first time
            if self.sitting is not None and not self._has_run:
                self._has_run = True
                self.note("first_run", number=round(time.time() - self.sitting.started_s, 3))
        elif state == "stopping":
            self.note("stop_pressed")

    def _on_ended(self, ending: Ending) -> None:
        began_s, self._run_started_s = self._run_started_s, 0.0
        lasted_s = round(time.time() - began_s, 3) if began_s else None
        self.note("run_ended", str(ending.problem.title) if ending.problem else "", lasted_s)

    def _on_quit(self) -> None:
        self._note_edits()
        self.note("app_closed")

    def _tell_failure(self, error: OSError) -> None:
        title = tr("The study cannot be kept")
        sentence = tr("The folder of the study cannot be written.")
        may_write = tr("May this program write into {folder}?", folder=self.folder.folder)
        steps = (tr("Is there room on the disk?"), may_write)
        details = str(error)
        message = Message("error", title, sentence, steps, details, outlives_project=True)
        self._messages.tell(message)
