"""What a change of a node's state means for the person: a problem, and fixes by name."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from faults import Text, Words
from nep_core.wire.messages import (
    ACTION_REQUEST,
    PROCESS_ENDED,
    PROCESS_RESTARTS,
    ActionRequest,
)
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.program import ROBOT_BLOCK
from nep_studio.problems import Problem
from nep_studio.run.node_board import NodeStatus
from nep_studio.run.plan import MASTER, PROGRAM, PlannedNode
from nep_studio.ui.messages import Answer, Kind
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.host import Host


Fix = Literal[
    "start",
    "restart",
    "show_log",
    "show_settings",
    "use_virtual",
    "take_over",
    "rest",
    "test_connection",
    "run",
    "stop",
]

WELL = frozenset({"ready", "busy"})
ROBOT_DRIVEN, ROBOT_TAKEN = "driven", "taken_over"
"""What a real robot's node tells when another program drives the robot, or has taken it."""
ROBOT_LEFT_ON = "left_on"
"""The same at its end, of a robot whose motors stay on."""
TIRED = frozenset({"too_hot", "low_battery"})
"""The same of a robot that should rest."""
BAD = frozenset({"frozen", "warning", "crashed", "stopped"})
"""What may have to be told."""


@dataclass(frozen=True)
class Circumstances:
    """What is known beside the states themselves.

    ``was_asked``: somebody just stopped it here. ``is_ending``: the whole program is being
    stopped. ``was_ready``: it has been ready since it was started by a person.
    """

    is_ours: bool = False
    is_program: bool = False
    was_asked: bool = False
    is_ending: bool = False
    was_ready: bool = False
    has_block: bool = False
    address: str = ""


@dataclass(frozen=True)
class Notice:
    """What to tell of a node. One with a ``key`` that was told last is not told again."""

    node: str
    key: str
    kind: Kind
    problem: Problem
    fixes: tuple[Fix, ...] = ()
    passes: bool = False


def notice_of(before: NodeStatus | None, after: NodeStatus, at: Circumstances) -> Notice | None:
    """What has to be told; None when nothing has."""
    if before is not None:
        was = (before.health, before.event, before.fault)
        if was == (after.health, after.event, after.fault):
            return None
    if after.health == "frozen":
        return _frozen(after, at)
    if after.event == "connection_failed":
        return _no_connection(after, at)
    if after.health == "warning":
        return _warning(after, at)
    if after.health == "crashed" and not at.is_ending:
        return _program_ended(after) if at.is_program else _ended(after, at)
    if after.health == "stopped" and before is not None:
        return _stopped(after, at)
    return None


def is_recovered(before: NodeStatus | None, after: NodeStatus) -> bool:
    """Whether what was told of a node is over: it is well again, or was started anew."""
    is_back = after.health in WELL and (before is None or before.health not in WELL)
    return is_back or (after.health == "stopped" and before is not None and before.is_there)


def _no_connection(status: NodeStatus, at: Circumstances) -> Notice:
    """The node's own words are a sentence and a checklist."""
    fault = status.fault
    where = tr(
        "The program could not reach {name} at {address}.", name=status.name, address=at.address
    )
    fixes: tuple[Fix, ...]
    if fault.code == ROBOT_DRIVEN:
        title = tr("{name} is driven by somebody else", name=status.name)
        fixes = ("use_virtual", "take_over")
    elif fault.code == ROBOT_TAKEN:
        title = tr("{name} was taken over", name=status.name)
        fixes = ("use_virtual", "take_over")
    else:
        title = tr("{name} does not answer", name=status.name)
        fixes = ("use_virtual", "test_connection")
    problem = Problem(title, fault.sentence or where, fault.checklist)
    told = fixes if at.has_block else ()
    return Notice(status.name, f"connection {at.address}", "error", problem, told)


def _frozen(status: NodeStatus, at: Circumstances) -> Notice:
    name = status.name
    steps: tuple[str, ...]
    if at.is_program:
        steps = (tr("Stop the program and run it again."), tr("Does a rule wait for something?"))
        problem = Problem(tr("The program does not answer"), _silent(name), steps)
        return Notice(name, "frozen", "warning", problem, ("run", "show_log"))
    steps = (
        (tr("Wait a moment: is the computer busy?"), tr("Restart it."), tr("Look into its log."))
        if at.is_ours
        else (tr("Restart it where it was started."), tr("Is its computer still on the network?"))
    )
    problem = Problem(tr("“{name}” does not answer", name=name), _silent(name), steps)
    fixes: tuple[Fix, ...] = ("restart", "show_log") if at.is_ours else ()
    return Notice(name, "frozen", "warning", problem, fixes)


