"""Which block is next to another one, as a person reads: down, up, in and out.

``stacks`` are the ids of the page's stacks in the order in which they are read.
"""

from __future__ import annotations

from collections.abc import Sequence

from nep_studio.blocks.program import Block, Project


def below(project: Project, stacks: Sequence[str], block_id: str) -> str:
    """The next statement: the first inside, else the next one; the same block at the end."""
    block = project.blocks[statement_of(project, block_id)]
    inside = [chain for chain in block.bodies.values() if chain]
    if inside and not block.collapsed:
        return inside[0][0]
    current = block.id
    while current in project.blocks:
        parent = project.parents[current]
        chain = project.chain_of(parent) or []
        index = chain.index(current)
        if index + 1 < len(chain):
            return chain[index + 1]
        if parent.owner not in project.blocks:
            return next_stack(project, stacks, block_id)
        later = _later_body(project.blocks[parent.owner], parent.slot)
        if later:
            return later
        current = parent.owner
    return block_id


def above(project: Project, stacks: Sequence[str], block_id: str) -> str:
    """The statement before: the last inside the one above, else what this one is inside of."""
    current = statement_of(project, block_id)
    if current != block_id:
        return current
    parent = project.parents[current]
    chain = project.chain_of(parent) or []
    index = chain.index(current)
    if index > 0:
        return _deepest(project, chain[index - 1])
    if parent.owner in project.blocks:
        earlier = _earlier_body(project.blocks[parent.owner], parent.slot)
        return _deepest(project, earlier) if earlier else parent.owner
    before = _beside(stacks, parent.owner, -1)
    return _deepest(project, project.stacks[before].body[-1]) if before else block_id


def inward(project: Project, block_id: str) -> str:
    """The first block inside, what is plugged in before what is in a body; else the same."""
    block = project.blocks[block_id]
    if block.collapsed:
        return block_id
    children = list(block.children())
    if children:
        return children[0]
    return _next_input(project, block_id) or block_id


def outward(project: Project, block_id: str) -> str:
    """The block around; a block of a stack has none, and stays."""
    owner = project.parents[block_id].owner
    return owner if owner in project.blocks else block_id


def statement_of(project: Project, block_id: str) -> str:
    """The statement that a plugged block is in, however deep; a statement is its own."""
    while True:
        parent = project.parents[block_id]
        chain = project.chain_of(parent)
        if chain is not None and block_id in chain:
            return block_id
        block_id = parent.owner


def next_stack(project: Project, stacks: Sequence[str], block_id: str) -> str:
    """The first block of the stack after the one of this block; the same at the end."""
    after = _beside(stacks, project.stack_of(block_id).id, 1)
    return project.stacks[after].body[0] if after else block_id


def previous_stack(project: Project, stacks: Sequence[str], block_id: str) -> str:
    """The first block of this block's stack, or of the one before when it is that already."""
    stack = project.stack_of(block_id)
    if stack.body[0] != block_id:
        return stack.body[0]
    before = _beside(stacks, stack.id, -1)
    return project.stacks[before].body[0] if before else block_id


def between(project: Project, stacks: Sequence[str], one: str, other: str) -> list[str]:
    """The statements from one to another in the order of reading, for a selection with Shift."""
    order: dict[str, int] = {}
    for stack in stacks:
        for block in project.within(project.stacks[stack].body):
            order[block.id] = len(order)
    first, last = sorted((order[one], order[other]))
    return [
        block
        for block, number in order.items()
        if first <= number <= last and statement_of(project, block) == block
    ]


def _later_body(owner: Block, slot: str) -> str:
    slots = list(owner.bodies)
    later = slots[slots.index(slot) + 1 :] if slot in slots else []
    return next((owner.bodies[key][0] for key in later if owner.bodies[key]), "")


def _earlier_body(owner: Block, slot: str) -> str:
    slots = list(owner.bodies)
    earlier = slots[: slots.index(slot)] if slot in slots else []
    return next((owner.bodies[key][-1] for key in reversed(earlier) if owner.bodies[key]), "")


def _deepest(project: Project, block_id: str) -> str:
    """The last statement inside a block, or the block itself."""
    while True:
        block = project.blocks[block_id]
        chains = [chain for chain in block.bodies.values() if chain]
        if block.collapsed or not chains:
            return block_id
        block_id = chains[-1][-1]


def _next_input(project: Project, block_id: str) -> str:
    """What is plugged in after this block, in the same owner."""
    owner = project.blocks.get(project.parents[block_id].owner)
    plugged = list(owner.inputs.values()) if owner is not None else []
    if block_id not in plugged:
        return ""
    return next(iter(plugged[plugged.index(block_id) + 1 :]), "")


def _beside(stacks: Sequence[str], stack: str, step: int) -> str:
    index = stacks.index(stack) + step if stack in stacks else -1
    return stacks[index] if 0 <= index < len(stacks) else ""
