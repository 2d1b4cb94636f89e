"""Records what happens in a session of a study, while somebody asked for it; else nothing."""

from __future__ import annotations

import logging
import time
from typing import TYPE_CHECKING

from PySide6.QtCore import QCoreApplication, QObject, Signal

from nep_studio.blocks.editor import History
from nep_studio.blocks.program import Changes
from nep_studio.run.session import Ending
from nep_studio.study.records import Event, Sitting, StudyFolder, What
from nep_studio.ui.documents import Document
from nep_studio.ui.messages import Message, Told
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.host import Host

log = logging.getLogger(__name__)

STUDY_FOLDER = "study"


class StudyRecorder(QObject):
    """Lives as long as the window. ``changed`` tells that a study begins or ends."""

    changed = Signal()

    def __init__(self, host: Host) -> None:
        super().__init__(host.widget)
        self._messages, self._runner = host.services.messages, host.services.runner
        self.folder = StudyFolder(host.services.settings.folder / STUDY_FOLDER)
        self.sitting = self.folder.sitting()
        self._has_run = self._has_run_before()
        self._document: Document | None = None
        self._history: History | None = None
        self._edits = 0
        self._run_started_s = 0.0
        host.services.files.document_changed.connect(self._on_document_changed)
        host.services.messages.told.connect(self._on_told)
        host.services.runner.run_asked.connect(lambda: self.note("run_asked"))
        host.services.runner.state_changed.connect(self._on_state_changed)
        host.services.runner.ended.connect(self._on_ended)
        app = QCoreApplication.instance()
        if app is not None:
            app.aboutToQuit.connect(self._on_quit)
        self.note("app_opened")
        self._follow(host.services.document)

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

    def note_help(self, words: str) -> None:
        """Keep that somebody opened the help, and on what."""
        self.note("help_opened", words)

    # What happens

    def _on_document_changed(self, document: Document | None) -> None:
        self._note_edits()
        self._follow(document)
        if document is not None:
            self.note("project_opened", number=len(document.project.blocks))

    def _follow(self, document: Document | None) -> None:
        """Count the changes of this project; the one before may be closed already."""
        self._document = document
        self._listen()

    def _listen(self) -> None:
        """Count changes while a session is recorded, and only then."""
        if self._history is not None:
            self._history.unlisten(self._on_changes)
        document = self._document if self.is_on else None
        self._history = None if document is None else document.editor.history
        if self._history is not None:
            self._history.listen(self._on_changes)

    def _on_changes(self, changes: Changes) -> None:
        self._edits += 1

    def _note_edits(self) -> None:
        edits, self._edits = self._edits, 0
        if edits:
            self.note("edits", number=edits)

    def _on_told(self, told: Told) -> None:
        if told.message.kind in ("error", "warning"):
            self.note("error_told", told.message.title)

    def _on_state_changed(self, state: str) -> None:
        if state == "starting":
            self._note_edits()
            self._run_started_s = 0.0
        elif state == "running" and not self._run_started_s:
            self._run_started_s = time.time()
            self.note("run_started")
            self._note_first_run()
        elif state == "stopping":
            self.note("stop_pressed")

    def _note_first_run(self) -> None:
        """How long it took until the program ran for the first time."""
        if self.sitting is not None and not self._has_run:
            self._has_run = True
            self.note("first_run", number=round(time.time() - self.sitting.started_s, 3))

    def _has_run_before(self) -> bool:
        if self.sitting is None:
            return False
        return any(
            event.what == "first_run" and event.sitting == self.sitting
            for event in self.folder.events()
        )

    def _on_ended(self, ending: Ending) -> None:
        began_s, self._run_started_s = self._run_started_s, 0.0
        lasted_s = round(time.time() - began_s, 3) if began_s else None
        self.note("run_ended", str(ending.problem.title) if ending.problem else "", lasted_s)

    def _on_quit(self) -> None:
        self._note_edits()
        self.note("app_closed")

    def _tell_failure(self, error: OSError) -> None:
        self._messages.tell(
            Message(
                "error",
                tr("The study cannot be kept"),
                tr("The folder of the study cannot be written."),
                (
                    tr("Is there room on the disk?"),
                    tr("May this program write into {folder}?", folder=self.folder.folder),
                ),
                str(error),
            )
        )
