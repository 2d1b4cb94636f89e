"""A selection of blocks as runs: the blocks of it that follow each other, in page order."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass

from ..errors import EditRefused
from ..places import InInput, Place, place_of
from ..program import Project


@dataclass(frozen=True, slots=True)
class Run:
    """``count`` blocks of one chain, from ``first`` on; a plugged block is a run of its own."""

    first: str
    count: int


def runs(project: Project, ids: Iterable[str]) -> tuple[Run, ...]:
    """The longest runs of selected blocks, in page order.

    Blocks inside other selected blocks go with those; ids that are not there are left out.
    """
    selected = {block for block in ids if block in project.blocks}
    outer = {block for block in selected if not is_inside(project, block, selected)}
    found = {run.first: run for run in _in_chains(project, outer)}
    order = in_page_order(project, found) if len(found) > 1 else found
    return tuple(found[start] for start in order)


def require_runs(project: Project, ids: Iterable[str]) -> tuple[Run, ...]:
    """The runs of a selection; EditRefused when there is nothing in it."""
    chosen = runs(project, ids)
    if not chosen:
        raise EditRefused("No blocks are selected.", checklist=("Select a block first.",))
    return chosen


def run_from(project: Project, block: str) -> Run:
    """A block with all that are below it in its chain."""
    chain = chain_around(project, block)
    return Run(block, len(chain) - chain.index(block))


def members(project: Project, run: Run) -> list[str]:
    """The ids of the blocks of a run, without those inside them."""
    chain = chain_around(project, run.first)
    index = chain.index(run.first)
    return chain[index : index + run.count]


def chain_around(project: Project, block: str) -> list[str]:
    """The chain that a block is in (not a copy), or itself alone when it is plugged in."""
    if isinstance(place_of(project, block, 1), InInput):
        return [block]
    return project.chain_of(project.parents[block]) or [block]


def is_inside(project: Project, block: str, others: Collection[str]) -> bool:
    """Whether a block is inside one of the others, however deep."""
    owner = project.parents[block].owner
    while owner in project.blocks:
        if owner in others:
            return True
        owner = project.parents[owner].owner
    return False


def in_page_order(project: Project, ids: Collection[str]) -> list[str]:
    """Blocks as they come on the pages: page by page, stack by stack, from top to bottom."""
    wanted = set(ids)
    touched = {project.stack_of(block).id for block in wanted}
    return [
        block.id
        for stacks in project.pages.values()
        for stack in stacks
        if stack.id in touched
        for block in project.within(stack.body)
        if block.id in wanted
    ]


def is_within_run(project: Project, place: Place, run: Run) -> bool:
    """Whether a place is inside the blocks of a run."""
    owner = getattr(place, "block", "")
    if owner not in project.blocks:
        return False
    moved = members(project, run)
    return owner in moved or is_inside(project, owner, moved)


def _in_chains(project: Project, selected: Collection[str]) -> Iterator[Run]:
    """The runs of selected blocks, chain by chain: each chain is walked once."""
    plugged = set[str]()
    for block in selected:
        owner, slot = project.parents[block]
        if owner in project.blocks and project.blocks[owner].inputs.get(slot) == block:
            plugged.add(block)
    yield from (Run(block, 1) for block in plugged)
    for parent in {project.parents[block] for block in selected if block not in plugged}:
        first, count = "", 0
        for block in project.chain_of(parent) or ():
            if block in selected:
                first, count = first or block, count + 1
            elif count:
                yield Run(first, count)
                first, count = "", 0
        if count:
            yield Run(first, count)
