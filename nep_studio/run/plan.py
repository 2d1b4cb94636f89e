"""Which nodes a project needs: those on its pages, and those that its rules cannot do without."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path, PureWindowsPath

from nep_core.errors import NepError, NodeError
from nep_core.places import node_folders
from nep_core.processes.manifest import NodeCatalog
from nep_studio.blocks.deployment import (
    POSTURE_NODE,
    NodeEntry,
    RobotEntry,
    is_recognised,
    named_gestures,
    names_used,
    node_entries,
    robot_entries,
)
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.fixes import WATCH
from nep_studio.blocks.own_gestures import TRIGGER, trained_gestures
from nep_studio.blocks.program import Project
from nep_studio.problems import Problem
from nep_studio.project.kept_files import (
    AnimationFiles,
    RecogniserFile,
    TakeFiles,
    animation_files,
    recogniser_file,
    take_files,
)

MASTER, PROGRAM, STUDIO = "master", "program", "studio"
"""What the parts of each session are called: its master, the node of its rules, and ours."""
VIRTUAL_WATCH = "sensory/virtual_watch"
WATCHES = (WATCH, VIRTUAL_WATCH)
"""What somebody wears, or seems to: of these one at a time gives the movements."""
REPLAY = "sensory/replay"
PROGRAM_NODE = "cognitive/program"
"""The node that runs a Python file; every session has one, and no page can have another."""
GESTURE = "perceptual/gesture"
FASTEST = 50.0
"""The highest ``speed`` that nodes take."""

Setting = str | float | int | bool


KeptFiles = AnimationFiles | RecogniserFile | TakeFiles
"""What a node reads of what the project keeps, in a folder of its own."""


# What a session plays, how a person watches it, and how it ended.


@dataclass(frozen=True)
class PlannedNode:
    """A node to start, and why, in words; ``block_id`` is its block, if it has one.

    ``files`` are written before it starts; ``inside`` are the settings that name a file beside the
    project.
    """

    node: str
    name: str
    parameters: Mapping[str, Setting] = field(default_factory=dict)
    reason: str = ""
    block_id: str = ""
    files: KeptFiles | None = None
    inside: frozenset[str] = frozenset()

    @property
    def is_sensory(self) -> bool:
        """Whether it measures; such nodes start last, so that nothing they say is missed."""
        return self.node.startswith("sensory/")


@dataclass(frozen=True)
class Watching:
    """How a program is watched: the lines at which it pauses, and how long it stays at each."""

    breakpoints: tuple[int, ...] = ()
    line_s: float = 0.0


@dataclass(frozen=True)
class Ending:
    """How a session ended: well, or with a problem; ``line`` of the program, 0 where none is."""

    problem: Problem | None = None
    line: int = 0


@dataclass(frozen=True)
class Choices:
    """What the person who runs the project decides: a recording, addresses of robots by name.

    ``speed``: how many times as fast the recording goes, or who wears a virtual watch, and how
    fast virtual robots act. What is real keeps its pace. ``virtual``: the real robots whose
    parts those on the screen play. ``by_itself``: nobody is there to press a button, so that who
    wears a virtual watch makes the gestures unasked. ``watch``: one that was left running, which
    is used rather than a new one.
    """

    recording: Path | None = None
    speed: float = 1.0
    addresses: Mapping[str, str] = field(default_factory=dict)
    virtual: frozenset[str] = frozenset()
    by_itself: bool = False
    watch: PlannedNode | None = None

    def have_made(self, node: PlannedNode) -> bool:
        """Whether a node is as it is because a person has chosen so now."""
        recording = "" if self.recording is None else str(self.recording)
        return node.name in self.addresses or recording in filter(None, node.parameters.values())


NO_CHOICES = Choices()


def plan(project: Project, language: Language, choices: Choices, folder: Path) -> list[PlannedNode]:
    """The nodes to start; files in their settings are looked for in ``folder``, the project's."""
    listed = node_entries(project, language)
    nodes = [_listed(entry, folder, project) for entry in listed]
    names = {node.name for node in nodes}
    nodes += [
        robot_node(entry, language.profile.node, choices)
        for entry in robot_entries(project, language)
        if entry.name not in names
    ]
    if (files := animation_files(project)) is not None:
        nodes = [_with_animations(node, files, language.profile.node) for node in nodes]
    # The gestures that rules wait for and somebody has taught
    known = {*language.choices.get("gestures", {})} | {*trained_gestures(project)}
    gestures = [gesture for gesture in names_used(project, language, "gesture") if gesture in known]
    nodes += _missing_gestures(project, language, listed, gestures, {node.name for node in nodes})
    arms = list(names_used(project, language, "arm"))
    if arms and all(entry.node != POSTURE_NODE for entry in listed):
        name = _free("arm", {node.name for node in nodes})
        nodes.append(PlannedNode(POSTURE_NODE, name, {}, "a rule waits for how an arm is held"))
    nodes = _with_a_watch(nodes, choices, [*gestures, *arms])
    nodes = [with_takes(node, project) for node in nodes]
    if choices.speed == 1.0:
        return nodes
    return [_hurried(node, choices.speed, language.profile.node) for node in nodes]


