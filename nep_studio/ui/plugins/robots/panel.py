"""The stage: one scene with all robots of the project, and a card for each."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import msgspec
from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QCloseEvent, QHideEvent, QKeyEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QPushButton,
    QSplitter,
    QWidget,
)

from nep_core.wire import messages as m
from nep_studio.blocks.language import Language
from nep_studio.run.timeline import action_words
from nep_studio.ui.floor import Floor
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.node_style import state_look
from nep_studio.ui.running.runner import Heard, Runner, Tap
from nep_studio.ui.speech import Sound
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import hint, room_around
from nep_studio.ui.widgets.layouts import InLines, in_column, scrolled
from nep_studio.ui.words import tr

from .card import RobotCard, help_up, touch
from .participants import ORIGIN, Base, RobotPlan, Starts, look_of, robots_of, start_places
from .stage import RobotStage

# A window of its own for the scene of the robots, for a room full of people.

SHARE = 0.8


class LargeWindow(QWidget):
    """Holds a widget until it is closed; F11 fills the screen. ``closed`` tells of the end."""

    closed = Signal()

    def __init__(self, held: QWidget, parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Window)
        labelled(self, window_title="Robots")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        in_column(held, of=self, margins=self.fontMetrics().height() // 2)
        held.show()
        self.resize(room_around(parent).size() * SHARE)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Fill the screen, or leave it."""
        if event.key() == Qt.Key.Key_F11:
            self.setWindowState(self.windowState() ^ Qt.WindowState.WindowFullScreen)
        elif event.key() == Qt.Key.Key_Escape and self.isFullScreen():
            self.showNormal()
        elif event.key() == Qt.Key.Key_Escape:
            self.close()
        else:
            super().keyPressEvent(event)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Give the widget back."""
        super().closeEvent(event)
        self.closed.emit()


# What each robot is doing now, from what it was asked and what it answered.

MOST_REQUESTS = 200
"""So many are remembered, of which the oldest are forgotten."""


class Doings:
    """The actions that go on, by robot."""

    def __init__(self, language: Callable[[], Language]) -> None:
        self._language = language
        self._requests: dict[str, m.ActionRequest] = {}
        self._going_on: dict[str, dict[str, None]] = {}

    def hear(self, message: msgspec.Struct) -> bool:
        """Take in a message; whether it says what a robot does."""
        if isinstance(message, m.ActionRequest):
            self._requests[message.id] = message
            if len(self._requests) > MOST_REQUESTS:
                del self._requests[next(iter(self._requests))]
        elif isinstance(message, m.ActionResult):
            actions = self._going_on.setdefault(message.robot, {})
            if message.state == "started":
                actions[message.id] = None
            elif message.state in ("done", "failed", "cancelled"):
                actions.pop(message.id, None)
        return isinstance(message, m.ActionRequest | m.ActionResult)

    def words(self, robot: str) -> list[str]:
        """What it does, each as the predicate of a sentence."""
        requests = [self._requests.get(action) for action in self._going_on.get(robot, {})]
        found = [action_words(one, self._language(), tr) for one in requests if one is not None]
        return list(dict.fromkeys(found))

    def clear(self) -> None:
        """Nothing goes on any more."""
        self._requests.clear()
        self._going_on.clear()


MOST_FOR_CARDS = 0.35
"""Never is more of the panel's height given to the cards by itself."""


