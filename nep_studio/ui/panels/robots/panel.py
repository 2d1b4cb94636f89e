"""The robots panel: a card for each robot of the project, and for each that is heard."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING

import msgspec
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import QFrame, QLabel, QScrollArea, QVBoxLayout, QWidget

from nep_core import messages as m
from nep_studio.blocks.language import Language
from nep_studio.plan import PlannedNode
from nep_studio.ui.main_window_panels import Panel
from nep_studio.ui.panels.nodes.looks import StateLook, state_look
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.running.tap import Heard, Tap
from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr

from .card import RobotCard, RobotPlan
from .doings import Doings

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow

ACTION = "action/"


class RobotsPanel(QScrollArea):
    """Shows the robots; it listens to them only while it is seen."""

    def __init__(self, runner: Runner, language: Language, look: Look) -> None:
        super().__init__()
        self._runner, self._language, self._look = runner, language, look
        self._doings = Doings(language, tr)
        self._tap: Tap | None = None
        self._heard: dict[str, m.RobotState] = {}
        self.cards: dict[str, RobotCard] = {}
        self.hint = QLabel()
        self._lay_out()
        runner.arrived.connect(self._on_arrived)
        runner.nodes_changed.connect(self._on_nodes_changed)
        runner.state_changed.connect(self._on_state_changed)
        runner.disconnected.connect(self._on_disconnected)

    def _lay_out(self) -> None:
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setAccessibleName(tr("Robots"))
        self.hint.setText(
            tr("No robot takes part yet. Add one on the Robots page: it may be one on this screen.")
        )
        self.hint.setWordWrap(True)
        self.hint.setProperty("role", "hint")
        self.hint.setAlignment(Qt.AlignmentFlag.AlignCenter)
        inner = QWidget()
        self._box = QVBoxLayout(inner)
        self._box.addWidget(self.hint)
        self._box.addStretch(1)
        self.setWidget(inner)

    def sizeHint(self) -> QSize:
        """Room for one robot."""
        line = self.fontMetrics().height()
        return QSize(line * 16, line * 24)

    # What is shown

    def refresh(self) -> None:
        """Take the robots of the project as it is now; does nothing while it is hidden."""
        if not self.isVisible():
            return
        plans = {plan.name: plan for plan in robots_of(self._runner.planned())}
        for name in [*self._heard, *self._nodes_there()]:
            plans.setdefault(name, RobotPlan(name))
        for name in self.cards.keys() - plans.keys():
            card = self.cards.pop(name)
            card.hide()
            card.deleteLater()
        for place, plan in enumerate(plans.values()):
            card = self.cards.get(plan.name) or self._add_card(plan)
            card.show_plan(plan)
            self._box.insertWidget(place, card)
            self._show_robot(plan.name)
        self.hint.setVisible(not self.cards)

    def _nodes_there(self) -> list[str]:
        nodes = self._runner.board.nodes.values()
        return [node.name for node in nodes if node.type == "action" and node.is_there]

    def _add_card(self, plan: RobotPlan) -> RobotCard:
        card = self.cards[plan.name] = RobotCard(plan, self._language, self._look)
        card.touched.connect(partial(self._on_touched, plan.name))
        return card

    def _show_robot(self, name: str) -> None:
        card, status = self.cards[name], self._runner.board.nodes.get(name)
        state = self._heard.get(name)
        if status is not None:
            look, is_there = state_look(status), status.is_there
        else:
            look, is_there = _look_of(state), state is not None
        card.show_health(look, is_there=is_there)
        if is_there and state is not None:
            card.show_state(state)
            card.show_doings(self._doings.words(name))

    # What happens

    def _on_states(self, batch: list[Heard]) -> None:
        """Only the last state of each robot counts."""
        latest = {heard.message.robot: heard.message for heard in batch}
        is_new = not latest.keys() <= self.cards.keys()
        self._heard |= latest
        if is_new:
            self.refresh()
            return
        for name in latest:
            self._show_robot(name)

    def _on_arrived(self, batch: list[tuple[str, msgspec.Struct]]) -> None:
        if not self.isVisible():
            return
        told = [message for _, message in batch if self._doings.hear(message)]
        names = {one.robot for one in told if isinstance(one, m.ActionResult)}
        for name in names & self.cards.keys():
            self._show_robot(name)

    def _on_nodes_changed(self, names: list[str]) -> None:
        nodes = self._runner.board.nodes
        changed = [nodes[name] for name in names if name in nodes]
        robots = [node for node in changed if node.type == "action"]
        for node in robots:
            if not node.is_there:
                self._heard.pop(node.name, None)
        if robots:
            self.refresh()

    def _on_state_changed(self, state: str) -> None:
        if state in ("starting", "idle"):
            self._doings.clear()
            self.refresh()

    def _on_disconnected(self) -> None:
        self._heard.clear()
        self._doings.clear()
        self.refresh()

    def _on_touched(self, robot: str, sensor: str, is_pressed: bool) -> None:
        request = m.SenseRequest(robot=robot, sense=sensor, value=float(is_pressed))
        self._runner.send(m.SENSE_REQUEST, request)

    def showEvent(self, event: QShowEvent) -> None:
        """Begin to listen."""
        super().showEvent(event)
        if self._tap is None:
            self._tap = self._runner.tap(m.ROBOT_STATE, kind=m.RobotState, parent=self)
            self._tap.arrived.connect(self._on_states)
        self.refresh()

    def hideEvent(self, event: QHideEvent) -> None:
        """Listen no more; what robots did meanwhile is not known then."""
        super().hideEvent(event)
        if self._tap is not None:
            self._tap.close()
            self._tap = None
        self._doings.clear()


def robots_of(planned: Iterable[PlannedNode]) -> list[RobotPlan]:
    """The robots among the nodes that a project needs."""
    return [
        RobotPlan(
            str(node.parameters.get("robot", node.name)),
            node.parameters.get("driver") == "naoqi",
            str(node.parameters.get("address", "")),
        )
        for node in planned
        if node.node.startswith(ACTION)
    ]


def _look_of(state: m.RobotState | None) -> StateLook:
    """How a robot is whose node has told nothing yet."""
    if state is None:
        return StateLook("circle-dashed", "muted", tr("Not started"))
    return StateLook("circle-check", "success", tr("Ready"))


def add_robots_panel(window: MainWindow) -> Panel:
    """Put the robots beside the canvas; they follow the Robots page."""
    studio = window.studio
    panel = RobotsPanel(window.running.runner, studio.language, studio.look)
    window.workbench.problems_found.connect(lambda _problems: panel.refresh())
    return window.add_side_panel(panel, tr("Robots"), "bot", "right", is_shown=False)