class NotForPages(NodeError, title="This node is not for the Nodes page"):
    """A node that no project can start by itself: the program's own."""


def check_for_pages(node: str, name: str) -> None:
    """Raise NotForPages for a node that no page can start."""
    if node == PROGRAM_NODE:
        raise NotForPages(
            "“{name}” would run a Python file of its own.",
            checklist=(
                "Put the Python into blocks of the Behaviour page.",
                "Take it off the Nodes page.",
            ),
            name=name,
        )


def robot_node(entry: RobotEntry, node: str, choices: Choices = NO_CHOICES) -> PlannedNode:
    """A robot of the Robots page; ``node`` plays robots."""
    address = choices.addresses.get(entry.name, entry.address)
    driver = "naoqi" if entry.name in choices.addresses else entry.driver
    if entry.name in choices.virtual:
        driver = "virtual"
    settings: dict[str, Setting] = {"robot": entry.name, "driver": driver, "address": address}
    if entry.model:
        settings["model"] = entry.model
    return PlannedNode(node, entry.name, settings, block_id=entry.block_id)


def _with_animations(planned: PlannedNode, files: AnimationFiles, robot: str) -> PlannedNode:
    """A robot's node with the animations of the project; others as they are."""
    if planned.node != robot or "animations" in planned.parameters:
        return planned
    settings = {**planned.parameters, "animations": str(files.folder)}
    return replace(planned, parameters=settings, files=files)


def _hurried(planned: PlannedNode, speed: float, robot: str) -> PlannedNode:
    """A node of what is only simulated at a speed; others as they are."""
    settings = planned.parameters
    is_virtual_robot = planned.node == robot and settings.get("driver", "virtual") == "virtual"
    own = settings.get("speed", 1.0)
    if not isinstance(own, int | float):
        return planned
    if planned.node != VIRTUAL_WATCH and not is_virtual_robot:
        return planned
    return replace(planned, parameters={**settings, "speed": min(own * speed, FASTEST)})


def _listed(entry: NodeEntry, folder: Path, project: Project) -> PlannedNode:
    """A node of the page; one that is to recognise what the project has learned is given that."""
    node = listed_node(entry, folder)
    if node.node != GESTURE or node.parameters.get("model"):
        return node
    own, named = trained_gestures(project), named_gestures(entry.parameters)
    is_own = all(gesture in own for gesture in named) if named else bool(own)
    return _of_project(node, project) if is_own else node


def listed_node(entry: NodeEntry, folder: Path) -> PlannedNode:
    """A node as its block says; a file in the project's folder is given with its path.

    Only what the node itself calls a file is looked for.
    """
    try:
        known = NodeCatalog(node_folders()).find(entry.node).parameters
    except NepError:
        known = {}  # it cannot start: the checks say so
    files = {
        name: file
        for name, value in entry.parameters.items()
        if name in known and known[name].type == "file"
        if (file := file_inside(folder, value)) is not None
    }
    settings = {
        name: str(files.get(name, value)) if name in files else value
        for name, value in entry.parameters.items()
    }
    return PlannedNode(
        entry.node, entry.name, settings, "", entry.block_id, inside=frozenset(files)
    )


LONGEST_PATH = 255