class RobotsPanel(InLines):
    """Shows the robots; it listens to them only while it, or its large window, is seen."""

    usual_lines = (18, 26)
    """Room for the scene and one card."""

    def __init__(
        self,
        runner: Runner,
        language: Callable[[], Language],
        look: Look,
        floor: Floor,
        sound: Sound,
        starts: Starts,
    ) -> None:
        super().__init__()
        self._runner, self._language, self._look = runner, language, look
        self._starts = starts
        self._doings = Doings(language)
        self._tap: Tap | None = None
        self._is_arranged = False
        self._most_wanted = 0
        """The room that the cards needed at most since the run began."""
        self._heard: dict[str, m.RobotState] = {}
        self._begin_at: dict[str, Base] = {}
        self._of_last: set[str] = set()
        """The robots of the project before this one: how they ended is nothing of this one's."""
        self.cards: dict[str, RobotCard] = {}
        self.large: LargeWindow | None = None
        self.stage = RobotStage(look, floor, sound, language)
        self.elsewhere = labelled(QPushButton(), text="Back into the panel")
        self._lay_out()
        self.stage.touched.connect(partial(touch, runner))
        self.stage.chosen.connect(self._on_chosen)
        self.stage.tools.large.clicked.connect(self.show_large)
        self.elsewhere.clicked.connect(lambda: self.show_large(False))
        runner.arrived.connect(self._on_arrived)
        runner.nodes_changed.connect(self._on_nodes_changed)
        runner.state_changed.connect(self._on_state_changed)
        runner.disconnected.connect(self._on_disconnected)
        follow_words(self, self.refresh)

    def _lay_out(self) -> None:
        labelled(self, name="Stage")
        self.hint = hint(
            "No robot takes part yet. Press + beside the tabs, open the page Robots and add one:"
            " it may be one on this screen."
        )
        self.hint.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.elsewhere.hide()
        inner = QWidget()
        self._cards_box = in_column(self.hint, 1, of=inner, margins=0)
        inner.installEventFilter(self)
        self.area = labelled(scrolled(inner), name="Robots")
        self.area.setMinimumHeight(self.fontMetrics().height() * 2)  # Qt's leaves the robot less
        self.split = QSplitter(Qt.Orientation.Vertical, childrenCollapsible=False)
        self.split.addWidget(self.stage)
        self.split.addWidget(self.area)
        self.split.setStretchFactor(0, 1)
        self.split.splitterMoved.connect(self._on_split_moved)
        in_column(self.elsewhere, self.split, of=self, margins=self.fontMetrics().height() // 3)

    # What is shown

    def begin_anew(self) -> None:
        """Another project is shown: its robots stand where they begin; one that runs goes on."""
        nodes = self._runner.board.nodes
        self._of_last = {name for name, node in nodes.items() if node.type == "action"}
        for name in self.cards:
            if name not in nodes or not nodes[name].is_there:
                self._send_home(name)
        self._doings.clear()
        self.stage.view.clear_paths()
        self.refresh()

    def _send_home(self, name: str) -> None:
        self._heard.pop(name, None)
        self.stage.remove_robot(name)  # it stands where it begins when it is shown next

    def refresh(self) -> None:
        """Take the robots of the project as it is now; does nothing while nobody looks."""
        if self._tap is None:
            return
        planned = self._runner.planned()
        plans = {plan.name: plan for plan in robots_of(planned)}
        self._begin_at = start_places(planned)
        nodes = self._runner.board.nodes.values()
        there = [node.name for node in nodes if node.type == "action" and node.is_there]
        for name in [*self._heard, *there]:
            plans.setdefault(name, RobotPlan(name))
        for name in self.cards.keys() - plans.keys():
            self.stage.remove_robot(name)
            gone = self.cards.pop(name)
            gone.hide()
            gone.deleteLater()
        for place, plan in enumerate(plans.values()):
            card = self.cards.get(plan.name)
            if card is None:
                card = self.cards[plan.name] = RobotCard(plan, self._language, self._look)
                card.touched.connect(partial(touch, self._runner, plan.name))
                card.help_asked.connect(partial(help_up, self._runner, plan.name))
                card.start_asked.connect(partial(self._on_start_asked, plan.name))
            if plan != card.plan:
                card.show_plan(plan)
            self._cards_box.insertWidget(place, card)
            self._show_robot(plan.name)
        self._give_room()
        self.hint.setVisible(not self.cards)

    def _give_room(self) -> None:
        """Let the cards have the room that they need, unless somebody has chosen it.

        As long as a program runs they keep it: what is said comes and goes, the scene stays.
        """
        total, needed = sum(self.split.sizes()), self._cards_box.sizeHint().height()
        self._most_wanted = max(needed, self._most_wanted * (self._runner.state != "idle"))
        wanted = min(self._most_wanted, round(total * MOST_FOR_CARDS))
        if total and not self._is_arranged and self.large is None:
            self.split.setSizes([total - wanted, wanted])

    def _on_split_moved(self) -> None:
        self._is_arranged = True

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Share the height anew."""
        super().resizeEvent(event)
        self._give_room()

    def show_large(self, is_large: bool) -> None:
        """Show the scene in a window of its own, or in the panel again."""
        if is_large and self.large is None:
            self.large = LargeWindow(self.stage, self)
            self.large.closed.connect(self._on_large_closed)
            self.large.installEventFilter(self)
            self.large.show()
        elif not is_large and self.large is not None:
            self.large.close()
        self.elsewhere.setVisible(self.large is not None)
        self.stage.tools.show_large(self.large is not None)

    def _show_robot(self, name: str) -> None:
        card, status = self.cards[name], self._runner.board.nodes.get(name)
        state = self._heard.get(name)
        if status is not None and (status.is_there or name not in self._of_last):
            look, is_there = state_look(status), status.is_there
        else:
            look, is_there = look_of(state), state is not None
        shown = state if is_there else None
        self.stage.show_robot(card.plan, shown, self._begin_at.get(name, ORIGIN))
        card.show_state(look, shown, self._doings.words(name) if is_there else ())

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
        if self._tap is None:
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
            if not node.is_there and node.name in self._of_last:
                self._send_home(node.name)
            elif not node.is_there:
                self._heard.pop(node.name, None)
        if robots:
            self.refresh()

    def _on_state_changed(self, state: str) -> None:
        if state == "starting":
            self._of_last.clear()
        if state in ("starting", "idle"):
            self._doings.clear()
            self.refresh()

    def _on_disconnected(self) -> None:
        self._heard.clear()
        self._doings.clear()
        self.refresh()

    def _on_chosen(self, robot: str) -> None:
        if card := self.cards.get(robot):
            self.area.ensureWidgetVisible(card)

    def _on_start_asked(self, robot: str) -> None:
        self._starts.put_back(robot)
        self.stage.view.clear_paths()

    def _on_large_closed(self) -> None:
        self.large = None
        self.split.insertWidget(0, self.stage)
        self._give_room()
        self.elsewhere.hide()
        self.stage.tools.show_large(False)
        self._listen()

    # Listening

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Follow whether the large window is seen, and how much room the cards need."""
        if watched is not self.large:
            if event.type() == QEvent.Type.LayoutRequest:
                self._give_room()
        elif event.type() in (QEvent.Type.Show, QEvent.Type.Hide):
            self._listen()
        return super().eventFilter(watched, event)

    def _listen(self) -> None:
        """Hear where robots are while somebody looks; what they did meanwhile is not known."""
        is_seen = self.isVisible() or (self.large is not None and self.large.isVisible())
        if is_seen and self._tap is None:
            self._tap = self._runner.tap(m.ROBOT_STATE, kind=m.RobotState, parent=self)
            self._tap.arrived.connect(self._on_states)
            self.refresh()
        elif not is_seen and self._tap is not None:
            self._tap.close()
            self._tap = None
            self._doings.clear()

    def showEvent(self, event: QShowEvent) -> None:
        """Begin to listen."""
        super().showEvent(event)
        self.stage.view.show()
        self._listen()

    def hideEvent(self, event: QHideEvent) -> None:
        """Listen no more, unless the large window is seen."""
        super().hideEvent(event)
        self._listen()
