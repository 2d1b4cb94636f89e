"""Find blocks by words: in their sentences, fields, comments and names."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Literal

from faults import Text, text_of
from nep_studio.blocks.definitions import Group
from nep_studio.blocks.deployment import (
    GESTURE_NODE,
    NODE_BLOCK,
    named_gestures,
    node_entries,
    robot_entries,
)
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import header_of, parameter_of, procedure_of
from nep_studio.blocks.program import ALL_ROBOTS, ROBOT_BLOCK, Block, Project
from nep_studio.blocks.slots import GESTURE_STATE, why_not_name
from nep_studio.blocks.text import field_text, sentence


def find(project: Project, language: Language, text: str) -> tuple[str, ...]:
    """The blocks that have all words of ``text`` in them, in page order.

    Case and accents do not count; a word may be a part of one. Blocks inside a block count for
    themselves only.
    """
    words = folded(text).split()
    if not words:
        return ()
    return tuple(b.id for b in _all_blocks(project) if _has(project, language, b, words))


def folded(text: str) -> str:
    """Text without case and accents, to compare it by."""
    letters = unicodedata.normalize("NFKD", text)
    return "".join(c for c in letters if not unicodedata.combining(c)).casefold()


def _has(project: Project, language: Language, block: Block, words: list[str]) -> bool:
    text = folded(" ".join([*_said(project, language, block), block.comment]))
    return all(word in text for word in words)


def _said(project: Project, language: Language, block: Block) -> Iterator[str]:
    """The words and fields of a block itself."""
    definition = language.definitions.get(block.type)
    if definition is None:
        yield block.type
        return
    for part in definition.parts:
        inner = part.parts if isinstance(part, Group) else (part,)
        is_there = not isinstance(part, Group) or block.groups.get(part.name, 0) > 0
        if is_there:
            yield from (words for words in inner if isinstance(words, str))
    for key, slot in definition.keys(block.groups):
        if key not in block.inputs and slot.kind.name != "body":
            yield field_text(project, language, block, slot, definition.value(block, key), key)


# What blocks are about (a variable, a robot, a gesture): where it is used, where it is defined.

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
    return tuple(b.id for b in _all_blocks(project) if subject in _subjects(language, b))


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
    named = [entry.block_id for entry in nodes if gesture in named_gestures(entry.parameters)]
    for_all = [entry.block_id for entry in nodes if not named_gestures(entry.parameters)]
    return next(iter([*named, *for_all]), None)


def _sets(language: Language, block: Block) -> bool:
    definition = language.definitions.get(block.type)
    return definition is not None and not definition.is_value and block.type.endswith(".set")


def _subjects(language: Language, block: Block) -> Iterator[Subject]:
    definition = language.definitions.get(block.type)
    if definition is None:
        return
    # an own block, and before it the parameter that a block stands for
    procedure, parameter = procedure_of(block.type), parameter_of(block.type)
    if parameter:
        yield Subject("parameter", f"{procedure}.{parameter}")
    if procedure:
        yield Subject("procedure", procedure)
    for key, slot in definition.keys(block.groups):
        value = definition.value(block, key)
        if not isinstance(value, str) or not value or key in block.inputs:
            continue
        kind = slot.kind.name
        if kind in ("variable", "robot", "gesture"):
            yield Subject(kind, value)  # type: ignore[arg-type]
        elif kind == "state" and value.startswith(GESTURE_STATE):
            yield Subject("gesture", value.removeprefix(GESTURE_STATE))
        elif block.type == ROBOT_BLOCK and key == "name":
            yield Subject("robot", value)
    parameters = block.fields.get("parameters")
    if block.type == NODE_BLOCK and isinstance(parameters, dict):
        yield from (Subject("gesture", name) for name in named_gestures(parameters))


def why_not_robot_name(editor: Editor, name: str) -> Text | None:
    """Why a new robot cannot have this name, or None when it can."""
    if name == ALL_ROBOTS:
        return text_of(
            "“{all_robots}” stands for all robots, and cannot be the name of one.",
            all_robots=ALL_ROBOTS,
        )
    if any(entry.name == name for entry in robot_entries(editor.project, editor.language)):
        return text_of("There is a robot “{new}” already.", new=name)
    return why_not_name(name)


# What is different between two versions of a project, in words, block by block.

What = Literal["added", "removed", "changed", "moved"]


@dataclass(frozen=True, slots=True)
class Difference:
    """One block that differs: ``sentence`` is what it says now, ``before`` what it said."""

    what: What
    block: str
    sentence: str
    before: str = ""


def compare(old: Project, new: Project, language: Language) -> tuple[Difference, ...]:
    """The blocks that differ, as ids say which are the same; a block that moved with the one
    around it has not moved itself.
    """
    moved = _moved(old, new)
    found = []
    for block in _all_blocks(new):
        said, before = sentence(new, language, block.id), old.blocks.get(block.id)
        if before is None:
            found.append(Difference("added", block.id, said))
            continue
        if block.id in moved:
            found.append(Difference("moved", block.id, said))
        if _content(before) != _content(block):
            was = sentence(old, language, block.id)
            found.append(Difference("changed", block.id, said, was))
    gone = [block.id for block in _all_blocks(old) if block.id not in new.blocks]
    found += [Difference("removed", block, sentence(old, language, block)) for block in gone]
    return tuple(found)


def _all_blocks(project: Project) -> Iterator[Block]:
    for stacks in project.pages.values():
        for stack in stacks:
            yield from project.within(stack.body)


def _content(block: Block) -> tuple[object, ...]:
    flags = block.disabled, block.collapsed, block.comment
    return block.type, block.fields, block.groups, flags, block.extra


def _moved(old: Project, new: Project) -> set[str]:
    """Blocks that are in another place, or in another order among those that stayed there."""
    both = old.blocks.keys() & new.blocks.keys()
    moved = {block for block in both if old.parents[block] != new.parents[block]}
    for parent in {new.parents[block] for block in both - moved}:
        before = [b for b in old.chain_of(parent) or () if b in both - moved]
        after = [b for b in new.chain_of(parent) or () if b in both - moved]
        moved |= _out_of_order(before, after)
    return moved


def _out_of_order(before: Sequence[str], after: Sequence[str]) -> set[str]:
    """The fewest blocks, about, that must have moved to come from one order to the other."""
    if before == after:
        return set()
    matcher = SequenceMatcher(None, before, after, autojunk=False)
    stayed = {b for match in matcher.get_matching_blocks() for b in before[match.a :][: match.size]}
    return set(after) - stayed
