"""Checks of how a program runs: loops without a pause, blocks never reached, walking unready."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.generate.expressions import DEEPEST_VALUE, value_cost
from nep_studio.blocks.generate.rules import DEEPEST_INDENT, DEEPEST_LOOP, LOOPS_OF_GUARD
from nep_studio.blocks.language import Language
from nep_studio.blocks.mouths import mouth_of
from nep_studio.blocks.program import ALL_ROBOTS, Block, Project
from nep_studio.blocks.sharing import (
    LIST_SLOT,
    RESIZING_LISTS,
    VARIABLE,
    Sharing,
    changed_in,
    is_slow,
    variables_set,
    waits,
)
from nep_studio.blocks.text import sentence

from .diagnostic import Fix, Found, found

_POSTURES = {"stands_up": "posture_stand", "rests": "posture_rest"}
"""The postures after blocks with such a flag."""
UNKNOWN = "?"
"""A posture that only the running program knows."""
FOR_EACH, CHANGE = "control.for_each", "variable.change"
_OF_POSTURE = {"posture", "stands", *_POSTURES}


def check_flow(project: Project, language: Language, chain: list[str]) -> Found:
    """Problems of the order in which blocks run."""
    blocks = list(project.within(chain, enabled=True))
    yield from _loops_without_pause(project, language, blocks)
    yield from _never_reached(project, language, chain, blocks)
    yield from _walking_unready(project, language, blocks)
    yield from _growing_lists(project, language, blocks)


def _loops_without_pause(project: Project, language: Language, blocks: list[Block]) -> Found:
    """Loops in whose bodies nothing takes time; children come after their parents in ``blocks``."""
    pauses: set[str] = set()
    for block in reversed(blocks):
        yield None
        definition = language.definitions.get(block.type)
        goes_on = definition is not None and not (
            waits(definition, block)
            or (definition.shape == "cap" and definition.generator != "next_round")
        )
        if not goes_on or not pauses.isdisjoint(block.children()):
            pauses.add(block.id)
        elif definition is not None and "needs_pause" in definition.flags:
            fix = Fix("add_wait", "Add a pause", {"block": block.id, "slot": "do"})
            yield found("no_pause", project, language, block.id, fix)


def _never_reached(
    project: Project, language: Language, chain: list[str], blocks: list[Block]
) -> Found:
    for chain_in in [chain, *(c for block in blocks for c in block.bodies.values())]:
        yield None
        enabled = [project.blocks[i] for i in chain_in if not project.blocks[i].disabled]
        for upper, lower in pairwise(enabled):
            definition = language.definitions.get(upper.type)
            if definition is not None and definition.is_last:
                before = sentence(project, language, upper.id)
                yield found("never_reached", project, language, lower.id, block_2=before)


def _walking_unready(project: Project, language: Language, blocks: list[Block]) -> Found:
    """Blocks that need a standing robot after one that made it sit; bodies count in their order."""
    postures: dict[str, str] = {}  # none where a robot's is known only while the program runs
    for block in blocks:
        yield None
        definition = language.definitions.get(block.type)
        if definition is None or definition.flags.isdisjoint(_OF_POSTURE):
            continue
        is_known = project.plugged(block, "robot") is None
        robot = str(definition.value(block, "robot"))
        taken = next((_POSTURES[flag] for flag in definition.flags if flag in _POSTURES), "")
        if "posture" in definition.flags:
            taken = str(definition.value(block, "posture"))
            taken = UNKNOWN if project.plugged(block, "posture") is not None else taken
        if taken:
            if robot == ALL_ROBOTS or not is_known:
                postures.clear()
            if is_known:
                postures[robot] = taken
            continue
        if not is_known:
            continue
        posture = postures.get(robot, postures.get(ALL_ROBOTS))
        if posture not in (None, UNKNOWN) and posture not in language.standing:
            label = language.choices.get("postures", {}).get(posture, posture)
            name = "A robot" if robot == ALL_ROBOTS else robot
            fix = Fix("stand_first", "Stand first", {"block": block.id, "robot": robot})
            yield found("not_standing", project, language, block.id, fix, name=name, label=label)


def _growing_lists(project: Project, language: Language, blocks: list[Block]) -> Found:
    """Blocks that add to a list, or take from it, in a loop that goes through it."""
    for loop in blocks:
        if loop.type != FOR_EACH or not (variable := _held(project, loop)):
            continue
        inside = [block_id for chain in loop.bodies.values() for block_id in chain]
        for block in project.within(inside, enabled=True):
            yield None
            if block.type in RESIZING_LISTS and _held(project, block) == variable:
                yield found("grows_in_loop", project, language, block.id)
                break


def _held(project: Project, block: Block) -> str:
    """The variable in the slot of a block for a list, "" where something else is."""
    held = project.blocks.get(block.inputs.get(LIST_SLOT, ""))
    is_variable = held is not None and held.type == VARIABLE and not held.disabled
    return str(held.fields.get("variable", "")) if held is not None and is_variable else ""


def check_shared(project: Project, language: Language, sharing: Sharing, chain: list[str]) -> Found:
    """Blocks that read and set what other rules set too, and wait in between."""
    for block in project.within(chain, enabled=True):
        yield None
        if block.type not in language.definitions or not block.inputs:
            continue
        inside = list(project.within(list(block.inputs.values()), enabled=True))
        if not any(is_slow(language, sharing, one) for one in inside):
            continue
        changed = changed_in(project, block)  # one thing for all: what others put into it stays
        values = [one for one in inside if one is not changed]
        read = {str(one.fields.get("variable", "")) for one in values if one.type == VARIABLE}
        read |= {str(block.fields.get("variable", ""))} if block.type == CHANGE else set()
        for variable in variables_set(project, language, block):
            known = project.variable(variable)
            if known is not None and variable in sharing.shared & read:
                yield found("torn_apart", project, language, block.id, variable=known.name)


# Checks of what Python itself cannot take: loops in loops in loops, values in values.


class _Depth(NamedTuple):
    """How deep a block is: in loops of its function, in bodies, in values."""

    loops: int
    indent: int
    values: int


def check_limits(project: Project, language: Language, chain: list[str]) -> Found:
    """The blocks that are nested too deep, the outermost of each chain of them."""
    waiting = [(block_id, _Depth(0, 1, 0)) for block_id in reversed(chain)]
    while waiting:
        yield None
        block_id, depth = waiting.pop()
        block = project.blocks[block_id]
        definition = language.definitions.get(block.type)
        if block.disabled or definition is None:
            continue
        inside = _inside(block, definition, depth)
        if inside is not None:
            waiting += [(child, inside) for child in block.children()]
            continue
        yield found(
            "too_deep",
            project,
            language,
            block_id,
            deepest_loop=DEEPEST_LOOP,
            deepest_indent=DEEPEST_INDENT,
            deepest_value=DEEPEST_VALUE,
        )


def _inside(block: Block, definition: Definition, depth: _Depth) -> _Depth | None:
    """How deep the blocks inside a block are; None where that is too deep."""
    if definition.is_value:
        values = depth.values + value_cost(block)
        return None if values > DEEPEST_VALUE else depth._replace(values=values)
    loops, indent, values = depth
    if definition.shape == "c":
        more = 1 if "loop" in definition.flags or mouth_of(definition) else 0
        more += LOOPS_OF_GUARD if "guards" in definition.flags else 0
        loops = 0 if "apart" in definition.flags else loops + more
        indent, values = indent + 1, 0
    too_deep = loops > DEEPEST_LOOP or indent > DEEPEST_INDENT
    return None if too_deep else _Depth(loops, indent, values)
