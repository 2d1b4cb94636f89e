"""Edits that put blocks into places: create, delete, move."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from ..errors import EditRefused
from ..places import InBody, InInput, InStack, NewStack, Place, place_of, put, take
from ..program import Block, Parent, Project
from .edit import Edit


class CreateBlocks(Edit, frozen=True):
    """Make blocks, those inside others too; ``roots`` are the ones that go into the place."""

    label: ClassVar[str] = "add blocks"
    roots: tuple[str, ...]
    blocks: tuple[Block, ...]
    place: Place

    def apply(self, project: Project) -> DeleteBlocks:
        """Make the blocks."""
        if any(block.id in project.blocks or block.id in project.stacks for block in self.blocks):
            raise EditRefused("A block with this id is already there.")
        _require_whole(self)
        _require_free(project, self.place, self.roots)
        for block in self.blocks:
            project.blocks[block.id] = block.copy()
            project.id_seen(block.id)
            _adopt(project, block)
        put(project, list(self.roots), self.place)
        return DeleteBlocks(self.roots[0], len(self.roots))


class DeleteBlocks(Edit, frozen=True):
    """Delete ``count`` blocks of a chain from ``first`` on, with all that is inside them."""

    label: ClassVar[str] = "delete blocks"
    first: str
    count: int = 1

    def apply(self, project: Project) -> CreateBlocks:
        """Delete the blocks."""
        _require_run(project, self.first, self.count)
        place = place_of(project, self.first, self.count)
        roots = take(project, self.first, self.count)
        blocks = tuple(project.within(roots))
        for block in blocks:
            del project.blocks[block.id]
            for child in block.children():
                del project.parents[child]
        return CreateBlocks(tuple(roots), blocks, place)


class MoveBlocks(Edit, frozen=True):
    """Move ``count`` blocks of a chain from ``first`` on, with all that is inside them."""

    label: ClassVar[str] = "move blocks"
    first: str
    count: int
    place: Place

    def apply(self, project: Project) -> MoveBlocks:
        """Move the blocks."""
        roots = _require_run(project, self.first, self.count)
        old = place_of(project, self.first, self.count)
        # A place must not be inside the blocks that are moved there
        place = self.place
        owner = place.stack if isinstance(place, NewStack | InStack) else place.block
        moved = set(roots)
        while owner in project.blocks:
            if owner in moved:
                raise EditRefused("A block cannot be put inside itself.")
            owner = project.parents[owner].owner
        stack = project.stacks.get(place.stack) if isinstance(place, InStack) else None
        if stack is not None and stack.body == roots:
            raise EditRefused("These blocks are a stack already.")
        _require_free(project, self.place, roots, moved=True)
        take(project, self.first, self.count)
        put(project, roots, self.place)
        return MoveBlocks(self.first, self.count, old)


def require_block(project: Project, block_id: str) -> Block:
    """The block with this id, or EditRefused."""
    block = project.blocks.get(block_id)
    if block is None:
        raise EditRefused("This block is not there any more.")
    return block


def _require_run(project: Project, first: str, count: int) -> list[str]:
    """The ids of ``count`` blocks that follow each other, from ``first`` on."""
    require_block(project, first)
    chain = project.chain_of(project.parents[first])
    if chain is None or first not in chain:
        chain = [first]
    index = chain.index(first)
    if not 1 <= count <= len(chain) - index:
        raise EditRefused("There are not so many blocks below this one.")
    return chain[index : index + count]


def _require_whole(edit: CreateBlocks) -> None:
    """The blocks must be the roots and all that is inside them, each once."""
    inside = [child for block in edit.blocks for child in block.children()]
    ids = [block.id for block in edit.blocks]
    if not edit.roots or sorted([*inside, *edit.roots]) != sorted(ids) or len(set(ids)) < len(ids):
        raise EditRefused("These blocks are not complete.")


def _require_free(
    project: Project, place: Place, roots: Sequence[str], *, moved: bool = False
) -> None:
    """A place must be there, and free, once the moved blocks have left theirs."""
    leaving = roots if moved else ()
    if isinstance(place, InInput):
        plugged = require_block(project, place.block).inputs.get(place.slot)
        if len(roots) != 1 or plugged not in (None, *leaving):
            raise EditRefused("There is a block in this slot already.")
        return
    if isinstance(place, NewStack):
        taken = place.stack in project.stacks or place.stack in project.blocks
        if place.page not in project.pages or taken:
            raise EditRefused("A stack cannot be made here.")
        # a stack that is moved as a whole leaves the list of its page
        stack = project.stacks.get(project.parents[leaving[0]].owner) if leaving else None
        leaves = stack is not None and len(stack.body) == len(leaving)
        there = project.pages[place.page]
        index, length = place.position, len(there) - (leaves and stack in there)
    else:
        if isinstance(place, InBody):
            chain = require_block(project, place.block).bodies.get(place.slot, [])
        elif place.stack in project.stacks:
            chain = project.stacks[place.stack].body
        else:
            raise EditRefused("This stack is not there any more.")
        left = len(leaving) if leaving and leaving[0] in chain else 0
        index, length = place.index, len(chain) - left
    if not 0 <= index <= length:
        raise EditRefused("There is no such place.")


def _adopt(project: Project, block: Block) -> None:
    """Note for the blocks directly inside a new block that it is their parent."""
    for slot, plugged in block.inputs.items():
        project.parents[plugged] = Parent(block.id, slot)
    for slot, chain in block.bodies.items():
        for child in chain:
            project.parents[child] = Parent(block.id, slot)
