"""Checks of a project against this installation: its nodes, their settings, their names."""

from __future__ import annotations

import logging
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from faults import Text, Words, text_of
from faults.files import is_elsewhere, read_toml
from nep_core.errors import ManifestError, NepError
from nep_core.places import node_folders
from nep_core.processes.manifest import NodeCatalog, read_manifest
from nep_studio import paths
from nep_studio.blocks.checks import KnownChains, check_steps
from nep_studio.blocks.checks.diagnostic import SEVERITIES, Diagnostic
from nep_studio.blocks.definition_files import load_definitions, load_profiles
from nep_studio.blocks.definition_files import read_toml as read_definitions
from nep_studio.blocks.deployment import (
    GESTURE_NODE,
    NodeEntry,
    RobotEntry,
    named_gestures,
    node_entries,
    robot_entries,
)
from nep_studio.blocks.generate.rules import generator_names
from nep_studio.blocks.language import Language, together, translated
from nep_studio.blocks.own_gestures import trained_gestures
from nep_studio.blocks.program import Project
from nep_studio.blocks.slices import Steps, at_once
from nep_studio.blocks.slots import COLOURS

from .plan import check_for_pages

log = logging.getLogger(__name__)

RESERVED_NAMES = ("master", "studio", "program", "recording")
"""Names of the parts that every session has."""


def all_problems(project: Project, language: Language, folder: Path) -> list[Diagnostic]:
    """Everything that can be told before a project runs, errors first.

    ``folder`` is where the project's own files are.
    """
    return at_once(problem_steps(project, language, folder))


def problem_steps(
    project: Project, language: Language, folder: Path, known: KnownProblems | None = None
) -> Steps[list[Diagnostic]]:
    """The same in steps; ``known`` has what was found the last time."""
    known = known or KnownProblems()
    nodes, robots = node_entries(project, language), robot_entries(project, language)
    learned = (project, project.extra_revision, language.choices.get("gestures"))
    if known.learned != learned:
        # those that the project has learned, and those that every project has
        gestures = [*trained_gestures(project), *language.choices.get("gestures", {})]
        known.learned, known.gestures = learned, gestures
    found = [
        *(yield from check_steps(project, language, known.chains)),
        *known.of_nodes(nodes, known.gestures, folder),
        *(_homeless(one) for one in robots if one.driver == "naoqi" and not one.address.strip()),
        *(_reserved("nodes", entry) for entry in nodes if entry.name in RESERVED_NAMES),
        *(_reserved("robots", entry) for entry in robots if entry.name in RESERVED_NAMES),
    ]
    return [one for severity in SEVERITIES for one in found if one.severity == severity]


class KnownProblems:
    """What was found the last time: what is as it was then is not looked at again."""

    def __init__(self) -> None:
        self.chains = KnownChains()
        self.learned: object = None
        """What the gestures follow from: to read them takes as long as their recordings are."""
        self.gestures: list[str] = []
        self._in_order: list[tuple[NodeEntry, list[str]]] = []
        """Nodes of the Nodes page, each with the gestures that were known then."""
        self.is_whole = False
        """Whether all nodes were, and what they need is nowhere that it could be gone from."""

    def of_nodes(
        self, entries: Iterable[NodeEntry], gestures: list[str], folder: Path
    ) -> list[Diagnostic]:
        """What is wrong with these nodes."""
        found, in_order, self.is_whole = list[Diagnostic](), [], True
        for entry in entries:
            if (entry, gestures) not in self._in_order:
                wrong = list(_node(entry, NodeCatalog(node_folders()), gestures, folder))
                found += wrong
                if wrong or _names_file(entry, folder):
                    self.is_whole = False
                    continue
            in_order.append((entry, gestures))
        self._in_order = in_order
        return found


def _names_file(entry: NodeEntry, folder: Path) -> bool:
    """Whether a setting is a file: that may be gone the next time."""
    texts = (value for value in entry.parameters.values() if isinstance(value, str) and value)
    return any(_is_there(folder, text) for text in texts)


def _is_there(folder: Path, text: str) -> bool:
    """Whether there is such a file; nobody looks for one on another computer."""
    if is_elsewhere(text):
        return False
    try:
        return (folder / text).exists() or Path(text).exists()
    except (OSError, ValueError):
        return False


def _node(
    entry: NodeEntry, catalog: NodeCatalog, gestures: Collection[str], folder: Path
) -> Iterator[Diagnostic]:
    try:
        check_for_pages(entry.node, entry.name)
        manifest = catalog.find(entry.node)
        settings = manifest.read_parameters(dict(entry.parameters))
    except NepError as error:
        yield _wrong(entry, error.sentence, error.checklist)
        return
    for name, value in settings.items():
        if manifest.parameters[name].type != "file" or not isinstance(value, str) or not value:
            continue
        if not _is_there(folder, value):
            yield _wrong(
                entry,
                text_of("There is no file {value} ({name}).", value=value, name=name),
                ("Put it beside the project.", "Or correct its name."),
            )
    if manifest.id != GESTURE_NODE or entry.parameters.get("model"):
        return
    for gesture in named_gestures(entry.parameters):
        if gesture not in gestures:
            yield _wrong(
                entry,
                text_of("Nobody has taught the gesture “{gesture}” yet.", gesture=gesture),
                (
                    text_of("Choose one of: {known}.", known=", ".join(gestures)),
                    "Or name a model of your own: model=...",
                ),
            )


