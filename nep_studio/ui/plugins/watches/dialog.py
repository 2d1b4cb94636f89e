"""The dialog that connects a watch or phone: what one has, the steps, what arrives, using it."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

from PySide6.QtCore import QObject, QSize, Qt, QTimer, Signal
from PySide6.QtWidgets import QDialog, QPushButton, QStackedWidget, QWidget

from nep_core.errors import NepError
from nep_studio.problems import Problem, problem_of
from nep_studio.run.plan import PlannedNode, Setting
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.watch_view.indicators import WatchListener
from nep_studio.ui.widgets.forms import fit_on_screen, room_around
from nep_studio.ui.widgets.layouts import in_column, in_row, scrolled, show_top
from nep_studio.ui.words import is_right_to_left, tr

from .choosing import ChoosingPage
from .connector_page import Known, WayPage
from .connectors import CONNECTORS, ConnectorKind

# Runs the node of a watch while it is being connected; what ran before comes back if unused.

State = Literal["off", "starting", "listening", "failed"]


class WatchTrial(QObject):
    """One node of one name, with the settings that were wanted last.

    ``changed`` tells of a new ``state``; a failed one has a ``problem``. It outlives the dialog
    when that is closed while the node starts, and goes by itself after ``end``.
    """

    changed = Signal()

    def __init__(self, runner: Runner, name: str, parent: QObject) -> None:
        super().__init__(parent)
        self.name = name
        self.state: State = "off"
        self.problem: Problem | None = None
        self.before = runner.started.get(name) if _runs(runner, name) else None
        """What ran under this name when it began."""
        self._runner = runner
        self._wanted: PlannedNode | None = None
        self._started: PlannedNode | None = None
        self._pid_before = 0
        self._has_ended = False
        # Go on for a trial that has ended, but whose node is still starting
        for one in parent.findChildren(WatchTrial):
            if one is not self and one.name == self.name and one.state == "starting":
                self.state, self.before = one.state, one.before
                self._started, self._pid_before = one._started, one._pid_before
                self._runner.nodes_changed.disconnect(one._on_nodes_changed)
                self._runner.node_failed.disconnect(one._on_node_failed)
                one.deleteLater()
        runner.told_elsewhere.add(name)
        runner.nodes_changed.connect(self._on_nodes_changed)
        runner.node_failed.connect(self._on_node_failed)

    def want(self, planned: PlannedNode) -> None:
        """Let this node run from now on."""
        self._wanted = planned
        if self.state != "starting":
            self._start()

    def stop(self) -> None:
        """Let it run no longer; what ran before comes back."""
        self._wanted = None
        if self.state == "starting":
            return  # a node cannot be stopped before it is there: that follows
        if self._started is not None and not self._is_needed:
            if self.before is not None:
                if not is_same(self.before, self._runner.started.get(self.name)):
                    self._runner.start_node(self.before)
            else:
                self._runner.stop_node(self.name)
        self._started = None
        self._set_state("off")

    def end(self) -> None:
        """Stop, and go."""
        self._has_ended = True
        if self.state == "starting":
            self._wanted = None
        else:
            is_to_end = self._started is not None and self.before is None and not self._is_needed
            self.stop()
            if not is_to_end:
                self._leave()  # else it goes with its node

    def keep(self, planned: PlannedNode | None) -> None:
        """Go, but let the node run on, as this one of the project's plan."""
        if planned is not None and is_same(planned, self._runner.started.get(self.name)):
            self._runner.local.planned[self.name] = planned  # so that Run takes it over
        self._leave()

    def _leave(self) -> None:
        self._runner.told_elsewhere.discard(self.name)
        self.deleteLater()

    def _forget_node(self) -> None:
        """It was only tried: nobody has to see that it has stopped."""
        if self._runner.board.forget(self.name):
            self._runner.local.planned.pop(self.name, None)
            self._runner.nodes_changed.emit([self.name])
        status = self._runner.board.nodes.get(self.name)
        if status is None or self.before is not None:
            self._leave()

    def _start(self) -> None:
        wanted = self._wanted
        if wanted is None:
            return
        is_known = is_same(wanted, self._runner.started.get(self.name))
        if is_known and _runs(self._runner, self.name):
            self._started = wanted
            self._set_state("listening")
            return
        status = self._runner.board.nodes.get(self.name)
        self._pid_before = status.pid if status is not None else 0
        self._started = wanted
        self.problem = None
        self._set_state("starting")
        # What a stranger's project says is not yet what the person has chosen: it is asked about
        is_strangers = self._runner.is_as_in_project(wanted)
        self._runner.start_node(wanted, is_wanted=not is_strangers)

    @property
    def _is_needed(self) -> bool:
        """Whether a program that runs has taken the node over, as it is."""
        mine = self._runner.started.get(self.name)
        planned = self._runner.planned() if self._runner.state != "idle" else ()
        return any(is_same(one, mine) for one in planned)

    def _on_nodes_changed(self, names: list[str]) -> None:
        status = self._runner.board.nodes.get(self.name)
        if self.name not in names or status is None:
            return
        if self._has_ended and self.state == "off":
            self._forget_node()
            return
        if self.state == "starting" and status.pid != self._pid_before:
            if status.health in ("ready", "busy", "warning"):
                self._go_on("listening")
        elif self.state == "listening" and not status.is_there:
            title = tr("“{name}” has ended unexpectedly", name=self.name)
            steps = ("Look into its log.", "Start it again.")
            self.problem = Problem(title, status.fault.sentence, steps)
            self._set_state("failed")
        elif self.state == "failed" and self._wanted is not None and status.health == "ready":
            self._set_state("listening")  # it was started again by itself

    def _on_node_failed(self, name: str, error: NepError) -> None:
        if name == self.name and self.state == "starting":
            problem = problem_of(error)
            launched = self._runner.launched(name)
            outcome = launched.outcome if launched is not None else None
            # Its own words are plainer than those about its process
            why = outcome.why if outcome is not None else ""
            self.problem = replace(problem, sentence=why or problem.sentence)
            self._go_on("failed")

    def _go_on(self, state: State) -> None:
        """It has started, or failed to: do what was wanted meanwhile."""
        self._set_state(state)
        if self._wanted is None:
            self.stop()
            if self._has_ended and state == "failed":
                self._forget_node()
        elif self._wanted is not self._started:
            self._start()

    def _set_state(self, state: State) -> None:
        self.state = state
        if not self._has_ended:
            self.changed.emit()


