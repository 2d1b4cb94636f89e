"""The simulated human panel: whatever a program waits for is done here with mouse and keyboard."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import (
    QComboBox,
    QFrame,
    QLabel,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QWidget,
)

from nep_core.wire import messages as m
from nep_core.wire.states import plain
from nep_studio.blocks.language import Language
from nep_studio.blocks.own_gestures import own_gestures
from nep_studio.blocks.slots import why_not_line
from nep_studio.project.triggers import Occurrence, occurrences_of
from nep_studio.ui.edits import OpenProject
from nep_studio.ui.floor import Floor
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.messages import announce
from nep_studio.ui.running.runner import Heard, Tap
from nep_studio.ui.theme.icons import icon, icon_room
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import plain_label
from nep_studio.ui.widgets.layouts import Columns, in_column, in_row
from nep_studio.ui.words import language_code, tr

from .person_box import Buttons, OccurrenceButton, PersonBox, Section, WordsButton
from .senses import BodyBox, GestureBox, SensorBox, ThingsBox, TouchBox
from .stimuli import KINDS, Stimuli, Visitors, words_of

if TYPE_CHECKING:
    from nep_studio.ui.host import Host


# What the open program waits for: a button for each.


class WaitingBoard(QWidget):
    """Buttons in rows; what needs no hand is said in words below them."""

    def __init__(
        self,
        look: Look,
        begin: Callable[[Occurrence], bool],
        end: Callable[[Occurrence], None],
        *,
        tells_of_nothing: bool = False,
    ) -> None:
        super().__init__()
        self._look, self._begin, self._end = look, begin, end
        self._tells_of_nothing = tells_of_nothing
        self._shown: tuple[str, list[Occurrence]] | None = None
        self.buttons: list[OccurrenceButton] = []
        self._rows = Buttons()
        self._rows.hide()  # it takes room, although it has no buttons
        self.words = plain_label()
        self.words.hide()
        self.words.setProperty("role", "hint")
        in_column(self._rows, self.words, of=self, margins=0)

    def show_occurrences(self, occurrences: list[Occurrence], here: dict[str, str]) -> None:
        """Show these; ``here`` are the visitors that are there now, with their names."""
        if (shown := (language_code(), occurrences)) != self._shown:
            self._shown = shown
            old, do = self.buttons, (self._look, self._begin, self._end)
            done = [one for one in occurrences if one.kind != "idle"]
            self.buttons = [OccurrenceButton(one, *do) for one in done]
            self._rows.replace(old, self.buttons)
            self._rows.setVisible(bool(self.buttons))
            idle = [words_of(one) for one in occurrences if one.kind == "idle"]
            if self._tells_of_nothing and not occurrences:
                idle = [tr("This program waits for nothing.")]
            self.words.setText("\n".join(idle))
            self.words.setVisible(bool(self.words.text()))
        for button in self.buttons:
            if button.isCheckable():
                button.setChecked(_is_here(button.occurrence, here))


def _is_here(occurrence: Occurrence, here: dict[str, str]) -> bool:
    if occurrence.kind not in here:
        return False
    return not occurrence.value or plain(occurrence.value) == plain(here[occurrence.kind])


LEAST_LINES = 3


class HumanPanel(QScrollArea):
    """What the program waits for comes first; below it, all that can be done by hand.

    It is empty until it is shown for the first time.
    """

    def __init__(self, host: Host, floor: Floor) -> None:
        super().__init__()
        self._host, self._look = host, host.services.look
        self._runner = host.services.runner
        self._tap: Tap | None = None
        self._open_project = OpenProject(host.services.files, self)
        self.visitors = Visitors(floor, self)
        self.stimuli = Stimuli(self._runner, self.visitors, self.watch_gestures, self)
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        labelled(self, name="Simulated human")

    def _make(self) -> None:
        self.robot = QComboBox()
        self.state = QLabel(wordWrap=True, textFormat=Qt.TextFormat.PlainText)
        self.told = QLabel(wordWrap=True, textFormat=Qt.TextFormat.PlainText)
        self.run_button = labelled(QPushButton(), text="Run")
        self.words, self.say_button = QLineEdit(), labelled(QPushButton(), text="Say")
        self.reset_button = WordsButton("Everything as at the start", self._look, "rotate-ccw")
        look, stimuli = self._look, self.stimuli

        def language() -> Language:
            return self._host.services.language

        self.waiting = WaitingBoard(look, stimuli.begin, stimuli.end, tells_of_nothing=True)
        self.listening = WaitingBoard(look, stimuli.begin, stimuli.end)
        self.person = PersonBox(stimuli, language, look)
        self.touch = TouchBox(stimuli, language, look)
        self.gestures = GestureBox(stimuli, language, look)
        self.things = ThingsBox(stimuli, look)
        self.sensors = SensorBox(stimuli, language, look)
        self.body = BodyBox(stimuli, language, look)
        self.sections = [
            Section("Your program waits for", self.waiting, look),
            Section("Say words", self._say_row(), look),
            Section("A person", self.person, look),
            Section("Touch", self.touch, look),
            Section("Make a gesture", self.gestures, look),
            Section("Things and sounds", self.things, look, is_open=False),
            Section("Sensors", self.sensors, look, is_open=False),
            Section("The body", self.body, look, is_open=False),
        ]
        self._lay_out()
        self._connect()
        self._dress()

    def _say_row(self) -> QWidget:
        labelled(self.words, placeholder="Somebody says…", name="Words that somebody says")
        said = QWidget()
        in_column(in_row((self.words, 1), self.say_button), self.listening, of=said, margins=0)
        return said

    def _lay_out(self) -> None:
        labelled(self.robot, name="Which robot notices it")
        self.robot.setMinimumContentsLength(8)
        self.run_button.setProperty("kind", "run")
        self.told.setProperty("role", "hint")
        # no button moves when it speaks
        self.told.setMinimumHeight(self.fontMetrics().lineSpacing() + 1)
        top = in_row((self.state, 1), self.run_button)
        self._which = QWidget()
        in_row(labelled(QLabel(), text="Before"), (self.robot, 1), of=self._which, margins=0)
        inner, line = QWidget(self.viewport()), self.fontMetrics().height()
        reset = self.reset_button, 0, Qt.AlignmentFlag.AlignLeading
        parts = top, self.told, self._which, Columns(self.sections, inner), reset, 1
        in_column(*parts, of=inner, margins=line // 2)
        self.setWidget(inner)

    def _connect(self) -> None:
        self._open_project.changed.connect(self.refresh)
        self._host.services.files.document_changed.connect(self.told.clear)
        self.stimuli.changed.connect(self._show_state)
        self.stimuli.told.connect(self._on_told)
        self.stimuli.refused.connect(self._on_refused)
        self.visitors.changed.connect(self._show_waiting)
        self.robot.currentTextChanged.connect(self._on_robot_chosen)
        self.run_button.clicked.connect(self._runner.run)
        self._runner.state_changed.connect(self._on_run_changed)
        self.say_button.clicked.connect(self._on_said)
        self.words.returnPressed.connect(self._on_said)
        self.reset_button.clicked.connect(self.reset)
        self._look.theme_changed.connect(self._dress)
        follow_words(self, self.refresh)

    # What is shown

    def refresh(self) -> None:
        """Show what the program waits for now, if somebody looks."""
        if not self.isVisible():
            return
        robots = self.stimuli.robots
        if robots != [self.robot.itemText(row) for row in range(self.robot.count())]:
            before = self.stimuli.robot
            self.robot.clear()
            self.robot.addItems(robots)
            self.robot.setCurrentText(before)
        self.stimuli.robot = self.robot.currentText()
        self._which.setVisible(len(robots) > 1)
        self._show_waiting()
        self._show_state()

    def occurrences(self) -> list[Occurrence]:
        """What the open program waits for."""
        editor = self._open_project.editor
        return [] if editor is None else occurrences_of(editor.project, editor.language)

    def watch_gestures(self) -> dict[str, str]:
        """What the watch on the screen can make: gestures that the project has takes of, and five.

        Names to titles.
        """
        editor = self._open_project.editor
        own = {} if editor is None else own_gestures(editor.project)
        recorded = {name: one.title for name, one in own.items() if one.takes}
        return {**recorded, **self._host.services.language.choices.get("gestures", {})}

    def reset(self) -> None:
        """Let all visitors go, and all sensors measure what they usually do."""
        for what in KINDS:
            self.visitors.go(what)
        self.sensors.rest()

    def _show_waiting(self) -> None:
        if not self.isVisible():
            return
        waited_for = self.occurrences()
        found = {what: self.visitors.find(what) for what in KINDS}
        here = {what: thing.name for what, thing in found.items() if thing is not None}
        self.waiting.show_occurrences(waited_for, here)
        self.gestures.show_gestures(waited_for, self.watch_gestures())
        self.person.set_names([one.value for one in waited_for if one.kind == "face" and one.value])

    def _show_state(self) -> None:
        if not self.isVisible():
            return
        reason = self.stimuli.why_not
        self.state.setText(reason or tr("What you do here is noticed."))
        is_idle = self._runner.state == "idle" and self._open_project.editor is not None
        if self.run_button.hasFocus() and not is_idle:
            self.setFocus()  # else it goes to what is far below, and the panel is scrolled there
        self.run_button.setVisible(is_idle)
        self.gestures.refresh()

    # What happens

    def _on_run_changed(self, state: str) -> None:
        """In a low panel, let what the program waits for be seen once it can be done."""
        if state == "running" and self.isVisible() and self.waiting.buttons:
            first = self.waiting.buttons[0]
            QTimer.singleShot(0, first, lambda: self.ensureWidgetVisible(first))

    def _on_states(self, batch: list[Heard]) -> None:
        self.visitors.states |= {heard.message.robot: heard.message for heard in batch}
        robots = [state for state in self.visitors.states.values() if state.listening]
        words = dict.fromkeys(word for state in robots for word in state.listening)
        self.listening.show_occurrences([Occurrence("word", word, word) for word in words], {})

    def _on_robot_chosen(self, robot: str) -> None:
        self.stimuli.robot = robot
        self.person.refresh()

    def _on_said(self) -> None:
        text = self.words.text().strip()
        if why_not_line(text) is not None or not plain(text):
            self.words.setFocus()
        elif self.stimuli.begin(Occurrence("word", text, text)):
            self.words.clear()

    def _on_told(self, words: str) -> None:
        self.told.setText(words)
        announce(self, words)

    def _on_refused(self, reason: str) -> None:
        self._on_told(reason)
        if self.run_button.isVisible():
            self.run_button.setFocus()

    def _dress(self) -> None:
        theme = self._look.theme
        self.run_button.setIcon(icon("play", theme.colour("run_text")))
        self.say_button.setIcon(icon("message-square", theme))
        for button in (self.run_button, self.say_button):
            button.setIconSize(icon_room(self.fontMetrics().height()))

    def showEvent(self, event: QShowEvent) -> None:
        """Make what is in it, and follow where the robots are."""
        super().showEvent(event)
        if self.widget() is None:
            self._make()
        if self._tap is None:
            self._tap = self._runner.tap(m.ROBOT_STATE, kind=m.RobotState, parent=self)
            self._tap.arrived.connect(self._on_states)
        self.refresh()

    def minimumSizeHint(self) -> QSize:
        """A button of it, where letters are so large that the robot has hardly room above it."""
        return QSize(super().minimumSizeHint().width(), self.fontMetrics().height() * LEAST_LINES)

    def hideEvent(self, event: QHideEvent) -> None:
        """Follow nothing."""
        super().hideEvent(event)
        if self._tap is not None:
            self._tap.close()
            self._tap = None