def _wrong(entry: NodeEntry, sentence: Text, checklist: tuple[Words, ...]) -> Diagnostic:
    words = text_of("“{name}” cannot start. {sentence}", name=entry.name, sentence=sentence)
    return Diagnostic("error", "node_settings", "nodes", entry.block_id, words, checklist)


def _homeless(entry: RobotEntry) -> Diagnostic:
    sentence = text_of("Where is {name}? A real robot needs its address.", name=entry.name)
    checklist = (
        "Press the robot's chest button once: it says its address. Write it here.",
        "Or choose the robot on this screen.",
    )
    return Diagnostic("error", "robot_address", "robots", entry.block_id, sentence, checklist)


def _reserved(page: str, entry: RobotEntry | NodeEntry) -> Diagnostic:
    sentence = text_of("“{name}” is the name of a part that every project has.", name=entry.name)
    checklist = ("Give it another name.",)
    return Diagnostic("error", "reserved_name", page, entry.block_id, sentence, checklist)


# Load the block language from the folders that hold its definitions and its robot profile.


def load_language(
    blocks_folder: Path,
    robot_file: Path,
    *,
    gestures: Mapping[str, str] | None = None,
    nodes: Mapping[str, str] | None = None,
) -> Language:
    """Read the definitions and the robot profile, with those of the robots beside it.

    ``gestures`` (name to label) and ``nodes`` ("type/name" to label) are what this installation
    can recognise and launch. Raises DefinitionError, which names the file and the block.
    """
    found = load_definitions(blocks_folder, generator_names())
    profiles = load_profiles(robot_file)
    choices: dict[str, Mapping[str, str]] = {
        "gestures": gestures or {},
        "nodes": nodes or {},
        **profiles[0].choices,
        **found.choices,
    }
    if drivers := together(profile.choices for profile in profiles).get("drivers"):
        choices["drivers"] = drivers
    return Language(found.definitions, tuple(found.categories), choices, profiles)


# The block language with what this installation can recognise and launch.


def shipped_gestures() -> dict[str, str]:
    """The gestures of the shipped model: name to label."""
    path = paths.resources() / "gestures" / "paper.toml"
    gestures: dict[str, str] = read_definitions(path)["gestures"]
    return gestures


def launchable_nodes() -> dict[str, str]:
    """The nodes that can be launched: "type/name" to title.

    A node whose manifest is wrong is there too, so that a check can say what is wrong with it.
    """
    nodes = {}
    for path in NodeCatalog(node_folders()).paths():
        try:
            nodes[f"{path.parent.name}/{path.stem}"] = read_manifest(path).title
        except ManifestError:
            nodes[f"{path.parent.name}/{path.stem}"] = path.stem
    return nodes


def studio_language(code: str = "en") -> Language:
    """The language of this installation, in the words of ``code``; raises DefinitionError.

    Words that the table of ``code`` does not have stay English, all of them without a table.
    """
    resources = paths.resources()
    language = load_language(
        resources / "blocks",
        resources / "robots" / "nao" / "robot.toml",
        gestures=shipped_gestures(),
        nodes=launchable_nodes(),
    )
    if code == "en" or not _table_file(code).is_file():
        return language
    return translated(language, table_of(code), code)


def table_of(code: str) -> dict[str, Any]:
    """The words of a language: its table, and what nodes and robots bring along in it.

    So a node or a robot is added by its own files; where both have words, the table's are used.
    """
    table = table_in(_table_file(code))
    choices = table.get("choices", {})
    table["choices"] = choices = dict(choices) if isinstance(choices, dict) else {}
    for brought in (_titles_of_nodes(code), *_words_of_robots(code)):
        for name, labels in brought.items():
            told = choices.get(name, {})
            choices[name] = {**labels, **(told if isinstance(told, dict) else {})}
    window = table.get("window", {})
    colours = {name: window[name] for name, _ in COLOURS if name in window}
    table["words"] = {**colours, **table.get("words", {})}
    return table


def table_in(path: Path) -> dict[str, Any]:
    """A language's table; an empty one, and a warning, when it cannot be read."""
    try:
        return read_toml(path)
    except (OSError, ValueError, RecursionError) as error:
        log.warning(
            "The blocks' words in %s cannot be read, and stay English: %s", path.name, error
        )
        return {}


def _table_file(code: str) -> Path:
    return paths.resources() / "translations" / f"{code}.toml"


def _titles_of_nodes(code: str) -> dict[str, dict[str, str]]:
    titles = {}
    for path in NodeCatalog(node_folders()).paths():
        with suppress(ManifestError):  # a check tells what is wrong with it
            manifest = read_manifest(path)
            if code in manifest.titles:
                titles[manifest.id] = manifest.titles[code]
    return {"nodes": titles}


def _words_of_robots(code: str) -> Iterator[dict[str, dict[str, str]]]:
    """``[translations.de.drivers]`` and so on of each robot.toml: value = label."""
    for path in sorted((paths.resources() / "robots").glob("*/robot.toml")):
        brought = read_definitions(path).get("translations", {}).get(code, {})
        yield {name: labels for name, labels in brought.items() if isinstance(labels, dict)}
