"""Checks of what a block must be inside of: a loop, the definition of an own block, good Python."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ..code_text import CodeTextRefused, read_lines, read_value
from ..definitions import Definition
from ..deployment import chains
from ..language import Language
from ..procedures import DEFINE, PARAMETER, RETURN, procedure_of
from ..program import Block, Project
from ..text import sentence
from .problem import Problem, page_of

CODE_LINES, CODE_VALUE, STOP_RULE = "code.lines", "code.value", "control.stop_rule"


class _Place(NamedTuple):
    """What a block is inside of: an own block, a loop, a part that runs beside others."""

    procedure: str
    loop: bool = False
    apart: bool = False


def check_inside(project: Project, language: Language) -> Iterator[Problem]:
    """Blocks that mean nothing where they are."""
    for chain in chains(project, language):
        hat = project.blocks[chain[0]]
        start = _Place(procedure_of(hat.type) if hat.type.startswith(DEFINE) else "")
        waiting = [(block_id, start) for block_id in reversed(chain)]
        while waiting:
            block_id, place = waiting.pop()
            block = project.blocks[block_id]
            definition = language.definitions.get(block.type)
            if block.disabled or definition is None:
                continue
            yield from _misplaced(project, language, block, definition, place)
            if block.inputs or block.bodies:
                inner = _inner(definition, place)
                waiting += [(child, inner) for child in block.children()]


def _inner(definition: Definition, place: _Place) -> _Place:
    if "apart" in definition.flags:
        return _Place(place.procedure, loop=False, apart=True)
    return place._replace(loop=True) if "loop" in definition.flags else place


def _misplaced(
    project: Project, language: Language, block: Block, definition: Definition, place: _Place
) -> Iterator[Problem]:
    told = _told(block, definition, place)
    if told is None:
        return
    severity, kind, reason, remedy = told
    yield Problem(
        "info" if severity == "info" else "error",
        kind,
        page_of(project, block.id),
        block.id,
        f"“{sentence(project, language, block.id)}”: {reason}",
        (remedy,),
    )


def _told(block: Block, definition: Definition, place: _Place) -> tuple[str, ...] | None:
    """How bad it is, the kind, the sentence and the remedy of what is wrong, or None."""
    if "in_loop" in definition.flags and not place.loop:
        return ("error", "outside_loop", "it is in no loop.", "Put it into a “repeat” block.")
    if block.type == STOP_RULE and place.apart:
        reason = "only the part in which it is stops, not the whole rule."
        return ("info", "stops_part", reason, "Is that meant? Then leave it as it is.")
    if block.type == RETURN and (not place.procedure or place.apart):
        reason = "only the definition of an own block gives a value back."
        remedy = "Put it under a “define” block, and not into “do together”."
        return ("error", "outside_own_block", reason, remedy)
    if block.type.startswith(PARAMETER) and procedure_of(block.type) != place.procedure:
        reason = "this value is known only inside the definition of its own block."
        remedy = "Move it under the “define” block that it comes from."
        return ("error", "parameter_outside", reason, remedy)
    if block.type in (CODE_LINES, CODE_VALUE):
        return _wrong_python(block, definition, place)
    return None


def _wrong_python(block: Block, definition: Definition, place: _Place) -> tuple[str, ...] | None:
    text = str(definition.value(block, "code"))
    try:
        if block.type == CODE_VALUE:
            read_value(text)
        else:
            read_lines(text, in_loop=place.loop)
    except CodeTextRefused as refused:
        return ("error", "wrong_python", str(refused), "Change the code.")
    return None