def file_inside(folder: Path, named: Setting) -> Path | None:
    """A file, or a folder, that is inside the project's folder; None for any other.

    Nothing leads out of the folder: no other drive or computer, no ``..``, no link, and no name
    that Windows reads as another one.
    """
    if not isinstance(named, str) or not 0 < len(named) <= LONGEST_PATH or not named.isprintable():
        return None
    path = PureWindowsPath(named)  # which knows both kinds of slashes
    if path.anchor or path.is_reserved() or any(_is_odd(part) for part in path.parts):
        return None
    file = folder / Path(named)
    try:
        is_inside = file.resolve(strict=True).is_relative_to(folder.resolve(strict=True))
    except (OSError, RuntimeError):  # it is not there, or links lead in a circle
        return None
    return file if is_inside else None


def _is_odd(part: str) -> bool:
    return part == ".." or ":" in part or part != part.rstrip(" .") or part != part.lstrip()


def _missing_gestures(
    project: Project,
    language: Language,
    listed: tuple[NodeEntry, ...],
    gestures: list[str],
    names: set[str],
) -> list[PlannedNode]:
    """Nodes for gestures that no node of the page recognises: one for all of the project's own."""
    shipped, own = language.choices.get("gestures", {}), trained_gestures(project)
    missing = [gesture for gesture in gestures if not is_recognised(gesture, listed, shipped, own)]
    reason = "a rule waits for this gesture"
    nodes = [
        PlannedNode(GESTURE, _free(gesture, names), {"gesture": gesture}, reason)
        for gesture in missing
        if gesture not in own
    ]
    if any(gesture in own for gesture in missing):
        node = PlannedNode(GESTURE, _free("gestures", names), {}, "rules wait for your gestures")
        nodes.append(_of_project(node, project))
    return nodes


def _of_project(node: PlannedNode, project: Project) -> PlannedNode:
    """A gesture node with what the project has learned, as certain as each gesture wants it."""
    file, own = recogniser_file(project), trained_gestures(project)
    if file is None:
        return node
    settings: dict[str, Setting] = {**node.parameters, "model": str(file.path)}
    points = {name: one.certainty for name, one in own.items() if one.certainty != TRIGGER}
    if points and "certainty" not in settings:
        settings["certainties"] = ", ".join(f"{name} {point:g}" for name, point in points.items())
    return replace(node, parameters=settings, files=file)


def with_takes(node: PlannedNode, project: Project) -> PlannedNode:
    """A virtual watch that can make the project's gestures; others as they are."""
    if node.node != VIRTUAL_WATCH or node.parameters.get("takes"):
        return node
    files = take_files(project)
    if files is None:
        return node
    return replace(node, parameters={**node.parameters, "takes": str(files.folder)}, files=files)


def _free(name: str, names: set[str]) -> str:
    return name if name not in names else _free(f"{name}_gesture", names)


def _with_a_watch(
    nodes: list[PlannedNode], choices: Choices, gestures: list[str]
) -> list[PlannedNode]:
    """Give the gesture nodes something to look at: the recording, else a watch.

    A virtual watch that is to move by itself makes ``gestures``, those that the rules wait for,
    with how an arm is to be held; any other waits until somebody asks.
    """
    if choices.recording is not None:
        settings: dict[str, Setting] = {
            "recording": str(choices.recording),
            "speed": choices.speed,
            "quit_at_end": True,
        }
        others = [node for node in nodes if not node.is_sensory]
        return [*others, PlannedNode(REPLAY, "recording", settings, "it was asked for")]
    if gestures and not any(node.is_sensory for node in nodes):
        nodes = [*nodes, _left(choices.watch) if choices.watch is not None else _watch(choices)]
    return [_moving(node, gestures) for node in nodes]


def _watch(choices: Choices) -> PlannedNode:
    settings: dict[str, Setting] = {"by_itself": True} if choices.by_itself else {}
    return PlannedNode(VIRTUAL_WATCH, "virtual_watch", settings, "somebody must make the gestures")


def _left(watch: PlannedNode) -> PlannedNode:
    """A watch that was left running; it is to make the gestures that the project has now."""
    if watch.node != VIRTUAL_WATCH:
        return watch
    settings = {name: value for name, value in watch.parameters.items() if name != "takes"}
    return replace(watch, parameters=settings, files=None)


def _moving(node: PlannedNode, gestures: list[str]) -> PlannedNode:
    """A virtual watch that moves by itself with what it makes; others as they are."""
    if node.node != VIRTUAL_WATCH or not node.parameters.get("by_itself"):
        return node
    settings = {name: value for name, value in node.parameters.items() if name != "by_itself"}
    made = settings.get("gestures") or ", ".join(gestures)
    return replace(node, parameters={**settings, "gestures": made})
