"""The places where blocks can be put."""

from __future__ import annotations

import msgspec

from .procedures import CALL
from .program import Parent, Project, Stack


class NewStack(msgspec.Struct, tag_field="place", frozen=True, tag=True):
    """A new stack at (x, y) of a page; ``position`` is its place in the page's list."""

    page: str
    stack: str
    x: float
    y: float
    position: int


class InStack(msgspec.Struct, tag_field="place", frozen=True, tag=True):
    """In the chain of a stack; ``index`` counts without the blocks that are being moved."""

    stack: str
    index: int


class InBody(msgspec.Struct, tag_field="place", frozen=True, tag=True):
    """In a body of a block; ``index`` counts without the blocks that are being moved."""

    block: str
    slot: str
    index: int


class InInput(msgspec.Struct, tag_field="place", frozen=True, tag=True):
    """Plugged into an input of a block."""

    block: str
    slot: str


Place = NewStack | InStack | InBody | InInput


def place_of(project: Project, first: str, count: int) -> Place:
    """Where ``count`` blocks from ``first`` on are, said so that they can be put back there."""
    parent = project.parents[first]
    chain = project.chain_of(parent)
    if chain is None or first not in chain:
        return InInput(parent.owner, parent.slot)
    index = chain.index(first)
    if parent.slot:
        return InBody(parent.owner, parent.slot, index)
    if count < len(chain):
        return InStack(parent.owner, index)
    page = project.page_of(parent.owner)
    stack = project.stacks[parent.owner]
    return NewStack(page, stack.id, stack.x, stack.y, project.pages[page].index(stack))


def chain_at(project: Project, place: Place) -> list[str]:
    """The chain that a place is in, as it is now; empty when it is none yet."""
    if isinstance(place, InStack) and place.stack in project.stacks:
        return project.stacks[place.stack].body
    if isinstance(place, InBody) and place.block in project.blocks:
        return project.blocks[place.block].bodies.get(place.slot, [])
    return []


def put(project: Project, roots: list[str], place: Place) -> None:
    """Put blocks that are in no place now into one; edits.py has checked that it is free."""
    if isinstance(place, NewStack):
        stack = Stack(place.stack, float(place.x), float(place.y), list(roots))
        project.pages[place.page].insert(place.position, stack)
        project.stacks[stack.id] = stack
        project.id_seen(stack.id)
        parent = Parent(stack.id)
    elif isinstance(place, InStack):
        project.stacks[place.stack].body[place.index : place.index] = roots
        parent = Parent(place.stack)
    elif isinstance(place, InBody):
        chain = project.blocks[place.block].bodies.setdefault(place.slot, [])
        chain[place.index : place.index] = roots
        parent = Parent(place.block, place.slot)
    else:
        project.blocks[place.block].inputs[place.slot] = roots[0]
        parent = Parent(place.block, place.slot)
    for root in roots:
        project.parents[root] = parent
    project.touch(project.stack_of(roots[0]).id, parent.owner)


def take(project: Project, first: str, count: int) -> list[str]:
    """Take ``count`` blocks from ``first`` on out of their place; an emptied stack goes."""
    parent = project.parents[first]
    project.touch(project.stack_of(first).id, parent.owner)
    chain = project.chain_of(parent)
    if chain is None or first not in chain:
        del project.blocks[parent.owner].inputs[parent.slot]
        roots = [first]
    else:
        index = chain.index(first)
        roots = chain[index : index + count]
        del chain[index : index + count]
        if not chain:
            if parent.slot:
                del project.blocks[parent.owner].bodies[parent.slot]
            else:
                page = project.page_of(parent.owner)
                project.pages[page].remove(project.stacks.pop(parent.owner))
    for root in roots:
        del project.parents[root]
    return roots


# Where a variable or an own block is used.

VARIABLE_SLOT = "variable"
"""The name of every slot that names a variable."""


def variable_uses(project: Project, variable_id: str) -> list[str]:
    """The blocks that name a variable, in the order of their making."""
    return [b.id for b in project.blocks.values() if b.fields.get(VARIABLE_SLOT) == variable_id]


def procedure_uses(project: Project, procedure_id: str) -> list[str]:
    """The blocks that call an own block, in the order of their making."""
    call = CALL + procedure_id
    return [block.id for block in project.blocks.values() if block.type == call]
