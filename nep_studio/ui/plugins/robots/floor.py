"""What stands on the floor around the robots of a window, and tells the robots of it."""

from __future__ import annotations

import uuid
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.wire import messages as m
from nep_core.wire.messages import SURROUNDINGS, RobotState, Surroundings, Thing
from nep_studio import paths
from nep_studio.blocks.edits.content import SetExtra
from nep_studio.project.surroundings import KEY, MOST_THINGS, kept_things, replaced, to_keep
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.node_style import StateLook
from nep_studio.ui.plugins.cues.project import ProjectEar
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.document_files import Files
    from nep_studio.ui.shell.main_window import MainWindow


OFTEN_MS = 100
"""While something is dragged, robots are told where it is so often."""


class Floor(QObject):
    """Things that the project keeps, and visitors, who only come for a moment.

    ``changed`` tells that they are others, or elsewhere.
    """

    changed = Signal()

    def __init__(self, files: Files, runner: Runner, parent: QObject) -> None:
        super().__init__(parent)
        self._runner = runner
        self._kept: list[Thing] = []
        self._visitors: dict[str, Thing] = {}
        self._held: Thing | None = None
        self._has_told = False
        self._told: list[Thing] = []
        self._ear = ProjectEar(files, self)
        self._soon = QTimer(self, singleShot=True, interval=OFTEN_MS)
        self._soon.timeout.connect(self._tell)
        self._ear.changed.connect(self._on_project_changed)
        files.document_changed.connect(self._on_document_changed)
        runner.connected.connect(self._on_connected)
        self._on_project_changed()

    @property
    def is_open(self) -> bool:
        """Whether there is a project that can keep things."""
        return self._ear.editor is not None

    @property
    def has_room(self) -> bool:
        """Whether one thing more can be kept."""
        return self.is_open and len(self._kept) < MOST_THINGS

    @property
    def things(self) -> list[Thing]:
        """All that stands there now, where it is now."""
        there = [*self._kept, *self._visitors.values()]
        return replaced(there, self._held) if self._held is not None else there

    def find(self, thing_id: str) -> Thing | None:
        """The thing of an id."""
        return next((thing for thing in self.things if thing.id == thing_id), None)

    # What the project keeps

    def add(self, thing: Thing) -> None:
        """Keep a new thing."""
        self._keep([*self._kept, thing], tr("place a thing"))

    def change(self, thing: Thing, label: str = "") -> None:
        """Keep a thing as it is from now on; a visitor is only shown so."""
        self._held = None
        if thing.id in self._visitors:
            self.show(thing)
        else:
            self._keep(replaced(self._kept, thing), label or tr("change a thing"))

    def remove(self, thing_id: str) -> None:
        """Take a thing away."""
        self._held = None
        if thing_id in self._visitors:
            self.hide(thing_id)
        else:
            left = [thing for thing in self._kept if thing.id != thing_id]
            self._keep(left, tr("take a thing away"))

    def hold(self, thing: Thing) -> None:
        """Show a thing where it is dragged to, before it is put down there."""
        self._held = thing
        self._on_things_changed()

    # Visitors

    def show(self, visitor: Thing) -> None:
        """Let something be there that the project does not keep, or be elsewhere."""
        self._visitors[visitor.id] = visitor
        self._on_things_changed()

    def hide(self, visitor_id: str) -> None:
        """Let a visitor go."""
        if self._visitors.pop(visitor_id, None) is not None:
            self._on_things_changed()

    # What happens

    def _keep(self, things: Iterable[Thing], label: str) -> None:
        editor = self._ear.editor
        if editor is None:
            return
        kept = list(things)
        if kept != self._kept:
            editor.apply(SetExtra(KEY, to_keep(kept)), label)
        self._on_project_changed()

    def _on_project_changed(self) -> None:
        editor = self._ear.editor
        kept = kept_things(editor.project) if editor is not None else []
        if kept != self._kept:
            self._kept, self._held = kept, None
            self._on_things_changed()

    def _on_document_changed(self, _document: object) -> None:
        self._visitors.clear()
        self._on_things_changed()  # also that there is a project, or none, is news

    def _on_things_changed(self) -> None:
        self.changed.emit()
        if not self._soon.isActive():
            self._soon.start()

    def _on_connected(self) -> None:
        self._has_told, self._told = False, []
        self._tell()

    def _tell(self) -> None:
        """Tell the robots, unless they know; of nothing only when there was something."""
        things = self.things
        if things == self._told and (self._has_told or not things):
            return
        if self._runner.send(SURROUNDINGS, Surroundings(things=things)):
            self._has_told, self._told = True, things


def floor_of(window: MainWindow) -> Floor:
    """The floor of a window, made when it is first asked for."""
    runner = window.running.runner
    return runner.findChild(Floor) or Floor(window.files, runner, runner)


# Where the robots on the screen begin: beside each other, so that all are seen.

ACTION = "action/"
APART_M = 0.8
ORIGIN = (0.0, 0.0, 0.0)
BRAKING_MS = 500
"""So long a robot takes at most to come to rest."""
READY = ("ready", "busy", "warning")
"""How nodes are that hear what they are asked."""
Base = tuple[float, float, float]


class Starts(QObject):
    """Puts each robot to its place when its node is ready, and again when it is asked to."""

    def __init__(self, runner: Runner, parent: QObject) -> None:
        super().__init__(parent)
        self._runner = runner
        self._there: set[str] = set()
        runner.nodes_changed.connect(self._on_nodes_changed)

    def place_of(self, robot: str) -> Base:
        """Where a robot begins: x m, y m, theta rad on the floor."""
        return start_places(self._runner.planned()).get(robot, ORIGIN)

    def put_back(self, robot: str) -> None:
        """Stop a robot, and put it to where it began."""
        stop = m.ActionRequest(id=uuid.uuid4().hex, robots=[robot], action="stop", priority=100)
        self._runner.send(m.ACTION_REQUEST, stop)
        QTimer.singleShot(BRAKING_MS, self, lambda: self._put(robot))

    def _put(self, robot: str) -> None:
        request = m.SenseRequest(robot=robot, sense="place", place=self.place_of(robot))
        self._runner.send(m.SENSE_REQUEST, request)

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


def starts_of(window: MainWindow) -> Starts:
    """The starts of a window, made when they are first asked for."""
    runner = window.running.runner
    return runner.findChild(Starts) or Starts(runner, runner)


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
