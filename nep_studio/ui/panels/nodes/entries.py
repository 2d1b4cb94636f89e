"""What the node panel has cards for: nodes that the project needs, and nodes that are there."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import cast, get_args

from nep_core.messages import NodeType
from nep_studio.node_board import NodeStatus
from nep_studio.plan import PlannedNode
from nep_studio.session import PROGRAM
from nep_studio.ui.panels.network.seen import NodeSeen

from .looks import is_running

ORDER: Mapping[str, int] = {name: place for place, name in enumerate(get_args(NodeType))}


@dataclass(frozen=True)
class Entry:
    """A node with all that its card says; ``planned`` is None for one that nobody planned."""

    status: NodeStatus
    planned: PlannedNode | None = None
    is_ours: bool = False
    seen: NodeSeen | None = None

    @property
    def name(self) -> str:
        """Its name."""
        return self.status.name

    @property
    def is_program(self) -> bool:
        """Whether it is the program itself, which Run and Stop are for."""
        return self.name == PROGRAM

    @property
    def can_start(self) -> bool:
        """Whether the studio can start it now."""
        return not is_running(self.status) and (self.planned is not None or self.is_program)

    @property
    def can_stop(self) -> bool:
        """Whether the studio can stop it now."""
        return is_running(self.status) and (self.is_ours or self.is_program)

    @property
    def can_restart(self) -> bool:
        """Whether the studio can stop and start it: the program is started by Run alone."""
        return is_running(self.status) and self.is_ours

    @property
    def has_log(self) -> bool:
        """Whether the studio keeps what it writes."""
        return self.is_ours or self.is_program

    @property
    def is_foreign(self) -> bool:
        """Whether somebody else started it."""
        return not (self.is_ours or self.is_program or self.planned) or (
            self.planned is not None and not self.is_ours and is_running(self.status)
        )


def entries_of(
    statuses: Mapping[str, NodeStatus],
    planned: Iterable[PlannedNode],
    ours: Mapping[str, PlannedNode],
    seen: Mapping[str, NodeSeen],
) -> list[Entry]:
    """All nodes, from sensing to acting; ``ours`` are those that the studio was asked to start."""
    plans = {**ours, **{one.name: one for one in planned}}
    names = [*plans, *(name for name in statuses if name not in plans)]
    entries = [
        Entry(_status(name, statuses, plans), plans.get(name), name in ours, seen.get(name))
        for name in names
        if name in plans or is_worth_a_card(statuses[name], seen)
    ]
    return sorted(entries, key=lambda one: (ORDER.get(one.status.type, 9), one.name))


def is_worth_a_card(status: NodeStatus, seen: Mapping[str, NodeSeen]) -> bool:
    """Whether a node that nobody planned is shown: while it is there, or is the program."""
    return is_running(status) or status.name == PROGRAM or status.name in seen


def _status(
    name: str, statuses: Mapping[str, NodeStatus], plans: Mapping[str, PlannedNode]
) -> NodeStatus:
    plan, status = plans.get(name), statuses.get(name)
    if plan is None:
        return statuses[name]
    type_ = cast(NodeType, plan.node.partition("/")[0])
    if status is None:
        return NodeStatus(name, type_, plan.node)
    return replace(status, node=status.node or plan.node)
