"""What a program needs before it can run, and what is there of it, as data."""

from __future__ import annotations

import socket
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from nep_studio.blocks.checks import Problem
from nep_studio.node_board import NodeStatus
from nep_studio.plan import PlannedNode
from nep_studio.ui.words import tr

NAOQI_PORT = 9559
PROBE_S = 1.5

State = Literal["met", "automatic", "looking", "missing"]
FixName = Literal[
    "add_start", "fix_problem", "show_block", "start_node", "simulator", "address", "connect"
]


@dataclass(frozen=True)
class NeedFix:
    """A button beside a need: what it does, and its words."""

    name: FixName
    words: str


@dataclass(frozen=True)
class Need:
    """Something a program needs.

    ``automatic``: not there yet, but Run starts it. ``block`` and ``node`` are what it is about.
    """

    state: State
    title: str
    sentence: str = ""
    fixes: tuple[NeedFix, ...] = ()
    block: str = ""
    node: PlannedNode | None = None
    problem: Problem | None = None


def needs_of(
    problems: Sequence[Problem],
    nodes: Sequence[PlannedNode],
    board: Mapping[str, NodeStatus],
    answers: Mapping[str, bool],
    *,
    has_rules: bool,
    is_connected: bool,
) -> list[Need]:
    """All needs, those that are missing first.

    ``answers`` tells whether a real robot answered at its address; a robot that is not in there
    is still looked for.
    """
    errors = [problem for problem in problems if problem.severity == "error"]
    needs = [_problem(problem) for problem in errors if problem.kind != "no_rule"]
    if not has_rules:
        needs.append(_rules())
    needs.append(_master(is_connected))
    for node in nodes:
        status = board.get(node.name)
        needs.append(_robot(node, answers) if is_real(node) else _node(node, status))
    order: dict[State, int] = {"missing": 0, "looking": 1, "automatic": 2, "met": 3}
    return sorted(needs, key=lambda need: order[need.state])


def is_real(node: PlannedNode) -> bool:
    """Whether a node drives a robot that stands somewhere."""
    return node.parameters.get("driver") == "naoqi"


def answers_at(address: str) -> bool:
    """Whether something answers at a robot's address; waits a moment for it."""
    host, _, port = address.strip().partition(":")
    try:
        with socket.create_connection((host, int(port or NAOQI_PORT)), PROBE_S):
            return True
    except (OSError, ValueError, OverflowError):
        return False


def _rules() -> Need:
    fix = NeedFix("add_start", tr("Add “when the program starts”"))
    title = tr("Something to do")
    sentence = tr("Nothing happens yet: every program begins with a block that says when.")
    return Need("missing", title, sentence, (fix,))


def _problem(problem: Problem) -> Need:
    fixes = [NeedFix("fix_problem", tr(problem.fix.label))] if problem.fix is not None else []
    if problem.block:
        fixes.append(NeedFix("show_block", tr("Show the block")))
    steps = " ".join(map(tr, problem.checklist))
    return Need("missing", tr(problem.sentence), steps, tuple(fixes), problem.block, None, problem)


def _master(is_connected: bool) -> Need:
    if is_connected:
        return Need("met", tr("The NEP master"), tr("It runs: the nodes can find each other."))
    sentence = tr("It brings the nodes together. Run starts it.")
    return Need("automatic", tr("The NEP master"), sentence)


def _node(node: PlannedNode, status: NodeStatus | None) -> Need:
    title = tr("The node {name}", name=node.name)
    reason = tr(node.reason) if node.reason else ""
    if status is not None and status.is_there:
        return Need("met", title, tr("It runs."), node=node)
    start = NeedFix("start_node", tr("Start it now"))
    told = tr("Run starts it.")
    words = f"{reason[:1].upper()}{reason[1:]}. {told}" if reason else told
    return Need("automatic", title, words, (start,), node.block_id, node)


def _robot(node: PlannedNode, answers: Mapping[str, bool]) -> Need:
    address = str(node.parameters.get("address", ""))
    title = tr("The robot {name} at {address}", name=node.name, address=address)
    if node.name not in answers:
        return Need("looking", title, tr("Looking whether it answers…"), node=node)
    if answers[node.name]:
        return Need("met", title, tr("It answers."), node=node)
    sentence = tr(
        "It does not answer. Is it switched on, and in the same network as this computer?"
        " Press its chest button once: it says its address."
    )
    fixes = (
        NeedFix("simulator", tr("Use the robot on the screen")),
        NeedFix("connect", tr("Find it and test the connection")),
        NeedFix("address", tr("Change the address")),
    )
    return Need("missing", title, sentence, fixes, node.block_id, node)
