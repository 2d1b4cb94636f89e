"""The card of one robot: how it is, what it does, and what can be done for it."""

from __future__ import annotations

import re
import uuid
from collections.abc import Callable, Mapping, Sequence
from functools import partial

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QMenu,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from nep_core.wire import messages as m
from nep_core.wire.messages import RobotState
from nep_studio.blocks.language import Language
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.node_style import StateLook
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme.icons import icon, icon_pixmap, icon_room
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import ElidedLabel
from nep_studio.ui.widgets.layouts import FlowLayout
from nep_studio.ui.words import tr
from robots.body.limbs import TOUCH_SENSORS

from .participants import RobotPlan

# What is known of a robot: short facts beside each other, long ones in lines.

LOW_BATTERY = 0.2
LONG = ("doing", "saying", "listening")


class Facts(QWidget):
    """Signs with words; a fact without words takes no room."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self._parts: dict[str, tuple[QWidget, QLabel, QLabel]] = {}
        """Of each fact its place, its sign and its words."""
        self._shown: dict[str, tuple[str, str, str]] = {}
        line = self.fontMetrics().height()
        self._short = QWidget()
        self._flow = FlowLayout(self._short, line // 2)
        self._box = QVBoxLayout(self)
        self._box.setContentsMargins(0, 0, 0, 0)
        self._box.setSpacing(line // 5)
        self._box.addWidget(self._short)
        look.theme_changed.connect(self._dress)

    def show_fact(self, name: str, icon_name: str, words: str, colour: str = "muted") -> None:
        """Show a fact; ``name`` is the same each time that it is told anew."""
        if self._shown.get(name) == (icon_name, words, colour):
            return
        self._shown[name] = (icon_name, words, colour)
        part, _sign, label = self._parts.get(name) or self._add(name)
        part.setVisible(bool(words))
        label.setText(words)
        self._short.setVisible(any(self.words(one) for one in self._shown if one not in LONG))
        self._dress_part(name)

    def words(self, name: str) -> str:
        """What a fact says; "" when it says nothing."""
        return self._shown.get(name, ("", "", ""))[1]

    def text(self) -> str:
        """All facts as sentences, for screen readers."""
        return " ".join(f"{words}." for _, words, _ in self._shown.values() if words)

    def _add(self, name: str) -> tuple[QWidget, QLabel, QLabel]:
        """A place for a sign and words."""
        part, sign, label = self._parts[name] = QWidget(), QLabel(), QLabel()
        label.setTextFormat(Qt.TextFormat.PlainText)
        row = QHBoxLayout(part)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(self.fontMetrics().height() // 4)
        row.addWidget(sign, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(label, 1)
        if name in LONG:
            label.setWordWrap(True)
            label.setSizePolicy(wrapped())
            self._box.addWidget(part)
        else:
            self._flow.addWidget(part)
        return part, sign, label

    def _dress(self) -> None:
        for name in self._parts:
            self._dress_part(name)

    def _dress_part(self, name: str) -> None:
        icon_name, _, colour = self._shown[name]
        side, ratio = self.fontMetrics().height(), self.devicePixelRatioF()
        pixmap = icon_pixmap(icon_name, self._look.theme.colour(colour), side, ratio)
        self._parts[name][1].setPixmap(pixmap)


def wrapped() -> QSizePolicy:
    """How words take room that are as wide as there is room, and as high as that makes them."""
    policy = QSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
    policy.setHeightForWidth(True)
    return policy


def posture_words(posture: str, language: Language) -> str:
    """A posture, as the robot names it, in words: "LyingBack" is “lying on the back”."""
    if not posture:
        return ""
    key = "posture" + re.sub("([A-Z])", r"_\1", posture).lower()
    words = language.choices.get("postures", {}).get(key, posture)
    return tr("Posture: {posture}", posture=words)


# Says that a robot has fallen, and offers to help it up.


class FallenBar(QFrame):
    """A sign, a word and a button; seen only while the robot lies there."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.setProperty("kind", "warning")
        self.sign = QLabel()
        self.words = labelled(QLabel(), text="It has fallen.")
        self.words.setWordWrap(True)
        self.words.setSizePolicy(wrapped())
        self.help_button = labelled(QPushButton(), text="Help it up", tip="Let it stand up again")
        row = QHBoxLayout(self)
        line = self.fontMetrics().height()
        row.setContentsMargins(line // 3, line // 4, line // 3, line // 4)
        row.addWidget(self.sign, 0, Qt.AlignmentFlag.AlignVCenter)
        row.addWidget(self.words, 1)
        row.addWidget(self.help_button)
        self.hide()
        look.theme_changed.connect(self._dress)
        self._dress()

    def _dress(self) -> None:
        theme, line = self._look.theme, self.fontMetrics().height()
        colour = theme.colour("warning")
        ratio = self.devicePixelRatioF()
        self.sign.setPixmap(icon_pixmap("triangle-alert", colour, line, ratio))
        self.help_button.setIcon(icon("arrow-up", theme))


TOUCH_MS = 500
"""How long a touch from the menu lasts."""
DOINGS_SHOWN = 3


class RobotCard(QFrame):
    """Shows one robot.

    ``touched`` gives a sensor, and whether it is pressed or let go; ``help_asked`` that it is to
    stand up; ``start_asked`` that it is to be back where it began.
    """

    touched = Signal(str, bool)
    help_asked = Signal()
    start_asked = Signal()

    def __init__(self, plan: RobotPlan, language: Callable[[], Language], look: Look) -> None:
        super().__init__()
        self.plan = plan
        self._language, self._look = language, look
        self._health: StateLook | None = None
        self.name, self.kind = ElidedLabel(), ElidedLabel()
        self.kind_sign, self.sign, self.health = QLabel(), QLabel(), QLabel()
        self.facts = Facts(look)
        self.fallen = FallenBar(look)
        self.touch, self.back = QToolButton(), QToolButton()
        menu = QMenu(self.touch)
        for sensor in TOUCH_SENSORS:
            action = menu.addAction("")
            action.setData(sensor)
            action.triggered.connect(partial(self._touch_for_a_moment, sensor))
        self.touch.setMenu(menu)
        self.touch.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        labelled(
            self.touch, text="Touch", tip="Touch it here, or click its head, hands, feet or chest"
        )
        labelled(self.back, text="Back to start", tip="Put the robot back to where it began")
        self._lay_out()
        self.fallen.help_button.clicked.connect(self.help_asked)
        self.back.clicked.connect(self.start_asked)
        look.theme_changed.connect(self._dress)
        follow_words(self, self._say)
        self._dress()

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.setProperty("kind", "card")
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        self.name.setProperty("role", "heading")
        self.name.setTextFormat(Qt.TextFormat.PlainText)
        self.kind.setTextFormat(Qt.TextFormat.PlainText)
        self.kind.setProperty("role", "hint")
        head = QHBoxLayout()
        head.addWidget(self.name, 1)
        head.addWidget(self.sign)
        head.addWidget(self.health)
        kind = QHBoxLayout()
        kind.addWidget(self.kind_sign)
        kind.addWidget(self.kind, 1)
        self._buttons = QWidget()
        flow = FlowLayout(self._buttons, line // 4)
        for button in (self.touch, self.back):
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
            flow.addWidget(button)
        box = QVBoxLayout(self)
        box.setSpacing(line // 5)
        box.setContentsMargins(line // 2, line // 3, line // 2, line // 3)
        box.addLayout(head)
        box.addLayout(kind)
        box.addWidget(self.fallen)
        box.addWidget(self.facts)
        box.addWidget(self._buttons)

    def show_plan(self, plan: RobotPlan) -> None:
        """Say which kind of robot it is."""
        if plan != self.plan:
            self.plan = plan
            self._say()
            self._dress()

    def _say(self) -> None:
        self.name.set_words(self.plan.name)
        self.kind.set_words(self.plan.words)
        names, menu = touch_names(self._language()), self.touch.menu()
        for action in menu.actions() if menu is not None else ():
            action.setText(names.get(action.data(), action.data()))

    def show_health(self, look: StateLook, *, is_there: bool) -> None:
        """Show how its node is; of a robot that is not there nothing more is known."""
        if not is_there:
            for fact in ("posture", "moving", "battery", "saying", "listening"):
                self.facts.show_fact(fact, "circle-dashed", "")
            self.show_doings(())
            self.fallen.setVisible(False)
        self._buttons.setVisible(is_there and not self.plan.is_real)
        if look != self._health:
            self._health = look
            self._dress()

    def show_state(self, state: RobotState) -> None:
        """Show posture, movement, battery, and what it says and listens for."""
        facts, percent = self.facts, f"{state.battery:.0%}"
        facts.show_fact(
            "posture", "person-standing", posture_words(state.posture, self._language())
        )
        moves = tr("Moves") if state.moving else tr("At rest")
        facts.show_fact("moving", "footprints" if state.moving else "pause", moves)
        is_low = state.battery < LOW_BATTERY
        battery = tr("Battery {percent}", percent=percent)
        if is_low:
            battery = tr("Battery {percent}: charge it soon", percent=percent)
        facts.show_fact("battery", "battery-medium", battery, "warning" if is_low else "muted")
        says = tr("Says “{text}”", text=state.saying) if state.saying else ""
        facts.show_fact("saying", "message-square", says)
        heard = tr(" or ").join(f"“{word}”" for word in state.listening)
        facts.show_fact("listening", "ear", tr("Listens for {words}", words=heard) if heard else "")
        self.fallen.setVisible(state.fallen)
        self._describe()

    def show_doings(self, doings: Sequence[str]) -> None:
        """Say what it does."""
        said = self.facts.words("saying").casefold()
        others = [one for one in doings if not said or not one.casefold().startswith(said)]
        shown = "\n".join(others[:DOINGS_SHOWN])
        self.facts.show_fact("doing", "play", shown, "success")
        self._describe()

    def _describe(self) -> None:
        fell = self.fallen.words.text() if not self.fallen.isHidden() else ""
        words = " ".join(filter(None, [self.plan.name, fell, self.facts.text()]))
        if words != self.accessibleDescription():
            self.setAccessibleName(self.plan.name)
            self.setAccessibleDescription(words)

    def _touch_for_a_moment(self, sensor: str) -> None:
        self.touched.emit(sensor, True)
        QTimer.singleShot(TOUCH_MS, self, lambda: self.touched.emit(sensor, False))

    def _dress(self) -> None:
        theme, line = self._look.theme, self.fontMetrics().height()
        ratio = self.devicePixelRatioF()
        for button, name in ((self.touch, "hand"), (self.back, "house")):
            button.setIcon(icon(name, theme))
            button.setIconSize(icon_room(line))
        kind = "plug" if self.plan.is_real else "monitor"
        self.kind_sign.setPixmap(icon_pixmap(kind, theme.colour("muted"), line, ratio))
        if self._health is not None:
            colour = theme.colour(self._health.colour)
            self.sign.setPixmap(icon_pixmap(self._health.icon, colour, line, ratio))
            self.health.setText(self._health.word)


def touch_names(language: Language) -> Mapping[str, str]:
    """What the places are called that can be touched."""
    return language.choices.get("touch_parts", {})


# What a person asks robots on the screen for by hand.


class Asking:
    """Touches robots, and helps them up."""

    def __init__(self, runner: Runner) -> None:
        self._runner = runner

    def touch(self, robot: str, sensor: str, is_pressed: bool) -> None:
        """Touch a sensor, or let go of it."""
        request = m.SenseRequest(robot=robot, sense=sensor, value=float(is_pressed))
        self._runner.send(m.SENSE_REQUEST, request)

    def help_up(self, robot: str) -> None:
        """Let a robot that lies there stand up."""
        request = m.ActionRequest(
            id=uuid.uuid4().hex, robots=[robot], action="do", args={"posture": "posture_stand"}
        )
        self._runner.send(m.ACTION_REQUEST, request)