def _runs(runner: Runner, name: str) -> bool:
    status, launched = runner.board.nodes.get(name), runner.launched(name)
    is_ended = launched is None or launched.ended.is_set()
    return status is not None and status.is_there and not is_ended


def is_same(one: PlannedNode, other: PlannedNode | None) -> bool:
    """Whether two plans start the same process."""
    if other is None or (one.node, one.name) != (other.node, other.name):
        return False
    return one.parameters == other.parameters


# The dialog that connects a watch or phone: what one has, the steps, what arrives, using it.

SETTLE_MS = 400
"""So long after the last change of a setting the node is started with it."""
PATIENCE_S = 10.0
"""When nothing has arrived for so long, what to look at is shown."""
LINES_WIDE, LINES_HIGH = 54, 40
LEAST_WIDE, LEAST_HIGH = 20, 16


@dataclass(frozen=True)
class Plan:
    """What the project has: the name of the watch's node, and how it is set, if there is one."""

    name: str
    settings: Mapping[str, Setting] = field(default_factory=dict)
    gestures: Mapping[str, str] = field(default_factory=dict)
    """What a simulated person can make, names to titles."""
    wanted: Sequence[str] = ()
    """Those of them that it begins with."""
    folder: Path = field(default_factory=Path)
    equip: Callable[[PlannedNode], PlannedNode] = lambda node: node
    """Gives a node that is tried what Run would give it, such as the gestures of the project."""

    @property
    def connector(self) -> ConnectorKind | None:
        """The way in which the project's watch comes; None when it has none."""
        return CONNECTORS.get(str(self.settings.get("through", "udp"))) if self.settings else None


