"""What a motion is called, what it is for, and the posture in which it starts."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QLocale, Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QFrame,
    QLabel,
    QLineEdit,
    QPushButton,
    QToolButton,
    QWidget,
)

from nep_studio.blocks.language import Language
from nep_studio.blocks.own_animations import AnimationKind
from nep_studio.ui.actions import Actions
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.messages import announce
from nep_studio.ui.theme.icons import icon_pixmap
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.choices import Choices
from nep_studio.ui.widgets.forms import label_of
from nep_studio.ui.widgets.layouts import in_row
from nep_studio.ui.words import count_words, tr
from robots.body.body import Body, posture_name
from robots.errors import ActionFailed

from .motion_controller import MotionController, Player
from .rehearsal import Fault
from .timeline import Timeline


class Header(QWidget):
    """Three fields over the robot."""

    def __init__(self, controller: MotionController, language: Callable[[], Language]) -> None:
        super().__init__()
        self.controller = controller
        self.title = QLineEdit(maxLength=100)
        labelled(self.title, placeholder="Name of the motion", name="Name of the motion")
        self.start = Choices(
            lambda: {"": tr("any posture"), **posture_words(language(), controller.body)}
        )
        self.kind = Choices(kind_words)
        starts, used = label_of("Starts from", self.start), label_of("Used to", self.kind)
        in_row((self.title, 1), starts, self.start, used, self.kind, of=self, margins=0)
        self.title.textEdited.connect(self._on_title_edited)
        self.title.editingFinished.connect(controller.seal)
        self.start.activated.connect(self._on_start_chosen)
        self.kind.activated.connect(self._on_kind_chosen)
        controller.changed.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Show the motion as it is now."""
        motion = self.controller.motion
        if self.title.text() != motion.title:
            self.title.setText(motion.title)
        self.start.setCurrentIndex(max(0, self.start.findData(motion.starts_from)))
        self.kind.setCurrentIndex(max(0, self.kind.findData(motion.kind)))

    def _on_title_edited(self, title: str) -> None:
        self.controller.change(tr("name the motion"), merge="title", title=title)

    def _on_start_chosen(self) -> None:
        self.controller.set_start(self.start.currentData(), tr("choose the posture it starts from"))
        self.refresh()

    def _on_kind_chosen(self) -> None:
        self.controller.change(tr("choose what it is for"), kind=self.kind.currentData())


def kind_words() -> dict[AnimationKind, str]:
    """What motions of each kind are used to do."""
    return {
        "animation": tr("be played"),
        "animal": tr("imitate an animal"),
        "gesture": tr("speak with gestures"),
    }


def posture_words(language: Language, body: Body) -> dict[str, str]:
    """What the postures of a body are called, by their names."""
    found = {}
    for word, label in language.choices.get("postures", {}).items():
        try:
            found[posture_name(body, word)] = label
        except ActionFailed:
            continue  # a word for a posture that this body does not have
    return found or {name: name for name in body.postures}


# What there is to say of the motion: how to begin, or what the robot could not do.


