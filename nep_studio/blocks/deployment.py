"""What the Robots and Nodes pages say: which robots take part and which nodes run."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import cast

from .language import Language
from .procedures import DEFINE
from .program import ROBOT_BLOCK, Block, Project
from .slices import Steps, at_once
from .slots import GESTURE_STATE, FieldValue, Setting

NODE_BLOCK = "nodes.launch"
GESTURE_NODE = "perceptual/gesture"
"""What the human state of a recognised gesture begins with."""


@dataclass(frozen=True, slots=True)
class RobotEntry:
    """A robot of the Robots page; ``driver`` is virtual or naoqi, ``address`` host or host:port.

    ``model`` is "" for a NAO; the block's driver "virtual_pepper" is a virtual one of model pepper.
    """

    name: str
    driver: str
    address: str
    block_id: str
    model: str = ""


@dataclass(frozen=True, slots=True)
class NodeEntry:
    """A node of the Nodes page; ``node`` is "type/name"."""

    node: str
    name: str
    parameters: Mapping[str, Setting]
    block_id: str


def robot_entries(project: Project, language: Language) -> tuple[RobotEntry, ...]:
    """The robots of the Robots page, in its order."""
    entries = []
    for block in _entries(project, "robots", ROBOT_BLOCK):
        name, kind, address = _values(language, block, "name", "driver", "address")
        driver, _, model = str(kind).partition("_")
        entries.append(RobotEntry(str(name), driver, str(address), block.id, model))
    return tuple(entries)


def node_entries(project: Project, language: Language) -> tuple[NodeEntry, ...]:
    """The nodes of the Nodes page, in its order."""
    entries = []
    for block in _entries(project, "nodes", NODE_BLOCK):
        node, name, parameters = _values(language, block, "node", "name", "parameters")
        settings = dict(cast("Mapping[str, Setting]", parameters))
        entries.append(NodeEntry(str(node), str(name), settings, block.id))
    return tuple(entries)


def robots_used(project: Project, language: Language) -> dict[str, str]:
    """The robots that rules name, each with the first block that does; "*" is all of them."""
    return at_once(find_robots_used(project, language))


def find_robots_used(project: Project, language: Language) -> Steps[dict[str, str]]:
    """The same in steps."""
    used: dict[str, str] = {}
    for block, keys in _slots_of_kind(project, language, "robot"):
        yield
        for key in keys:
            name = str(language.definitions[block.type].value(block, key))
            used.setdefault(name, block.id)
    return used


def gestures_used(project: Project, language: Language) -> dict[str, str]:
    """The gestures that rules and questions name, each with the first block that does."""
    return at_once(find_gestures_used(project, language))


def find_gestures_used(project: Project, language: Language) -> Steps[dict[str, str]]:
    """The same in steps."""
    used: dict[str, str] = {}
    for kind in ("gesture", "state"):
        for block, keys in _slots_of_kind(project, language, kind):
            yield
            for key in keys:
                name = str(language.definitions[block.type].value(block, key))
                if kind == "gesture" or name.startswith(GESTURE_STATE):
                    used.setdefault(name.removeprefix(GESTURE_STATE), block.id)
    return used


def is_recognised(
    gesture: str,
    nodes: tuple[NodeEntry, ...],
    shipped: Iterable[str],
    own: Container[str] = (),
) -> bool:
    """Whether a node of the Nodes page recognises a gesture.

    A node that names no gesture recognises all of its model: those of a file, which only training
    knows, else those that the project has learned (``own``), else the ``shipped`` ones.
    """
    for entry in nodes:
        if entry.node == GESTURE_NODE:
            named, model = named_gestures(entry), entry.parameters.get("model")
            if gesture in named or (not named and (model or gesture in (own or shipped))):
                return True
    return False


def named_gestures(entry: NodeEntry) -> list[str]:
    """The gestures that a node is to recognise; none stands for all of its model."""
    named = str(entry.parameters.get("gesture") or "").split(",")
    return [name.strip() for name in named if name.strip()]


def rules(project: Project, language: Language) -> Iterator[list[str]]:
    """The chains of the behaviour pages that begin with an enabled “when”: those that run."""
    for chain in chains(project, language):
        if not project.blocks[chain[0]].type.startswith(DEFINE):
            yield chain


def chains(project: Project, language: Language) -> Iterator[list[str]]:
    """The rules, and the chains that define own blocks: all that becomes code."""
    definitions = language.of(project).definitions
    for _, stack in project.stacks_of_kind("behaviour"):
        first = project.blocks[stack.body[0]]
        definition = definitions.get(first.type)
        if definition is not None and definition.shape == "hat" and not first.disabled:
            yield stack.body


def _slots_of_kind(
    project: Project, language: Language, kind: str
) -> Iterator[tuple[Block, list[str]]]:
    """The blocks in rules, and of each the keys of its slots of this kind, mostly none."""
    has_kind: dict[str, bool] = {}
    for chain in chains(project, language):
        for block in project.within(chain, enabled=True):
            definition = language.definitions.get(block.type)
            if definition is None:
                continue
            if block.type not in has_kind:
                slots = definition.slots.values()
                has_kind[block.type] = any(slot.kind.name == kind for slot in slots)
            keys = definition.keys(block.groups) if has_kind[block.type] else ()
            yield block, [key for key, slot in keys if slot.kind.name == kind]


def _entries(project: Project, page: str, block_type: str) -> Iterator[Block]:
    for stack in project.pages[page]:
        for block_id in stack.body:
            block = project.blocks[block_id]
            if block.type == block_type and not block.disabled:
                yield block


def _values(language: Language, block: Block, *keys: str) -> list[FieldValue | None]:
    definition = language.definitions[block.type]
    return [definition.value(block, key) for key in keys]
