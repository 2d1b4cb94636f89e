"""The card of one robot: how it is, what it does, and what can be done for it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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
    QWidget,
)

from nep_core.messages import RobotState
from nep_studio.blocks.language import Language
from nep_studio.ui.actions_icons import icon_room
from nep_studio.ui.elided_label import ElidedLabel
from nep_studio.ui.panels.flow import FlowLayout
from nep_studio.ui.panels.nodes.looks import StateLook
from nep_studio.ui.theme import Look, icon, icon_pixmap
from nep_studio.ui.words import tr
from nodes.action.naobody.touch import TOUCH_SENSORS

from .facts import Facts, show_state
from .fallen_bar import FallenBar
from .plans import RobotPlan

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

    def __init__(self, plan: RobotPlan, language: Language, look: Look) -> None:
        super().__init__()
        self.plan = plan
        self._language, self._look = language, look
        self._health: StateLook | None = None
        self.name, self.kind = ElidedLabel(), ElidedLabel()
        self.kind_sign, self.sign, self.health = QLabel(), QLabel(), QLabel()
        self.facts = Facts(look)
        self.fallen = FallenBar(look)
        self.touch, self.back = QToolButton(), QToolButton()
        self._fill_touch_menu(language.choices.get("touch_parts", {}))
        self._lay_out()
        self.fallen.help_button.clicked.connect(self.help_asked)
        self.back.clicked.connect(self.start_asked)
        look.theme_changed.connect(self._dress)
        self.show_plan(plan)
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

    def _fill_touch_menu(self, names: Mapping[str, str]) -> None:
        menu = QMenu(self.touch)
        for sensor in TOUCH_SENSORS:
            menu.addAction(names.get(sensor, sensor)).triggered.connect(
                partial(self._touch_for_a_moment, sensor)
            )
        self.touch.setMenu(menu)
        self.touch.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.touch.setText(tr("Touch"))
        self.touch.setToolTip(tr("Touch it here, or click its head, hands, feet or chest"))
        self.back.setText(tr("Back to start"))
        self.back.setToolTip(tr("Put the robot back to where it began"))

    def show_plan(self, plan: RobotPlan) -> None:
        """Say which kind of robot it is."""
        if plan != self.plan or not self.kind.words:
            self.plan = plan
            self.name.set_words(plan.name)
            self.kind.set_words(plan.words)
            self._dress()

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
        """Show the robot as it is now."""
        show_state(self.facts, state, self._language)
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
