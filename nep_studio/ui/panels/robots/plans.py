"""The robots that a project says take part."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from nep_core.messages import RobotState
from nep_studio.plan import PlannedNode
from nep_studio.ui.panels.nodes.looks import StateLook
from nep_studio.ui.words import tr

ACTION = "action/"


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


def look_of(state: RobotState | None) -> StateLook:
    """How a robot is whose node has told nothing yet."""
    if state is None:
        return StateLook("circle-dashed", "muted", tr("Not started"))
    return StateLook("circle-check", "success", tr("Ready"))
