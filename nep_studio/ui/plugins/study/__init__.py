"""The study kit in the window: the questionnaire, what is recorded, and the results."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QFrame, QLabel, QPushButton, QWidget

from nep_studio.study.records import Reply, write_events, write_replies
from nep_studio.ui.host import Host, Parts, Plugin
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.theme.icons import icon, icon_pixmap
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import ElidedLabel
from nep_studio.ui.widgets.layouts import in_row
from nep_studio.ui.widgets.questions import save_text
from nep_studio.ui.words import count_words, tr

from .start import StartDialog, StudyRecorder, what_is_recorded

if TYPE_CHECKING:
    from .form import ResultsDialog


# The sign that is in the window as long as a study is recorded.


class StudySign(QFrame):
    """Says that a study is on and of whom, with buttons for the questionnaire and to stop."""

    def __init__(self, recorder: StudyRecorder, look: Look) -> None:
        super().__init__()
        self._recorder, self._look = recorder, look
        self.setProperty("kind", "warning")
        self.dot, self.words = QLabel(), ElidedLabel()
        self.form_button = labelled(QPushButton(), text="Fill in the questionnaire")
        self.stop_button = labelled(QPushButton(), text="Stop the study")
        in_row(self.dot, (self.words, 1), self.form_button, self.stop_button, of=self)
        recorder.changed.connect(self.refresh)
        look.theme_changed.connect(self.refresh)
        follow_words(self, self.refresh)

    def refresh(self) -> None:
        """Be there, or not."""
        sitting = self._recorder.sitting
        side, ratio = self.fontMetrics().height(), self.devicePixelRatioF()
        self.dot.setPixmap(icon_pixmap("eye", self._look.theme.colour("warning"), side, ratio))
        if sitting is None:
            return
        values = {"participant": sitting.participant, "condition": sitting.condition}
        if sitting.condition:
            words = tr("A study is recorded: {participant}, {condition}", **values)
        else:
            words = tr("A study is recorded: {participant}", participant=sitting.participant)
        self.words.set_words(words)


# Puts the study kit into the window: the Study menu, the recorder, and its sign.

Record = TypeVar("Record")
HELP_PAGES = "help"
"""What the names of actions begin with that show a page of the help."""


def make(host: Host) -> Parts:
    """Help > Study, when the rest of the Help menu is made, and the sign of a study that is on."""
    kit = StudyKit(host, StudyRecorder(host))
    kit.add_menu()
    kit.add_sign()
    return Parts()


class StudyKit(QObject):
    """What the Study menu does."""

    def __init__(self, host: Host, recorder: StudyRecorder) -> None:
        super().__init__(host.actions)
        self._host, self._recorder = host, recorder
        self._messages = host.services.messages
        self._folder = recorder.folder
        self._page = ""
        recorder.changed.connect(self._update_actions)

    def add_menu(self) -> None:
        """Make the menu."""
        theme, help_menu = self._host.services.look.theme, self._host.menus["help"]
        # Note which pages of the help are shown, and what else its menu opens
        self._host.ask("help.follow", self._on_page_shown)
        for action in help_menu.actions():
            if action.iconText() and not action.objectName().startswith(HELP_PAGES):
                note = partial(self._recorder.note, "help_opened", action.iconText())
                action.triggered.connect(lambda _=False, note=note: note())
        menu = labelled(help_menu.addMenu(icon("graduation-cap", theme), ""), title="Study")
        add = partial(self._host.actions.add, menu=menu)
        add("study_start", "Start a study…", self.start, icon_name="play")
        add("study_stop", "Stop the study", self._recorder.stop, icon_name="square")
        add("study_recorded", "What is recorded", self.tell_what, icon_name="eye")
        menu.addSeparator()
        add("study_form", "Fill in the questionnaire…", self.fill_in, icon_name="list")
        add("study_results", "Results…", self.show_results, icon_name="table")
        self._update_actions()

    def add_sign(self) -> None:
        """Put the sign at the lower edge of the window."""
        bar = self._host.status_bar
        bar.setSizeGripEnabled(False)
        sign = StudySign(self._recorder, self._host.services.look)
        sign.form_button.clicked.connect(self.fill_in)
        sign.stop_button.clicked.connect(self._recorder.stop)
        bar.addWidget(sign, 1)
        self._update_actions()

    def start(self) -> None:
        """Ask who takes part, and what is to be recorded."""
        dialog = StartDialog(self._folder, self._host.widget)
        dialog.started.connect(self._recorder.start)
        dialog.open()

    def tell_what(self) -> None:
        """Say what a study keeps."""
        title, *sentences = what_is_recorded(self._folder)
        self._messages.tell(Message("info", title, "\n\n".join(sentences)))

    def fill_in(self) -> None:
        """Show the questionnaire."""
        from .form import QuestionnaireDialog  # loaded when it is opened

        dialog = QuestionnaireDialog(self._folder, self._host.services.look, self._host.widget)
        dialog.answered.connect(self._on_answered)
        dialog.open()

    def show_results(self) -> None:
        """Show what was answered."""
        from .form import ResultsDialog

        dialog = ResultsDialog(self._folder, self._host.widget)
        dialog.answers_asked.connect(
            lambda: self._save(dialog, "answers.csv", self._folder.replies(), write_replies)
        )
        dialog.events_asked.connect(
            lambda: self._save(dialog, "events.csv", self._folder.events(), write_events)
        )
        dialog.deletion_asked.connect(lambda: self._ask_to_delete(dialog))
        dialog.open()

    def _on_answered(self, reply: Reply) -> None:
        try:
            self._folder.add_reply(reply)
        except OSError as error:
            steps = (tr("Is there room on the disk?"),)
            title = tr("The answers could not be kept")
            again = Answer(tr("Try again"), lambda: self._on_answered(reply))
            message = Message("error", title, "", steps, str(error), (again,))
            self._messages.tell(replace(message, outlives_project=True))
            return
        self._recorder.note("questionnaire_answered", number=round(reply.score, 2))
        title = tr("The answers of {participant} are kept", participant=reply.participant)
        self._messages.confirm(title, Answer(tr("Show the results"), self.show_results))

    def _save(
        self,
        dialog: ResultsDialog,
        name: str,
        records: list[Record],
        write: Callable[[Path, Iterable[Record]], object],
    ) -> None:
        def tell(path: Path) -> None:
            rows = count_words(len(records), "1 row", "{n} rows")
            words = tr("{name} is saved: {rows}", name=path.name, rows=rows)
            self._messages.confirm(words)

        save_text(dialog, self._messages, name, lambda path: write(path, records), tell)

    def _ask_to_delete(self, dialog: ResultsDialog) -> None:
        def delete() -> None:
            try:
                self._recorder.delete_all()
            except OSError as error:
                title = tr("Not everything could be deleted")
                words = tr("Delete the folder {folder} yourself.", folder=self._folder.folder)
                self._messages.tell(Message("error", title, "", (words,), str(error)))
            else:
                self._messages.confirm(tr("All answers and events are deleted"))
            dialog.refresh()

        answers = (Answer(tr("Delete all"), delete), Answer(tr("Keep"), lambda: None, "primary"))
        title = tr("Delete all answers and events?")
        words = tr("This cannot be taken back. A study that is on ends. Saved files stay.")
        self._messages.ask(Message("warning", title, words, answers=answers))

    def _on_page_shown(self, panel: QWidget, page: str) -> None:
        if panel.isVisible() and page != self._page:  # the same one is drawn again, as for a theme
            self._page = page
            self._recorder.note("help_opened", page)

    def _update_actions(self) -> None:
        is_on, actions = self._recorder.is_on, self._host.actions
        actions.enable(not is_on, "study_start")
        actions.enable(is_on, "study_stop")
        self._host.status_bar.setVisible(is_on)


plugin = Plugin("study", make, order=130, modules=("start",))
