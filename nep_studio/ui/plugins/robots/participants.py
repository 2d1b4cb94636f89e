"""Which robots take part in the project, and where those on the screen begin."""

from __future__ import annotations

import uuid
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QObject, QTimer

from faults.files import is_elsewhere
from nep_core.wire import messages as m
from nep_core.wire.messages import RobotState
from nep_studio import paths
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.node_style import StateLook
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.words import tr

# Where the robots on the screen begin: beside each other, so that all are seen.

ACTION = "action/"
APART_M = 0.8
ORIGIN = (0.0, 0.0, 0.0)
BRAKING_MS = 500
"""So long a robot takes at most to come to rest."""
READY = ("ready", "busy", "warning")
"""How nodes are that hear what they are asked."""
Base = tuple[float, float, float]
"""x m, y m, theta rad on the floor."""


class Starts(QObject):
    """Puts each robot to its place when its node is ready, and again when it is asked to."""

    def __init__(self, runner: Runner, parent: QObject) -> None:
        super().__init__(parent)
        self._runner = runner
        self._there: set[str] = set()
        runner.nodes_changed.connect(self._on_nodes_changed)

    def put_back(self, robot: str) -> None:
        """Stop a robot, and put it to where it began."""
        stop = m.ActionRequest(id=uuid.uuid4().hex, robots=[robot], action="stop", priority=100)
        self._runner.send(m.ACTION_REQUEST, stop)
        QTimer.singleShot(BRAKING_MS, self, lambda: self._put(robot))

    def _put(self, robot: str) -> None:
        place = start_places(self._runner.planned()).get(robot, ORIGIN)
        self._runner.send(m.SENSE_REQUEST, m.SenseRequest(robot=robot, sense="place", place=place))

    def _on_nodes_changed(self, names: list[str]) -> None:
        nodes = self._runner.board.nodes
        came = {name for name in names if name in nodes and nodes[name].health in READY}
        new, self._there = came - self._there, (self._there - set(names)) | came
        if new:
            places = start_places(self._runner.planned())
            for robot in new & places.keys():
                if places[robot] != ORIGIN:
                    self._put(robot)


def start_places(planned: Iterable[PlannedNode]) -> dict[str, Base]:
    """Where the robots on the screen begin, by name: the first in the middle, if no real one is.

    Where a real robot is, it says by itself: at first in the middle.
    """
    robots = [node for node in planned if node.node.startswith(ACTION)]
    real = [node for node in robots if node.parameters.get("driver") == "naoqi"]
    names = [str(one.parameters.get("robot", one.name)) for one in robots if one not in real]
    numbers = range(1 if real else 0, len(names) + 1)
    return {
        name: (0.0, (number + 1) // 2 * (-APART_M if number % 2 else APART_M), 0.0)
        for name, number in zip(names, numbers, strict=False)
    }


# The robots that a project says take part.


@dataclass(frozen=True)
class RobotPlan:
    """A robot that takes part: a real one at an address, or one on the screen.

    ``folder`` is where its kind is described; None for NAO.
    """

    name: str
    is_real: bool = False
    address: str = ""
    folder: Path | None = None


def robots_of(planned: Iterable[PlannedNode]) -> list[RobotPlan]:
    """The robots among the nodes that a project needs."""
    found = []
    for node in planned:
        if not node.node.startswith(ACTION):
            continue
        told = {key: str(value) for key, value in node.parameters.items()}
        driver = told.get("driver", "")
        # The folder of a kind of robot that can be drawn: one of ours, or one of the person's
        model = told.get("model", "") or driver.partition("_")[2]
        has_folder = bool(model) and not is_elsewhere(model)
        folders = (paths.resources() / "robots" / model, Path(model)) if has_folder else ()
        folder = next((one for one in folders if (one / "view.toml").is_file()), None)
        name, address = told.get("robot", node.name), told.get("address", "")
        found.append(RobotPlan(name, driver == "naoqi", address, folder))
    return found


def look_of(state: RobotState | None) -> StateLook:
    """How a robot is whose node has told nothing yet."""
    if state is None:
        return StateLook("circle-dashed", "muted", tr("Not started"))
    return StateLook("circle-check", "success", tr("Ready"))
