"""Checks of how a program runs: loops without a pause, blocks never reached, walking unready."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from ..definitions import Definition
from ..deployment import chains
from ..language import Language
from ..program import ALL_ROBOTS, Block, Project
from ..text import sentence
from .problem import Fix, Problem, page_of

_POSTURES = {"stands_up": "posture_stand", "rests": "posture_rest"}
"""The postures after blocks with such a flag."""


def check_flow(project: Project, language: Language) -> Iterator[Problem]:
    """Problems of the order in which blocks run, in rules."""
    for chain in chains(project, language):
        blocks = list(project.within(chain, enabled=True))
        yield from _loops_without_pause(project, language, blocks)
        yield from _never_reached(project, language, chain, blocks)
        yield from _walking_unready(project, language, blocks)


def _loops_without_pause(
    project: Project, language: Language, blocks: list[Block]
) -> Iterator[Problem]:
    """Loops in whose bodies nothing takes time; children come after their parents in ``blocks``."""
    pauses: set[str] = set()
    for block in reversed(blocks):
        flags = _flags(language, block)
        takes_time = "takes_time" in flags or _ends(language, block)
        if takes_time or not pauses.isdisjoint(block.children()):
            pauses.add(block.id)
        elif "needs_pause" in flags:
            yield Problem(
                "warning",
                "no_pause",
                page_of(project, block.id),
                block.id,
                f"“{sentence(project, language, block.id)}” never pauses: "
                "the computer would do nothing else.",
                ("Put a “wait” block inside.", "Or let the robot do something inside."),
                Fix("add_wait", "Add a pause", {"block": block.id, "slot": "do"}),
            )


def _ends(language: Language, block: Block) -> bool:
    definition = language.definitions.get(block.type)
    if definition is None:
        return True
    return definition.shape == "cap" and definition.generator != "next_round"


def _never_reached(
    project: Project, language: Language, chain: list[str], blocks: list[Block]
) -> Iterator[Problem]:
    for chain_in in [chain, *(c for block in blocks for c in block.bodies.values())]:
        enabled = [project.blocks[i] for i in chain_in if not project.blocks[i].disabled]
        for upper, lower in pairwise(enabled):
            definition = language.definitions.get(upper.type)
            if definition is not None and definition.is_last:
                yield Problem(
                    "warning",
                    "never_reached",
                    page_of(project, lower.id),
                    lower.id,
                    f"“{sentence(project, language, lower.id)}” is never reached: it comes after "
                    f"“{sentence(project, language, upper.id)}”.",
                    ("Move it above, or take it out.",),
                )


def _walking_unready(
    project: Project, language: Language, blocks: list[Block]
) -> Iterator[Problem]:
    """Blocks that need a standing robot after one that made it sit; bodies count in their order."""
    postures: dict[str, str] = {}
    for block in blocks:
        flags = _flags(language, block)
        if not flags & {"posture", "stands", *_POSTURES}:
            continue
        definition = language.definitions[block.type]
        robot = str(definition.value(block, "robot"))
        if taken := _posture_taken(definition, block):
            if robot == ALL_ROBOTS:
                postures.clear()
            postures[robot] = taken
            continue
        posture = postures.get(robot, postures.get(ALL_ROBOTS))
        if posture is not None and posture not in language.profile.standing:
            label = language.choices.get("postures", {}).get(posture, posture)
            name = "A robot" if robot == ALL_ROBOTS else robot
            yield Problem(
                "warning",
                "not_standing",
                page_of(project, block.id),
                block.id,
                f"{name} cannot walk after the posture “{label}”.",
                ("Let the robot stand first.",),
                Fix("stand_first", "Stand first", {"block": block.id, "robot": robot}),
            )


def _posture_taken(definition: Definition, block: Block) -> str:
    """The posture that a block leaves a robot in, "" when it leaves it as it is."""
    if "posture" in definition.flags:
        return str(definition.value(block, "posture"))
    return next((_POSTURES[flag] for flag in definition.flags if flag in _POSTURES), "")


def _flags(language: Language, block: Block) -> frozenset[str]:
    definition = language.definitions.get(block.type)
    return definition.flags if definition is not None else frozenset()
