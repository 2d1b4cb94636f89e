"""Tells of nodes that come to grief, each thing once, and takes it back when all is well."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from faults import Words
from nep_core.errors import NepError
from nep_studio.problems import Problem, problem_of
from nep_studio.run.node_board import NodeStatus
from nep_studio.run.plan import MASTER, PROGRAM
from nep_studio.ui.messages import Message
from nep_studio.ui.node_style import is_running
from nep_studio.ui.words import count_words, tr

from .notices import (
    BAD,
    WELL,
    Circumstances,
    NodeFixes,
    Notice,
    could_not_start,
    is_recovered,
    master_notice,
    notice_of,
    started_again,
)

if TYPE_CHECKING:
    from nep_studio.ui.host import Host

GATHER_MS = 400
"""Nodes that become ready within this time are told of together."""
ENDING_S = 3.0
"""What is heard so soon after the end of a run belongs to that end."""


class NodeNotifier(QObject):
    """Listens to the runner of a window as long as ``parent`` lives."""

    def __init__(self, host: Host, open_log: Callable[[str], None], parent: QObject) -> None:
        super().__init__(parent)
        self._host = host
        self._runner = host.services.runner
        self.fixes = NodeFixes(host, open_log)
        self._before: dict[str, NodeStatus] = dict(self._runner.board.nodes)
        self._told: dict[str, tuple[str, Message]] = {}
        self._asked: set[str] = set()
        self._restarted: set[str] = set()
        self._was_ready = {name for name, one in self._before.items() if one.is_there}
        self._by_hand: set[str] = set()
        self._ready: list[str] = []
        self._ended_s = -ENDING_S
        self._has_begun = self._runner.state in ("running", "paused")
        self._is_begin_untold = False
        self._gathering = QTimer(self, singleShot=True, interval=GATHER_MS)
        self._gathering.timeout.connect(self._on_gathered)
        self._runner.nodes_changed.connect(self._on_nodes_changed)
        self._runner.state_changed.connect(self._on_state_changed)
        self._runner.node_failed.connect(self._on_node_failed)
        self._runner.master_changed.connect(self._on_master_changed)

    def expect_start(self, name: str) -> None:
        """A person starts a node: that it is ready will be told."""
        self._by_hand.add(name)
        self._was_ready.discard(name)

    def expect_stop(self, name: str) -> None:
        """A person stops a node: its end is no surprise."""
        self._asked.add(name)

    def expect_restart(self, name: str) -> None:
        """A person restarts a node: only that it is ready again will be told."""
        self._restarted.add(name)
        self.expect_start(name)

    def _on_nodes_changed(self, names: list[str]) -> None:
        for name in names:
            before, after = self._before.get(name), self._runner.board.nodes.get(name)
            if after is None:
                self._before.pop(name, None)
                continue
            self._before[name] = after
            if name in self._told and is_recovered(before, after):
                self._recover(name)
            is_bad = after.health in BAD or after.event == "connection_failed"
            if is_bad and (notice := notice_of(before, after, self._circumstances(after))):
                self.tell(notice)
            # The next change is judged by this
            if after.health in WELL:
                if name in self._by_hand:
                    self._by_hand.discard(name)
                    self._ready.append(name)
                    self._gathering.start()
                self._was_ready.add(name)
                self._restarted.discard(name)
            if name in self._asked and not is_running(after):
                self._asked.discard(name)

    def _circumstances(self, status: NodeStatus) -> Circumstances:
        runner, name = self._runner, status.name
        # Did the studio stop it, with a run that is over, or to start it anew?
        launched = runner.launched(name)
        is_over = False
        if status.health == "stopped" and name not in self._asked and launched is not None:
            ran_s = time.monotonic() - launched.started_s
            is_over = launched.stopping or status.since_s < time.time() - ran_s
        plan = self.fixes.plan_of(name)
        blocks = self._host.workbench.canvas.editor.project.blocks
        return Circumstances(
            is_ours=name in runner.started,
            is_program=name == PROGRAM,
            was_asked=name in self._asked,
            is_ending=self._is_ending or name in self._restarted or is_over,
            was_ready=name in self._was_ready,
            has_block=plan is not None and plan.block_id in blocks,
            address=str(plan.parameters.get("address", "")) if plan is not None else "",
        )

    @property
    def _is_ending(self) -> bool:
        is_over = time.monotonic() - self._ended_s < ENDING_S
        return is_over or self._runner.state == "stopping"

    def tell(self, notice: Notice) -> None:
        """Tell it, unless it was told and is there still, or somebody else tells it."""
        if notice.node in self._runner.told_elsewhere:
            return
        told = self._told.get(notice.node)
        if told is not None and told[0] == notice.key:
            return
        self._take_back(notice.node)
        problem = notice.problem
        answers = tuple(self.fixes.answer(fix, notice.node) for fix in notice.fixes)
        message = Message(
            notice.kind,
            tr(problem.title),
            tr(problem.sentence),
            tuple(map(tr, problem.checklist)),
            problem.details,
            answers,
            passes=notice.passes,
        )
        if not notice.passes:
            self._told[notice.node] = (notice.key, message)
        self._host.services.messages.tell(message)

    def _take_back(self, name: str) -> None:
        told = self._told.pop(name, None)
        if told is not None:
            self._host.services.messages.withdraw(told[1])

    def _recover(self, name: str) -> None:
        """It is well again: take back what was told, but let what passed quickly be read."""
        key, message = self._told.get(name, ("", None))
        self._take_back(name)
        if key == "restarting" and message is not None and not self._is_ending:
            self.tell(started_again(name, Problem(message.title, message.sentence)))

    def _on_master_changed(self, event: str, sentence: Words) -> None:
        if event == "back":
            self._recover(MASTER)
        else:
            self.tell(master_notice(event, sentence))

    def _on_state_changed(self, state: str) -> None:
        if state == "idle":
            self._ended_s = time.monotonic()
        elif state == "starting":
            self._ended_s = -ENDING_S
            for name in list(self._told):
                self._take_back(name)
        elif state == "running" and not self._has_begun:
            self._is_begin_untold = True
            self._gathering.start()  # the last node's "ready" may still be on its way
        self._has_begun = state in ("running", "paused")

    def _on_gathered(self) -> None:
        """One message for all nodes that became ready, of a run or by hand."""
        confirm = self._host.services.messages.confirm
        has_begun = self._is_begin_untold and self._runner.state in ("running", "paused")
        ready, self._ready, self._is_begin_untold = self._ready, [], False
        if has_begun:
            confirm(tr("The program runs"))
        elif len(ready) == 1:
            confirm(tr("“{name}” is ready", name=ready[0]))
        elif ready:
            confirm(count_words(len(ready), "1 node is ready", "{n} nodes are ready"))

    def _on_node_failed(self, name: str, error: NepError) -> None:
        """The plain message of the runner gets the buttons that help with a node."""
        self._by_hand.discard(name)
        status = self._runner.board.nodes.get(name) or NodeStatus(name, "sensory")
        at = self._circumstances(status)
        self.tell(could_not_start(name, problem_of(error), at))
