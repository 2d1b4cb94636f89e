"""The robots that a project says take part."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from nep_core.messages import RobotState
from nep_studio import paths
from nep_studio.plan import PlannedNode
from nep_studio.ui.panels.nodes.looks import StateLook
from nep_studio.ui.words import tr

ACTION = "action/"


@dataclass(frozen=True)
class RobotPlan:
    """A robot that takes part: a real one at an address, or one on the screen.

    ``folder`` is where its kind is described; None for NAO.
    """

    name: str
    is_real: bool = False
    address: str = ""
    folder: Path | None = None

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
            _folder(node),
        )
        for node in planned
        if node.node.startswith(ACTION)
    ]


def _folder(node: PlannedNode) -> Path | None:
    """The folder of a kind of robot that can be drawn: one of ours, or one of the person's."""
    driver = str(node.parameters.get("driver", ""))
    model = str(node.parameters.get("model", "")) or driver.partition("_")[2]
    for folder in (paths.resources() / "robots" / model, Path(model)):
        if model and (folder / "view.toml").is_file():
            return folder
    return None


def look_of(state: RobotState | None) -> StateLook:
    """How a robot is whose node has told nothing yet."""
    if state is None:
        return StateLook("circle-dashed", "muted", tr("Not started"))
    return StateLook("circle-check", "success", tr("Ready"))
