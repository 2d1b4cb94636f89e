"""Checks of what Python itself cannot take: loops in loops in loops, values in values."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ..definitions import Definition
from ..deployment import chains
from ..generate.expressions import DEEPEST_VALUE, value_cost
from ..generate.rules import DEEPEST_INDENT, DEEPEST_LOOP
from ..language import Language
from ..program import Block, Project
from .problem import Problem, page_of


class _Depth(NamedTuple):
    """How deep a block is: in loops of its function, in bodies, in values."""

    loops: int
    indent: int
    values: int


def check_limits(project: Project, language: Language) -> Iterator[Problem]:
    """The blocks that are nested too deep, the outermost of each chain of them."""
    for chain in chains(project, language):
        waiting = [(block_id, _Depth(0, 1, 0)) for block_id in reversed(chain)]
        while waiting:
            block_id, depth = waiting.pop()
            block = project.blocks[block_id]
            definition = language.definitions.get(block.type)
            if block.disabled or definition is None:
                continue
            inside = _inside(block, definition, depth)
            if not _is_too_deep(inside, definition):
                waiting += [(child, inside) for child in block.children()]
                continue
            yield Problem(
                "error",
                "too_deep",
                page_of(project, block_id),
                block_id,
                "Blocks are nested too deep here: "
                f"{DEEPEST_LOOP} loops, {DEEPEST_INDENT} blocks or {DEEPEST_VALUE} values at most.",
                ("Take the inner blocks out into a rule of their own, or into a variable.",),
            )


def _inside(block: Block, definition: Definition, depth: _Depth) -> _Depth:
    """How deep the blocks inside a block are."""
    if definition.is_value:
        return depth._replace(values=depth.values + value_cost(block))
    if definition.shape != "c":
        return depth
    loops = 0 if "apart" in definition.flags else depth.loops + ("loop" in definition.flags)
    return _Depth(loops, depth.indent + 1, 0)


def _is_too_deep(inside: _Depth, definition: Definition) -> bool:
    if definition.is_value:
        return inside.values > DEEPEST_VALUE
    return inside.loops > DEEPEST_LOOP or inside.indent > DEEPEST_INDENT
