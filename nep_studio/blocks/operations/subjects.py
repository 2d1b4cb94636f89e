"""What blocks are about (a variable, a robot, a gesture): where it is used, where it is defined."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from ..deployment import (
    GESTURE_NODE,
    GESTURE_STATE,
    NODE_BLOCK,
    ROBOT_BLOCK,
    node_entries,
    robot_entries,
)
from ..language import Language
from ..procedures import header_of, parameter_of, procedure_of
from ..program import Block, Project

SubjectKind = Literal["variable", "robot", "gesture", "procedure", "parameter"]


@dataclass(frozen=True, slots=True)
class Subject:
    """A thing that blocks name: variables and procedures by id, robots and gestures by name."""

    kind: SubjectKind
    name: str


def subjects_of(project: Project, language: Language, block_id: str) -> tuple[Subject, ...]:
    """What a block names, the most important first; empty when it names nothing."""
    return tuple(dict.fromkeys(_subjects(language, project.blocks[block_id])))


def uses_of(project: Project, language: Language, subject: Subject) -> tuple[str, ...]:
    """The blocks that name a thing, in page order; the block that defines it is one of them."""
    return tuple(
        block.id
        for stacks in project.pages.values()
        for stack in stacks
        for block in project.within(stack.body)
        if subject in _subjects(language, block)
    )


def definition_of(project: Project, language: Language, subject: Subject) -> str | None:
    """The block where a thing is defined, or None.

    A robot is defined on the Robots page, a gesture by its node on the Nodes page, an own block by
    its hat, a variable by the first block that sets it.
    """
    if subject.kind == "robot":
        entries = robot_entries(project, language)
        return next((entry.block_id for entry in entries if entry.name == subject.name), None)
    if subject.kind == "gesture":
        return _gesture_node(project, language, subject.name)
    if subject.kind == "variable":
        used = (project.blocks[block] for block in uses_of(project, language, subject))
        return next((block.id for block in used if _sets(language, block)), None)
    return header_of(project, subject.name.partition(".")[0]) or None


def _gesture_node(project: Project, language: Language, gesture: str) -> str | None:
    nodes = [entry for entry in node_entries(project, language) if entry.node == GESTURE_NODE]
    named = (entry for entry in nodes if entry.parameters.get("gesture") == gesture)
    for_all = (entry for entry in nodes if not entry.parameters.get("gesture"))
    entry = next(named, None) or next(for_all, None)
    return entry.block_id if entry is not None else None


def _sets(language: Language, block: Block) -> bool:
    definition = language.definitions.get(block.type)
    return definition is not None and not definition.is_value and block.type.endswith(".set")


def _subjects(language: Language, block: Block) -> Iterator[Subject]:
    definition = language.definitions.get(block.type)
    if definition is None:
        return
    yield from _own_block(block)
    for key, slot in definition.keys(block.groups):
        value = definition.value(block, key)
        if not isinstance(value, str) or not value:
            continue
        kind = slot.kind.name
        if kind in ("variable", "robot", "gesture"):
            yield Subject(kind, value)  # type: ignore[arg-type]
        elif kind == "state" and value.startswith(GESTURE_STATE):
            yield Subject("gesture", value.removeprefix(GESTURE_STATE))
        elif block.type == ROBOT_BLOCK and key == "name":
            yield Subject("robot", value)
    parameters = block.fields.get("parameters")
    if block.type == NODE_BLOCK and isinstance(parameters, dict) and parameters.get("gesture"):
        yield Subject("gesture", str(parameters["gesture"]))


def _own_block(block: Block) -> Iterator[Subject]:
    """An own block, and before it the parameter that a block stands for."""
    procedure, parameter = procedure_of(block.type), parameter_of(block.type)
    if parameter:
        yield Subject("parameter", f"{procedure}.{parameter}")
    if procedure:
        yield Subject("procedure", procedure)
