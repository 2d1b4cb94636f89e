"""What the Robots and Nodes pages say: which robots take part and which nodes run."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple, cast

from .language import Language
from .procedures import DEFINE
from .program import ROBOT_BLOCK, Block, Project
from .slots import ARM_STATE, GESTURE_STATE, Setting

NODE_BLOCK = "nodes.launch"
OUTSIDE_BLOCK = "code.program"
"""The block of Python that stands outside of all functions: no rule, but it becomes code."""
GESTURE_NODE = "perceptual/gesture"
"""The node that recognises gestures."""
POSTURE_NODE = "perceptual/posture"
"""The node that tells how an arm is held."""


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
    for block in _enabled(project, "robots", ROBOT_BLOCK):
        value = language.definitions[block.type].value
        driver, _, model = str(value(block, "driver")).partition("_")
        name, address = str(value(block, "name")), str(value(block, "address"))
        entries.append(RobotEntry(name, driver, address, block.id, model))
    return tuple(entries)


def node_entries(project: Project, language: Language) -> tuple[NodeEntry, ...]:
    """The nodes of the Nodes page, in its order."""
    entries = []
    for block in _enabled(project, "nodes", NODE_BLOCK):
        value = language.definitions[block.type].value
        settings = dict(cast("Mapping[str, Setting]", value(block, "parameters")))
        node, name = str(value(block, "node")), str(value(block, "name"))
        entries.append(NodeEntry(node, name, settings, block.id))
    return tuple(entries)


class Use(NamedTuple):
    """A block of a rule names a "robot" ("*": all), a "gesture", an "arm", a "message", a "rule".

    An "arm" is the human state that tells how an arm is held.

    Of messages, "heard" are those with which a rule begins.
    """

    kind: str
    name: str
    block: str


def find_uses(project: Project, language: Language, chain: list[str]) -> Iterator[Use | None]:
    """The robots and gestures that the blocks of a chain name; None wherever it may rest."""
    for block in project.within(chain, enabled=True):
        yield None
        definition = language.definitions.get(block.type)
        if definition is None or _NAMING.isdisjoint(definition.kinds):
            continue
        for key, slot in definition.keys(block.groups):
            if project.plugged(block, key) is not None:
                continue  # what it names is known only while the program runs
            kind, name = slot.kind.name, str(definition.value(block, key))
            if kind == "gesture" or (kind == "state" and name.startswith(GESTURE_STATE)):
                yield Use("gesture", name.removeprefix(GESTURE_STATE), block.id)
            elif kind == "message" and definition.shape == "hat":
                yield Use("heard", name, block.id)
            elif kind in ("robot", "message", "rule"):
                yield Use(kind, name, block.id)
            elif (kind == "state" or kind in _HOLDING) and is_arm_state(name, language):
                yield Use("arm", name, block.id)
            elif name.startswith(GESTURE_STATE) and kind in _HOLDING:
                gesture = name.removeprefix(GESTURE_STATE)
                if gesture in language.choices.get("gestures", ()):
                    yield Use("gesture", gesture, block.id)


def is_arm_state(state: str, language: Language) -> bool:
    """Whether a human state tells how the arm that wears a watch is held."""
    postures = language.choices.get("arm_postures", ())
    return state.startswith(ARM_STATE) and state.removeprefix(ARM_STATE) in postures


_HOLDING = ("any", "text")
"""The kinds of the slots whose text may go into the place of a human state later."""
_NAMING = frozenset(("robot", "gesture", "state", "message", "rule", *_HOLDING))
"""The kinds of the slots that name something of the project."""


def names_used(project: Project, language: Language, kind: str) -> dict[str, str]:
    """The robots or gestures that rules name, each with the first block that does."""
    used: dict[str, str] = {}
    for chain in chains(project, language):
        for use in find_uses(project, language, chain):
            if use is not None and use.kind == kind:
                used.setdefault(use.name, use.block)
    return used


def is_recognised(
    gesture: str, nodes: tuple[NodeEntry, ...], shipped: Iterable[str], own: Container[str] = ()
) -> bool:
    """Whether a node of the Nodes page recognises a gesture.

    A node that names no gesture recognises all of its model: those of a file, which only training
    knows, else those that the project has learned (``own``), else the ``shipped`` ones.
    """
    for entry in nodes:
        if entry.node == GESTURE_NODE:
            named, model = named_gestures(entry.parameters), entry.parameters.get("model")
            if gesture in named or (not named and (model or gesture in (own or shipped))):
                return True
    return False


def named_gestures(parameters: Mapping[str, Setting]) -> list[str]:
    """The gestures that a node is to recognise; none stands for all of its model."""
    named = str(parameters.get("gesture") or "").split(",")
    return [name.strip() for name in named if name.strip()]


def rules(project: Project, language: Language) -> Iterator[list[str]]:
    """The chains of the behaviour pages that begin with an enabled “when”: those that run."""
    for chain in chains(project, language):
        hat = project.blocks[chain[0]].type
        if not hat.startswith(DEFINE) and hat != OUTSIDE_BLOCK:
            yield chain


_NOT_STOPPED = frozenset(("goal", "when_goal"))
"""What makes the code of the beginnings of what is no rule by itself."""


def can_be_stopped(project: Project, language: Language, hat: str) -> bool:
    """Whether a block begins a rule that another rule can stop."""
    block = project.blocks.get(hat)
    definition = language.of(project).definitions.get(block.type) if block is not None else None
    if block is None or definition is None or definition.shape != "hat" or block.disabled:
        return False
    is_rule = not block.type.startswith(DEFINE) and block.type != OUTSIDE_BLOCK
    return is_rule and definition.generator not in _NOT_STOPPED


def chains(project: Project, language: Language) -> Iterator[list[str]]:
    """The rules, the chains that define own blocks, and own Python: all that becomes code."""
    definitions = language.of(project).definitions
    for page, stacks in project.pages.items():
        for stack in stacks if project.kind_of_page(page) == "behaviour" else ():
            first = project.blocks[stack.body[0]]
            definition = definitions.get(first.type)
            if definition is not None and definition.shape == "hat" and not first.disabled:
                yield stack.body


def _enabled(project: Project, page: str, block_type: str) -> Iterator[Block]:
    for stack in project.pages[page]:
        for block_id in stack.body:
            block = project.blocks[block_id]
            if block.type == block_type and not block.disabled:
                yield block
