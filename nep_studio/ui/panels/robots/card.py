"""The card of one robot: its picture, what it says, how it is, what it does."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QMenu,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
)

from nep_core.messages import RobotState
from nep_studio.blocks.language import Language
from nep_studio.ui.actions_icons import icon_room
from nep_studio.ui.elided_label import ElidedLabel
from nep_studio.ui.panels.nodes.looks import StateLook
from nep_studio.ui.theme import Look, icon, icon_pixmap
from nep_studio.ui.words import tr

from .bubble import SpeechBubble
from .facts import Facts, show_state
from .scene import PARTS, RobotScene

TOUCH_MS = 500
"""How long a touch from the menu lasts."""
DOINGS_SHOWN = 3


@dataclass(frozen=True)
class RobotPlan:
    """A robot that takes part: a real one at an address, or one on the screen."""

    name: str
    is_real: bool = False
    address: str = ""

    @property
    def words(self) -> str:
        """Which kind of robot it is."""
        if not self.is_real:
            return tr("On this screen")
        return tr("A real NAO at {address}", address=self.address or "?")


class RobotCard(QFrame):
    """Shows one robot; ``touched`` gives a sensor, and whether it is pressed or let go."""

    touched = Signal(str, bool)

    def __init__(self, plan: RobotPlan, language: Language, look: Look) -> None:
        super().__init__()
        self.plan = plan
        self._language, self._look = language, look
        self._health: StateLook | None = None
        touch_names = language.choices.get("touch_parts", {})
        self.name, self.kind = QLabel(plan.name), ElidedLabel()
        self.sign, self.health = QLabel(), QLabel()
        self.bubble = SpeechBubble(look)
        self.scene = RobotScene(look, touch_names)
        self.facts = Facts(look)
        self.touch = QToolButton()
        self._fill_touch_menu(touch_names)
        self._lay_out()
        self.scene.touched.connect(self.touched)
        look.theme_changed.connect(self._dress)
        self.show_plan(plan)
        self._dress()

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.setProperty("kind", "card")
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        self.name.setProperty("role", "heading")
        self.name.setTextFormat(Qt.TextFormat.PlainText)
        self.name.setWordWrap(True)
        self.kind.setProperty("role", "hint")
        head = QHBoxLayout()
        head.addWidget(self.name, 1)
        head.addWidget(self.sign)
        head.addWidget(self.health)
        foot = QHBoxLayout()
        foot.addWidget(self.kind, 1)
        foot.addWidget(self.touch)
        box = QVBoxLayout(self)
        box.setSpacing(line // 4)
        box.addLayout(head)
        box.addWidget(self.bubble)
        box.addWidget(self.scene)
        box.addWidget(self.facts)
        box.addLayout(foot)

    def _fill_touch_menu(self, names: Mapping[str, str]) -> None:
        menu = QMenu(self.touch)
        for sensor in PARTS:
            menu.addAction(names.get(sensor, sensor)).triggered.connect(
                partial(self._touch_for_a_moment, sensor)
            )
        self.touch.setMenu(menu)
        self.touch.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.touch.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.touch.setText(tr("Touch"))
        self.touch.setToolTip(tr("Touch it here, or click its head, hands, feet or chest"))

    def show_plan(self, plan: RobotPlan) -> None:
        """Say which kind of robot it is."""
        self.plan = plan
        self.kind.set_words(plan.words)

    def show_health(self, look: StateLook, *, is_there: bool) -> None:
        """Show how its node is; a robot that is not there is pale and silent."""
        if not is_there:
            self.scene.show_state(None)
            self.bubble.say("")
            for fact in ("posture", "moving", "battery", "listening"):
                self.facts.show_fact(fact, "circle-dashed", "")
            self.show_doings(())
        self.bubble.setVisible(is_there)
        can_touch = is_there and not self.plan.is_real
        self.scene.is_touchable = can_touch
        self.touch.setVisible(can_touch)
        if look != self._health:
            self._health = look
            self._dress()

    def show_state(self, state: RobotState) -> None:
        """Show the robot as it is now."""
        self.scene.show_state(state)
        self.bubble.say(state.saying)
        show_state(self.facts, state, self._language)
        self._describe()

    def show_doings(self, doings: Sequence[str]) -> None:
        """Say what it does."""
        shown = "\n".join(doings[:DOINGS_SHOWN])
        self.facts.show_fact("doing", "play", shown, "success")
        self._describe()

    def _describe(self) -> None:
        says = tr("Says “{text}”", text=self.bubble.words) if self.bubble.words else ""
        words = " ".join(filter(None, [self.plan.name, self.facts.text(), says]))
        if words != self.accessibleDescription():
            self.setAccessibleName(self.plan.name)
            self.setAccessibleDescription(words)

    def _touch_for_a_moment(self, sensor: str) -> None:
        self.touched.emit(sensor, True)
        QTimer.singleShot(TOUCH_MS, self, lambda: self.touched.emit(sensor, False))

    def _dress(self) -> None:
        theme = self._look.theme
        self.touch.setIcon(icon("hand", theme))
        self.touch.setIconSize(icon_room(self.fontMetrics().height()))
        if self._health is not None:
            side, ratio = self.fontMetrics().height(), self.devicePixelRatioF()
            colour = theme.colour(self._health.colour)
            self.sign.setPixmap(icon_pixmap(self._health.icon, colour, side, ratio))
            self.health.setText(self._health.word)