class NotesBar(QFrame):
    """One line, a sign before it, and what can be done about it."""

    time_asked = Signal()
    open_asked = Signal()

    def __init__(self, controller: MotionController, look: Look) -> None:
        super().__init__()
        self.controller, self.look = controller, look
        self.faults: list[Fault] = []
        self.sign, self.words = QLabel(), QLabel(wordWrap=True)
        self.open = labelled(QPushButton(autoDefault=False), text="Open one as a start…")
        self.show_place = labelled(QPushButton(autoDefault=False), text="Show the place")
        self.give_time = labelled(QPushButton(autoDefault=False), text="Give it the time it needs")
        sign = self.sign, 0, Qt.AlignmentFlag.AlignVCenter
        buttons = self.open, self.show_place, self.give_time
        in_row(sign, (self.words, 1), *buttons, of=self, margins=0)
        self.setMinimumHeight(self.fontMetrics().height() * 2)
        self.give_time.clicked.connect(self.time_asked)
        self.open.clicked.connect(self.open_asked)
        self.show_place.clicked.connect(self._on_show_asked)
        controller.changed.connect(self.refresh)
        look.theme_changed.connect(self.refresh)
        follow_words(self, self.refresh)

    def show_faults(self, faults: list[Fault]) -> None:
        """Tell of these."""
        if faults and faults != self.faults:
            announce(self, faults[0].words)
        self.faults = faults
        self.refresh()

    def refresh(self) -> None:
        """Say what there is to say now."""
        is_empty = not self.controller.motion.joints
        self.open.setVisible(is_empty)
        self.give_time.setVisible(any(fault.kind == "fast" for fault in self.faults))
        self.show_place.setVisible(bool(self.faults))
        if is_empty:
            words = tr(
                "Drag a hand, a foot or the head of the robot, or move a slider: that is the first "
                "key pose. Then choose a later moment on the timeline, and pose it again."
            )
            self._say("lightbulb", "info", words)
        elif self.faults:
            more = len(self.faults) - 1
            rest = count_words(more, "One more place is marked.", "{n} more places are marked.")
            words = self.faults[0].words + (f" {rest}" if more else "")
            self._say("triangle-alert", "warning", words)
        else:
            self._say("circle-check", "success", tr("The robot can do this."))

    def _say(self, sign: str, colour: str, words: str) -> None:
        side, ratio = self.fontMetrics().height() * 1.2, self.devicePixelRatioF()
        self.sign.setPixmap(icon_pixmap(sign, self.look.theme.colour(colour), side, ratio))
        self.words.setText(words)

    def _on_show_asked(self) -> None:
        fault = self.faults[0]
        is_fall = fault.kind == "fall"
        self.controller.show(fault.from_s if is_fall else (fault.from_s + fault.to_s) / 2)


# Plays and pauses a motion, and says how fast and how often; a row of buttons.

SPEEDS = (0.25, 0.5, 1.0, 2.0)
SNAPS_S = (0.0, 0.01, 0.05, 0.1, 0.25)


class Transport(QWidget):
    """The row between the robot and the timeline."""

    def __init__(
        self, controller: MotionController, player: Player, timeline: Timeline, actions: Actions
    ) -> None:
        super().__init__()
        self.controller, self.player, self.timeline = controller, player, timeline
        self.time = QLabel()
        self.speed = QComboBox()
        labelled(
            self.speed, name="Speed", tip="How fast it is shown here; the motion stays as it is"
        )
        for speed in SPEEDS:
            words = f"\N{MULTIPLICATION SIGN} {QLocale().toString(speed, 'g', 3)}"
            self.speed.addItem(words, speed)
        self.speed.setCurrentIndex(SPEEDS.index(1.0))
        self.snap = Choices(snap_words)
        labelled(self.snap, name="Grid", tip="To which times key poses go when they are moved")
        self.snap.setCurrentIndex(SNAPS_S.index(timeline.snap_s))
        playing = [_button(actions, name) for name in ("first_pose", "play_motion", "loop_motion")]
        adding, curve = _button(actions, "add_pose", has_words=True), _button(actions, "show_curve")
        poses = adding, _button(actions, "copy_pose"), _button(actions, "delete_pose"), self.snap
        in_row(*playing, self.speed, self.time, 1, *poses, curve, of=self, margins=0)
        self.speed.currentIndexChanged.connect(self._on_speed_changed)
        self.snap.currentIndexChanged.connect(self._on_snap_changed)
        for signal in (controller.changed, controller.moved):
            signal.connect(self.refresh)
        follow_words(self, self.refresh)

    def refresh(self) -> None:
        """Show the moment."""
        place, whole = self.controller.cursor_s, self.controller.motion.duration_s
        local = QLocale()
        words = (local.toString(place, "f", 2), local.toString(whole, "f", 2))
        self.time.setText(tr("{now} of {all} s", now=words[0], all=words[1]))

    def _on_speed_changed(self) -> None:
        self.player.speed = float(self.speed.currentData())

    def _on_snap_changed(self) -> None:
        self.timeline.snap_s = float(self.snap.currentData())


def snap_words() -> dict[float, str]:
    """To which times key poses can go, in words."""
    return {
        snap: tr("grid {time} s", time=f"{snap:g}") if snap else tr("no grid") for snap in SNAPS_S
    }


def _button(actions: Actions, name: str, *, has_words: bool = False) -> QToolButton:
    button = QToolButton()
    button.setDefaultAction(actions[name])
    if has_words:
        button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
    return button