def _silent(name: str) -> str:
    return tr("“{name}” has said nothing for three seconds.", name=name)


def _warning(status: NodeStatus, at: Circumstances) -> Notice:
    name = status.name
    steps: tuple[Words, ...]
    if status.event == "disconnected":
        title = tr("“{name}” has lost its connection", name=name)
        steps = (tr("It goes on trying by itself."), tr("Is the device switched on and near?"))
    else:
        title = tr("“{name}” needs attention", name=name)
        steps = (tr("Look into its log."), tr("Look at its settings."))
    problem = Problem(title, status.fault.sentence, status.fault.checklist or steps)
    log: tuple[Fix, ...] = ("show_log",) if at.is_ours or at.is_program else ()
    settings: tuple[Fix, ...] = ("show_settings",) if at.has_block else ()
    if status.fault.code in TIRED:  # told once, and not anew with each degree
        key, rest = f"warning {status.fault.code}", ("rest", *log, *settings)
        return Notice(name, key, "warning", problem, rest)
    return Notice(name, f"warning {status.fault}", "warning", problem, log + settings)


def _ended(status: NodeStatus, at: Circumstances) -> Notice | None:
    name = status.name
    steps: tuple[str, ...]
    described = _how_it_ended(status)
    if not at.is_ours:
        title = tr("“{name}” has ended unexpectedly", name=name)
        steps = (tr("Start it again where it was started."),)
        return Notice(name, "ended", "warning", Problem(title, described, steps))
    if status.fault.code == PROCESS_RESTARTS:
        title = tr("“{name}” ended unexpectedly and is started again", name=name)
        steps = (tr("Wait a moment: it comes back by itself."), tr("Look into its log."))
        problem = Problem(title, described, steps)
        return Notice(name, "restarting", "warning", problem, ("show_log",))
    if status.fault.code != PROCESS_ENDED:
        return None  # its own last words; what became of its process follows at once
    if not at.was_ready:
        return None  # who started it is told why it could not start
    title = tr("“{name}” ended unexpectedly", name=name)
    steps = (tr("Start it again."), tr("Look into its log: why did it end?"))
    return Notice(name, "ended", "error", Problem(title, described, steps), ("start", "show_log"))


def _program_ended(status: NodeStatus) -> Notice | None:
    """Only when it was killed: what else may end it, Run tells of."""
    if status.fault.code != PROCESS_RESTARTS:
        return None
    title = tr("The program ended unexpectedly and begins again")
    steps = (
        tr("Stop it, if it should not begin again."),
        tr("Does it use more and more memory? Its log may say so."),
    )
    problem = Problem(title, _how_it_ended(status), steps)
    return Notice(status.name, "restarting", "warning", problem, ("stop", "show_log"))


def _how_it_ended(status: NodeStatus) -> Text:
    """That alone; what becomes of the node then is in the title."""
    outcome = status.fault.sentence.values.get("outcome")
    return outcome if isinstance(outcome, Text) else status.fault.sentence


def started_again(name: str, problem: Problem) -> Notice:
    """What stands there for a while when a node is well again: it was too quick to be read."""
    titles = {PROGRAM: tr("The program has begun again"), MASTER: tr("The network is open again")}
    title = titles.get(name) or tr("“{name}” was started again", name=name)
    again = Problem(title, problem.sentence)
    return Notice(name, "started again", "info", again, ("show_log",), passes=True)


def master_notice(event: str, sentence: Words) -> Notice:
    """What to tell of a master that ended unexpectedly."""
    if event == "restarting":
        title = tr("The network ended unexpectedly and is opened again")
        steps = (tr("Wait a moment: what runs goes on."), tr("Look into its log."))
        problem = Problem(title, sentence, steps)
        return Notice(MASTER, "restarting", "warning", problem, ("show_log",))
    steps = (tr("Start it again: what runs goes on."), tr("Look into its log: why did it end?"))
    problem = Problem(tr("The network ended unexpectedly"), sentence, steps)
    return Notice(MASTER, "gone", "error", problem, ("start", "show_log"))