class WatchDialog(QDialog):
    """``used`` tells that the watch which runs now is to be the project's."""

    used = Signal()

    def __init__(
        self,
        runner: Runner,
        plan: Plan,
        token: str,
        look: Look,
        parent: QWidget | None = None,
        find_addresses: Callable[[], Sequence[str]] | None = None,
    ) -> None:
        """``find_addresses`` gives those of this computer; for tests."""
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Connect a watch or phone"))
        self.plan = plan
        self._runner, self._token, self._look = runner, token, look
        self._find_addresses = find_addresses or _own_addresses
        self.listener = WatchListener(runner, self, plan.name)
        self.trial = WatchTrial(runner, plan.name, runner)
        self.choosing = ChoosingPage(look)
        self.page: WayPage | None = None
        self.pages = QStackedWidget()
        self.back_button = QPushButton(tr("Something else"))
        self.close_button = QPushButton(tr("Close"))
        self.use_button = QPushButton(tr("Use this watch"))
        self._waiting_since_s = 0.0
        self._settling = QTimer(self, singleShot=True, interval=SETTLE_MS)
        line = self.fontMetrics().height()
        self.pages.addWidget(scrolled(self.choosing))
        self.use_button.setProperty("kind", "primary")
        self.back_button.setIconSize(QSize(line, line))
        for button in (self.back_button, self.close_button, self.use_button):
            button.setAutoDefault(False)
        foot = in_row(self.back_button, 1, self.close_button, self.use_button)
        in_column((self.pages, 1), foot, of=self, margins=line, spacing=line // 2)
        fit_on_screen(self, LINES_WIDE, LINES_HIGH)
        self._connect()
        self._on_theme_changed()
        self._update()

    # Layout

    def minimumSizeHint(self) -> QSize:
        """What is of use; the pages scroll."""
        line, room = self.fontMetrics().height(), room_around(self.parentWidget()).size()
        return QSize(min(line * LEAST_WIDE, room.width()), min(line * LEAST_HIGH, room.height()))

    def _connect(self) -> None:
        self.choosing.chosen.connect(self.show_connector)
        self.back_button.clicked.connect(self.show_choice)
        self.close_button.clicked.connect(self.reject)
        self.use_button.clicked.connect(self._on_use)
        self.trial.changed.connect(self._on_trial_changed)
        self.listener.changed.connect(self._update)
        self._settling.timeout.connect(self._on_settled)
        self._look.theme_changed.connect(self._on_theme_changed)

    # What happens

    def begin(self) -> None:
        """Show it: what the project has, else what one may have. It does not hold up the window."""
        self.show()
        self.listener.start()
        connector = self.plan.connector
        if connector is not None and self.trial.before is not None:
            self.show_connector(connector.name)
        else:
            self.show_choice()

    def show_choice(self) -> None:
        """Ask what one has."""
        self._settling.stop()
        self.trial.stop()
        self.pages.setCurrentIndex(0)
        self._drop_page()
        next(iter(self.choosing.cards.values())).setFocus()
        self._update()

    def show_connector(self, name: str) -> None:
        """Show the steps of a way, and begin to listen."""
        connector, plan = CONNECTORS[name], self.plan
        is_known = plan.connector == connector
        settings = dict(plan.settings) if is_known else {}
        is_running = is_known and self.trial.before is not None
        token = str(settings.get("token") or "") if is_running else ""
        token, addresses = token or self._token, self._find_addresses()
        known = Known(addresses, token, plan.gestures, plan.wanted, plan.folder, settings)
        self._drop_page()
        page = self.page = WayPage(connector, known, self.listener, self._look)
        page.changed.connect(self._settling.start)
        page.changed.connect(self._update)
        page.connector_asked.connect(self.show_connector)
        page.network.again.clicked.connect(
            lambda: page.network.show_addresses(self._find_addresses())
        )
        area = scrolled(page)
        page.came_into_view.connect(
            lambda shown: QTimer.singleShot(0, area, lambda: show_top(area, shown))
        )
        self.pages.addWidget(area)
        self.pages.setCurrentIndex(1)
        self.listener.begin_anew(self.plan.name)
        self._settling.start()  # who looks through the ways starts no node for each
        self._update()
        first = next((one for one in _asked_first(page) if one.isVisible()), self.close_button)
        first.setFocus()

    @property
    def planned(self) -> PlannedNode | None:
        """The node of what is chosen; None as long as something is missing."""
        settings = self.page.settings if self.page is not None else None
        if self.page is None or settings is None:
            return None
        return PlannedNode(self.page.connector.node, self.plan.name, settings)

    def _on_settled(self) -> None:
        """Let the node run with the settings that are chosen now."""
        planned = self.planned
        self._waiting_since_s = time.monotonic()
        self.listener.begin_anew(self.plan.name)
        if planned is None:
            self.trial.stop()
        else:
            self.trial.want(self.plan.equip(planned))
        self._update()

    def _on_theme_changed(self) -> None:
        back = "arrow-right" if is_right_to_left() else "arrow-left"
        self.back_button.setIcon(icon(back, self._look.theme))
        for card in self.choosing.cards.values():
            card.redraw()
        if self.page is not None:
            self.page.redraw()

    def _on_trial_changed(self) -> None:
        if self.trial.state == "listening":
            self._waiting_since_s = time.monotonic()
        self._update()

    def _update(self) -> None:
        """Show how far it is."""
        page = self.page
        is_listening = self.trial.state == "listening" and not self._settling.isActive()
        self.back_button.setVisible(page is not None)
        self.use_button.setVisible(page is not None)
        self.use_button.setEnabled(is_listening)
        if page is None:
            return
        page.show_sending(is_listening and self.listener.is_sending)
        if self.trial.state == "failed" and self.trial.problem is not None:
            page.live.show_problem(self.trial.problem)
        elif self.listener.silent_s < float("inf") and self.trial.state == "listening":
            is_silent = self.listener.silent_s > PATIENCE_S
            page.live.show_arriving(page.advice if is_silent else ())
        else:
            waited_s = time.monotonic() - self._waiting_since_s
            has_waited = self.trial.state == "listening" and waited_s > PATIENCE_S
            advice = page.advice if has_waited else ()
            title, told = self._waiting_words(page)
            page.live.show_waiting(title, "" if advice and page.connector.listens else told, advice)

    def _waiting_words(self, page: WayPage) -> tuple[str, str]:
        if page.settings is None:
            return tr("Something is still missing"), tr("Fill in what is asked in the steps.")
        if self.trial.state != "listening":
            return tr("Getting ready…"), ""
        status = self.listener.status
        told = tr(status.fault.sentence) if status is not None else ""
        if page.connector.listens and not page.network.is_open:
            return tr("Let this network in first"), told
        return tr("Waiting for the first movement…"), told

    def _drop_page(self) -> None:
        area = self.pages.widget(1)
        if area is not None:
            self.pages.removeWidget(area)
            area.deleteLater()
            self.page = None

    def _on_use(self) -> None:
        self.used.emit()
        self.accept()

    def done(self, result: int) -> None:
        """Stop what is not used. Also the window's cross comes here."""
        self._settling.stop()
        self.listener.stop()
        if result != QDialog.DialogCode.Accepted:
            self.trial.end()
        super().done(result)


def _asked_first(page: WayPage) -> list[QWidget]:
    boxes = page.gestures.boxes.values()
    return [page.network.switch, page.address, *boxes, page.recording.button]


def _own_addresses() -> Sequence[str]:
    from nodes.sensory.connectors.servers import lan_addresses

    return lan_addresses()
