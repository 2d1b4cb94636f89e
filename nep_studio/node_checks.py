"""Checks of a project against this installation: its nodes, their settings, their names."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path

from nep_core.errors import NepError
from nep_core.manifest import Manifest, NodeCatalog
from nep_core.places import node_folders
from nep_studio.blocks.checks import Problem, check
from nep_studio.blocks.deployment import (
    GESTURE_NODE,
    NodeEntry,
    RobotEntry,
    named_gestures,
    node_entries,
    robot_entries,
)
from nep_studio.blocks.language import Language
from nep_studio.blocks.own_gestures import trained_gestures
from nep_studio.blocks.program import Project

RESERVED_NAMES = ("master", "studio", "program", "recording")
"""Names of the parts that every session has."""


def all_problems(project: Project, language: Language, folder: Path) -> list[Problem]:
    """Everything that can be told before a project runs, errors first.

    ``folder`` is where the project's own files are.
    """
    catalog = NodeCatalog(node_folders())
    nodes, robots = node_entries(project, language), robot_entries(project, language)
    known = _known_gestures(project, language)
    found = [
        *check(project, language),
        *(problem for entry in nodes for problem in _node(entry, catalog, known, folder)),
        *(problem for entry in robots for problem in _robot(entry)),
        *(_reserved("nodes", entry.name, entry.block_id) for entry in nodes),
        *(_reserved("robots", entry.name, entry.block_id) for entry in robots),
    ]
    order = {"error": 0, "warning": 1, "info": 2}
    return sorted((one for one in found if one is not None), key=lambda one: order[one.severity])


def _node(
    entry: NodeEntry, catalog: NodeCatalog, gestures: Collection[str], folder: Path
) -> Iterator[Problem]:
    try:
        manifest = catalog.find(entry.node)
        settings = manifest.read_parameters(dict(entry.parameters))
    except NepError as error:
        yield _wrong(entry, error.sentence, error.checklist)
        return
    for name, value in settings.items():
        if manifest.parameters[name].type == "file" and isinstance(value, str) and value:
            yield from _file(entry, name, value, folder)
    yield from _gesture(entry, manifest, gestures)


def _file(entry: NodeEntry, name: str, value: str, folder: Path) -> Iterator[Problem]:
    if not (folder / value).exists() and not Path(value).exists():
        yield _wrong(
            entry,
            f"There is no file {value} ({name}).",
            ("Put it beside the project.", "Or correct its name."),
        )


def _known_gestures(project: Project, language: Language) -> list[str]:
    """The gestures that the project has learned, and those that every project has."""
    return [*trained_gestures(project), *language.choices.get("gestures", {})]


def _gesture(entry: NodeEntry, manifest: Manifest, known: Collection[str]) -> Iterator[Problem]:
    if manifest.id != GESTURE_NODE or entry.parameters.get("model"):
        return
    for gesture in named_gestures(entry):
        if gesture not in known:
            yield _wrong(
                entry,
                f"Nobody has taught the gesture “{gesture}” yet.",
                (f"Choose one of: {', '.join(known)}.", "Or name a model of your own: model=..."),
            )


def _wrong(entry: NodeEntry, sentence: str, checklist: tuple[str, ...]) -> Problem:
    words = f"The node “{entry.name}” cannot start. {sentence}"
    return Problem("error", "node_settings", "nodes", entry.block_id, words, checklist)


def _robot(entry: RobotEntry) -> Iterator[Problem]:
    if entry.driver == "naoqi" and not entry.address.strip():
        yield Problem(
            "error",
            "robot_address",
            "robots",
            entry.block_id,
            f"Where is {entry.name}? A real robot needs its address.",
            (
                "Press the robot's chest button once: it says its address. Write it here.",
                "Or choose the robot on this screen.",
            ),
        )


def _reserved(page: str, name: str, block_id: str) -> Problem | None:
    if name not in RESERVED_NAMES:
        return None
    sentence = f"“{name}” is the name of a part that every project has."
    return Problem("error", "reserved_name", page, block_id, sentence, ("Give it another name.",))