def _stopped(status: NodeStatus, at: Circumstances) -> Notice | None:
    name = status.name
    if status.fault.code == ROBOT_LEFT_ON:
        title = tr("{name}: its motors are still on", name=name)
        problem = Problem(title, status.fault.sentence, status.fault.checklist)
        return Notice(name, ROBOT_LEFT_ON, "warning", problem)
    if at.is_ending or at.is_program or not at.is_ours:
        return None
    if at.was_asked:
        title = tr("“{name}” was stopped", name=name)
        return Notice(name, "stopped", "info", Problem(title), ("start",), passes=True)
    title = tr("“{name}” has ended by itself", name=name)
    steps = (tr("Start it again, if the program needs it."),)
    return Notice(name, "stopped", "info", Problem(title, "", steps), ("start", "show_log"))


def could_not_start(name: str, problem: Problem, at: Circumstances) -> Notice:
    """What to tell when a node that a person started did not come up."""
    settings: tuple[Fix, ...] = ("show_settings",) if at.has_block else ()
    return Notice(name, "could not start", "error", problem, (*settings, "start", "show_log"))


# Does what the buttons of the messages about nodes say.


class NodeFixes:
    """Does the fixes; ``open_log`` shows the log of a node."""

    def __init__(self, host: Host, open_log: Callable[[str], None]) -> None:
        self._host, self._open_log = host, open_log

    def plan_of(self, name: str) -> PlannedNode | None:
        """How a node is wanted now: as the project says, else as it was started."""
        runner = self._host.services.runner
        found = {one.name: one for one in runner.planned()}
        return found.get(name) or runner.started.get(name)

    def block_of(self, name: str) -> str:
        """The block that a node comes from; "" when it has none on a page."""
        plan = self.plan_of(name)
        blocks = self._host.workbench.canvas.editor.project.blocks
        return plan.block_id if plan is not None and plan.block_id in blocks else ""

    def answer(self, fix: Fix, name: str) -> Answer:
        """The button of a fix."""
        runner = self._host.services.runner
        buttons: Mapping[Fix, tuple[str, Callable[[], object]]] = {
            "start": (tr("Start it again"), lambda: self.start(name)),
            "restart": (tr("Restart it"), lambda: runner.restart_node(name)),
            "show_log": (tr("Show its log"), lambda: self._open_log(name)),
            "show_settings": (tr("Show its settings"), lambda: self._show_settings(name)),
            "use_virtual": (tr("Use the robot on the screen"), lambda: self._use_virtual(name)),
            "take_over": (tr("Take it over"), lambda: self._take_over(name)),
            "rest": (tr("Let it rest"), lambda: self._let_rest(name)),
            "test_connection": (
                tr("Find it and test the connection"),
                lambda: self._host.ask("connecting.open", name),
            ),
            "run": (tr("Run again"), runner.run),
            "stop": (tr("Stop"), lambda: self._host.services.running.stop()),
        }
        words, do = buttons[fix]
        is_first = fix in ("start", "restart", "use_virtual", "run", "rest")
        return Answer(words, do, "primary" if is_first else "quiet")

    def _show_settings(self, name: str) -> None:
        self._host.workbench.show_block(self.block_of(name))

    def start(self, name: str) -> None:
        """Start a node as it is wanted now; or the network, when its master is gone."""
        if name == MASTER:
            self._host.services.runner.open_network()
            return
        plan = self.plan_of(name)
        if plan is not None:
            self._host.services.runner.start_node(plan)

    def _use_virtual(self, name: str) -> None:
        """Let the robot be the one on the screen: in the project, where it can be undone."""
        block, workbench = self._robot_block(name), self._host.workbench
        if not block:
            return
        editor = workbench.canvas.editor
        try:
            with editor.transaction(tr("use the robot on the screen")):
                editor.apply(SetField(block, "driver", "virtual"))
        except EditRefused as refusal:
            self._host.services.messages.refuse(refusal.sentence, refusal.checklist)
            return
        self.start(name)  # the running one is as it was before, so it is started anew

    def _take_over(self, name: str) -> None:
        """Drive a robot that another program drives, which is told so; until the next Run."""
        plan = self.plan_of(name)
        if plan is not None:
            asking = replace(plan, parameters={**plan.parameters, "take_over": True})
            self._host.services.runner.start_node(asking, is_wanted=True)

    def _let_rest(self, name: str) -> None:
        """Let a robot go down and switch its motors off, as soon as what it does has ended."""
        plan = self.plan_of(name)
        robot = str(plan.parameters.get("robot", name)) if plan is not None else name
        request = ActionRequest(id=uuid.uuid4().hex, robots=[robot], action="rest")
        self._host.services.runner.send(ACTION_REQUEST, request)

    def _robot_block(self, name: str) -> str:
        block = self.block_of(name)
        project = self._host.workbench.canvas.editor.project
        return block if block and project.blocks[block].type == ROBOT_BLOCK else ""
