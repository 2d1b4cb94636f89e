"""The card of one robot: how it is, what it does, and what can be done for it."""

from __future__ import annotations

import re
import uuid
from collections.abc import Callable, Mapping, Sequence
from functools import partial

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import (
    QFrame,
    QLabel,
    QMenu,
    QPushButton,
    QSizePolicy,
    QToolButton,
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
from nep_studio.ui.widgets.layouts import FlowLayout, in_column, in_row
from nep_studio.ui.words import tr
from robots.body.limbs import TOUCH_SENSORS

from .participants import RobotPlan

# What is known of a robot: short facts beside each other, long ones in lines.

LOW_BATTERY = 0.2
FACTS = ("posture", "moving", "battery", "saying", "listening", "doing")
LONG = ("posture", "doing", "saying", "listening")
WRAPPED = QSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
"""How words take room that are as wide as there is room, and as high as that makes them."""
WRAPPED.setHeightForWidth(True)


class Facts(QWidget):
    """Signs with words; a fact without words takes no room."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self._parts: dict[str, tuple[QWidget, QLabel, QLabel]] = {}
        """Of each fact its place, its sign and its words."""
        self.shown: dict[str, tuple[str, str, str]] = {}
        """The icon, the words and the colour of each."""
        line = self.fontMetrics().height()
        self._short = QWidget()
        self._flow = FlowLayout(self._short, line // 2)
        self._box = in_column(self._short, of=self, margins=0, spacing=line // 5)
        look.theme_changed.connect(self._dress)

    def show_fact(self, name: str, icon_name: str, words: str, colour: str = "muted") -> None:
        """Show a fact; ``name`` is the same each time that it is told anew."""
        if self.shown.get(name) == (icon_name, words, colour):
            return
        self.shown[name] = (icon_name, words, colour)
        if name not in self._parts:
            part, sign, label = self._parts[name] = QWidget(), QLabel(), QLabel()
            label.setTextFormat(Qt.TextFormat.PlainText)
            top, gap = Qt.AlignmentFlag.AlignTop, self.fontMetrics().height() // 4
            in_row((sign, 0, top), (label, 1), of=part, margins=0, spacing=gap)
            if name in LONG:
                label.setWordWrap(True)
                label.setSizePolicy(WRAPPED)
                self._box.addWidget(part)
            else:
                self._flow.addWidget(part)
        part, _sign, label = self._parts[name]
        part.setVisible(bool(words))
        label.setText(words)
        shown = self.shown.items()
        self._short.setVisible(any(told for one, (_, told, _) in shown if one not in LONG))
        self._dress_part(name)

    def text(self) -> str:
        """All facts as sentences, for screen readers."""
        return " ".join(f"{words}." for _, words, _ in self.shown.values() if words)

    def _dress(self) -> None:
        for name in self._parts:
            self._dress_part(name)

    def _dress_part(self, name: str) -> None:
        icon_name, _, colour = self.shown[name]
        side, ratio = self.fontMetrics().height(), self.devicePixelRatioF()
        pixmap = icon_pixmap(icon_name, self._look.theme.colour(colour), side, ratio)
        self._parts[name][1].setPixmap(pixmap)


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
        self.words = labelled(QLabel(wordWrap=True), text="It has fallen.")
        self.words.setSizePolicy(WRAPPED)
        self.help_button = labelled(QPushButton(), text="Help it up", tip="Let it stand up again")
        sign, line = (self.sign, 0, Qt.AlignmentFlag.AlignVCenter), self.fontMetrics().height()
        margins = line // 3, line // 4, line // 3, line // 4
        in_row(sign, (self.words, 1), self.help_button, of=self, margins=margins)
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


BELOW_KIND = 2
"""Where a card says that its robot has fallen: below its name and its kind."""


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
        self._known: tuple[object, ...] = ()
        """What of the robot is shown."""
        self._told: tuple[RobotState | None, Sequence[str]] | None = None
        self.name, self.kind = ElidedLabel(), ElidedLabel()
        self.kind_sign, self.sign, self.health = QLabel(), QLabel(), QLabel()
        self.facts = Facts(look)
        self.fallen: FallenBar | None = None
        """It is made when the robot falls for the first time: most never do."""
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
        head = in_row((self.name, 1), self.sign, self.health)
        kind = in_row(self.kind_sign, (self.kind, 1))
        self._buttons = QWidget()
        flow = FlowLayout(self._buttons, line // 4)
        for button in (self.touch, self.back):
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
            flow.addWidget(button)
        parts = head, kind, self.facts, self._buttons
        margins = line // 2, line // 3, line // 2, line // 3
        self._box = in_column(*parts, of=self, margins=margins, spacing=line // 5)

    def show_plan(self, plan: RobotPlan) -> None:
        """Say which kind of robot it is."""
        self.plan = plan
        self._say()
        self._dress()

    def _say(self) -> None:
        self.name.set_words(self.plan.name)
        real = tr("A real NAO at {address}", address=self.plan.address or "?")
        self.kind.set_words(real if self.plan.is_real else tr("On this screen"))
        names, menu = touch_names(self._language()), self.touch.menu()
        for action in menu.actions() if menu is not None else ():
            action.setText(names.get(action.data(), action.data()))
        if self._told is not None:  # its facts in the words that are used now
            self._show_facts(*self._told)

    def show_state(self, look: StateLook, state: RobotState | None, doings: Sequence[str]) -> None:
        """Show how its node is, and what it does; None: it is not there, no more is known of it."""
        if look != self._health:
            self._health = look
            self._dress()
        self._buttons.setVisible(state is not None and not self.plan.is_real)
        known: tuple[object, ...] = ()
        if state is not None:
            battery = f"{state.battery:.0%}", state.battery < LOW_BATTERY
            says, does = (state.saying, state.listening), tuple(doings)
            known = state.posture, state.moving, state.fallen, battery, says, does
        if known != self._known or self._told is None:
            self._known, self._told = known, (state, doings)
            self._show_facts(state, doings)

    def _show_facts(self, state: RobotState | None, doings: Sequence[str]) -> None:
        """Show posture, movement, battery, what it says and listens for, and what it does."""
        facts = self.facts
        if state is None:
            for fact in FACTS:
                facts.show_fact(fact, "circle-dashed", "")
        else:
            posture = posture_words(state.posture, self._language())
            facts.show_fact("posture", "person-standing", posture)
            moves = tr("Moves") if state.moving else tr("At rest")
            facts.show_fact("moving", "footprints" if state.moving else "pause", moves)
            percent, is_low = f"{state.battery:.0%}", state.battery < LOW_BATTERY
            soon = tr("Battery {percent}: charge it soon", percent=percent)
            battery = soon if is_low else tr("Battery {percent}", percent=percent)
            colour = "warning" if is_low else "muted"
            facts.show_fact("battery", "battery-medium", battery, colour)
            says = tr("Says “{text}”", text=state.saying) if state.saying else ""
            facts.show_fact("saying", "message-square", says)
            heard = tr(" or ").join(f"“{word}”" for word in state.listening)
            listens = tr("Listens for {words}", words=heard) if heard else ""
            facts.show_fact("listening", "ear", listens)
            said = says.casefold()
            others = [one for one in doings if not said or not one.casefold().startswith(said)]
            facts.show_fact("doing", "play", "\n".join(others[:DOINGS_SHOWN]), "success")
        fell = ""
        if is_fallen := state is not None and state.fallen:
            fell = self._fallen_bar().words.text()
        if self.fallen is not None:
            self.fallen.setVisible(is_fallen)
        words = " ".join(filter(None, [self.plan.name, fell, facts.text()]))
        self.setAccessibleName(self.plan.name)
        self.setAccessibleDescription(words)

    def _fallen_bar(self) -> FallenBar:
        if self.fallen is None:
            self.fallen = FallenBar(self._look)
            self.fallen.help_button.clicked.connect(self.help_asked)
            self._box.insertWidget(BELOW_KIND, self.fallen)
        return self.fallen

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


def touch(runner: Runner, robot: str, sensor: str, is_pressed: bool) -> None:
    """Touch a sensor of a robot, or let go of it."""
    request = m.SenseRequest(robot=robot, sense=sensor, value=float(is_pressed))
    runner.send(m.SENSE_REQUEST, request)


def help_up(runner: Runner, robot: str) -> None:
    """Let a robot that lies there stand up."""
    args = {"posture": "posture_stand"}
    request = m.ActionRequest(id=uuid.uuid4().hex, robots=[robot], action="do", args=args)
    runner.send(m.ACTION_REQUEST, request)
