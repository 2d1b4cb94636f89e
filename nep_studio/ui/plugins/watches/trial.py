"""Runs the node of a watch while it is being connected; what ran before comes back if unused."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from PySide6.QtCore import QObject, Signal

from nep_core.errors import NepError
from nep_studio.problems import Problem, problem_of
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.words import tr

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
        self.before = runner.local.planned.get(name) if _runs(runner, name) else None
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
                if not is_same(self.before, self._runner.local.planned.get(self.name)):
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
        if planned is not None and is_same(planned, self._runner.local.planned.get(self.name)):
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
        if is_same(wanted, self._runner.local.planned.get(self.name)) and _runs(
            self._runner, self.name
        ):
            self._started = wanted
            self._set_state("listening")
            return
        status = self._runner.board.nodes.get(self.name)
        self._pid_before = status.pid if status is not None else 0
        self._started = wanted
        self.problem = None
        self._set_state("starting")
        self._runner.start_node(wanted)

    @property
    def _is_needed(self) -> bool:
        """Whether a program that runs has taken the node over, as it is."""
        mine = self._runner.local.planned.get(self.name)
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
            launched = self._runner.local.launcher.nodes.get(name)
            outcome = launched.outcome if launched is not None else None
            if outcome is not None and outcome.why:
                # its own words are plainer than those about its process
                problem = replace(problem, sentence=outcome.why)
            self.problem = problem
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
    status, launched = runner.board.nodes.get(name), runner.local.launcher.nodes.get(name)
    is_ended = launched is None or launched.ended.is_set()
    return status is not None and status.is_there and not is_ended


def is_same(one: PlannedNode, other: PlannedNode | None) -> bool:
    """Whether two plans start the same process."""
    if other is None:
        return False
    return (one.node, one.name, dict(one.parameters)) == (
        other.node,
        other.name,
        dict(other.parameters),
    )
