"""Which nodes a project needs: those on its pages, and those that its rules cannot do without."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from nep_studio.animation_files import AnimationFiles, animation_files
from nep_studio.blocks.deployment import (
    NodeEntry,
    RobotEntry,
    gestures_used,
    is_recognised,
    node_entries,
    robot_entries,
)
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project

VIRTUAL_WATCH = "sensory/virtual_watch"
REPLAY = "sensory/replay"
GESTURE = "perceptual/gesture"
FASTEST = 50.0
"""The highest ``speed`` that nodes take."""

Setting = str | float | int | bool


@dataclass(frozen=True)
class PlannedNode:
    """A node to start, and why, in words; ``block_id`` is its block, if it has one.

    ``files`` are written before it starts.
    """

    node: str
    name: str
    parameters: Mapping[str, Setting] = field(default_factory=dict)
    reason: str = ""
    block_id: str = ""
    files: AnimationFiles | None = None

    @property
    def is_sensory(self) -> bool:
        """Whether it measures; such nodes start last, so that nothing they say is missed."""
        return self.node.startswith("sensory/")


@dataclass(frozen=True)
class Choices:
    """What the person who runs the project decides: a recording, addresses of robots by name.

    ``speed``: how many times as fast the recording goes, or who wears a virtual watch, and how
    fast virtual robots act. What is real keeps its pace. ``virtual``: the real robots whose
    parts those on the screen play.
    """

    recording: Path | None = None
    speed: float = 1.0
    addresses: Mapping[str, str] = field(default_factory=dict)
    virtual: frozenset[str] = frozenset()


def plan(project: Project, language: Language, choices: Choices, folder: Path) -> list[PlannedNode]:
    """The nodes to start; files in their settings are looked for in ``folder``, the project's."""
    listed = node_entries(project, language)
    robots = _robots(project, language, choices)
    nodes = [_listed(entry, folder) for entry in listed]
    names = {node.name for node in nodes}
    nodes += [robot for robot in robots if robot.name not in names]
    if (files := animation_files(project)) is not None:
        nodes = [_with_animations(node, files, language.profile.node) for node in nodes]
    known = language.choices.get("gestures", {})
    nodes += _missing_gestures(project, language, listed, {node.name for node in nodes})
    wanted = [gesture for gesture in gestures_used(project, language) if gesture in known]
    nodes = _with_a_watch(nodes, choices, wanted)
    return [_hurried(node, choices.speed, language.profile.node) for node in nodes]


def _robots(project: Project, language: Language, choices: Choices) -> list[PlannedNode]:
    node = language.profile.node
    return [_robot(entry, choices, node) for entry in robot_entries(project, language)]


def _robot(entry: RobotEntry, choices: Choices, node: str) -> PlannedNode:
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
    if speed == 1.0 or not isinstance(own, int | float):
        return planned
    if planned.node != VIRTUAL_WATCH and not is_virtual_robot:
        return planned
    return replace(planned, parameters={**settings, "speed": min(own * speed, FASTEST)})


def _listed(entry: NodeEntry, folder: Path) -> PlannedNode:
    settings = {key: _found(value, folder) for key, value in entry.parameters.items()}
    return PlannedNode(entry.node, entry.name, settings, "", entry.block_id)


def _found(value: Setting, folder: Path) -> Setting:
    """A file name as a path, when there is such a file in the project's folder."""
    if not isinstance(value, str) or not value or "\0" in value or len(value) > 255:
        return value
    return str(folder / value) if (folder / value).is_file() else value


def _missing_gestures(
    project: Project, language: Language, listed: tuple[NodeEntry, ...], names: set[str]
) -> list[PlannedNode]:
    known = language.choices.get("gestures", {})
    missing = [
        gesture
        for gesture in gestures_used(project, language)
        if gesture in known and not is_recognised(gesture, listed, known)
    ]
    reason = "a rule waits for this gesture"
    return [
        PlannedNode(GESTURE, _free(gesture, names), {"gesture": gesture}, reason)
        for gesture in missing
    ]


def _free(name: str, names: set[str]) -> str:
    return name if name not in names else _free(f"{name}_gesture", names)


def _with_a_watch(
    nodes: list[PlannedNode], choices: Choices, gestures: list[str]
) -> list[PlannedNode]:
    """Give the gesture nodes something to look at: the recording, else a watch.

    The virtual watch makes ``gestures``, those that the rules wait for.
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
        schedule = {"gestures": ", ".join(gestures)}
        reason = "somebody must make the gestures"
        return [*nodes, PlannedNode(VIRTUAL_WATCH, "virtual_watch", schedule, reason)]
    return nodes
