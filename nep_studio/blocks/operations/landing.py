"""Whether blocks can land in a place, and which blocks they would push away there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..connections import why_not_below, why_not_chained
from ..definitions import Definition
from ..editor import Editor
from ..edits import CreateBlocks, Edit, MoveBlocks
from ..places import InBody, InInput, InStack, NewStack, Place
from ..program import Block, Project
from .copying import Clip
from .selection import Run, is_within_run, members, page_of_block


@dataclass(frozen=True, slots=True)
class Load:
    """Blocks that are about to land: their chain, and the edit that puts them into a place."""

    chain: Sequence[Block]
    edit: Callable[[Place], Edit]
    run: Run | None = None

    @property
    def ids(self) -> frozenset[str]:
        """The blocks that leave their place; none when they are new."""
        return frozenset(block.id for block in self.chain) if self.run else frozenset()


def load_of_run(project: Project, run: Run) -> Load:
    """The load that blocks of the project are."""
    chain = [project.blocks[block] for block in members(project, run)]
    return Load(chain, lambda place: MoveBlocks(run.first, run.count, place), run)


def load_of_clip(clip: Clip) -> Load:
    """The load that the blocks of a clip of one stack are."""
    roots = clip.roots[0]
    blocks = tuple(clip.project.within(roots))
    chain = [clip.project.blocks[root] for root in roots]
    return Load(chain, lambda place: CreateBlocks(roots, blocks, place))


def why_not_land(editor: Editor, load: Load, place: Place, *, wrap: bool) -> str | None:
    """Why blocks cannot land in a place, or None when they can."""
    if load.run is not None and is_within_run(editor.project, place, load.run):
        return "A block cannot be put inside itself."
    if isinstance(place, InInput) and len(load.chain) > 1:
        return "Only one block goes into a slot."
    below = blocks_below(editor.project, load, place)
    if below and (mouth(editor, load, wrap=wrap) or is_cut(editor, load, place)):
        return _why_not_cut(editor, load, place, below, wrap=wrap)
    return editor.why_not(load.edit(place))


def is_cut(editor: Editor, load: Load, place: Place) -> bool:
    """Whether the blocks below a place have to leave, as nothing goes below the last new block."""
    last = editor.language.definitions.get(load.chain[-1].type)
    return bool(blocks_below(editor.project, load, place)) and (
        last is not None and not last.is_value and last.is_last
    )


def mouth(editor: Editor, load: Load, *, wrap: bool) -> str:
    """The body that would take in the blocks below, or an empty text: of one C block, and empty."""
    definition = editor.language.definitions.get(load.chain[0].type)
    if not wrap or len(load.chain) > 1 or definition is None:
        return ""
    key = first_body(definition, load.chain[0])
    return "" if load.chain[0].bodies.get(key) else key


def first_body(definition: Definition, block: Block) -> str:
    """The first body of a block, or an empty text when it has none."""
    bodies = (key for key, slot in definition.keys(block.groups) if slot.kind.name == "body")
    return next(bodies, "")


def blocks_below(project: Project, load: Load, place: Place) -> list[str]:
    """The blocks that would be below the new ones in their chain."""
    moved = load.ids
    left = [block for block in chain_at(project, place) if block not in moved]
    return left[place.index :] if isinstance(place, InStack | InBody) else []


def chain_at(project: Project, place: Place) -> list[str]:
    """The chain that a place is in, as it is now; empty when it is none yet."""
    if isinstance(place, InStack) and place.stack in project.stacks:
        return project.stacks[place.stack].body
    if isinstance(place, InBody) and place.block in project.blocks:
        return project.blocks[place.block].bodies.get(place.slot, [])
    return []


def page_at(project: Project, place: Place) -> str:
    """The page of a place."""
    if isinstance(place, NewStack):
        return place.page
    if isinstance(place, InStack):
        return project.page_of(place.stack)
    return page_of_block(project, place.block)


def _why_not_cut(
    editor: Editor, load: Load, place: Place, below: list[str], *, wrap: bool
) -> str | None:
    """The same question when the blocks below go away, or into the mouth of the new block."""
    project, definitions = editor.project, editor.language.definitions
    moved = load.ids
    left = [block for block in chain_at(project, place) if block not in moved]
    over = project.blocks[left[-len(below) - 1]] if len(below) < len(left) else None
    first = definitions.get(load.chain[0].type)
    is_top = over is None and isinstance(place, InStack)
    reason = editor.why_not(load.edit(editor.new_stack(page_at(project, place), 0, 0)))
    reason = reason or why_not_chained(first, first_in_stack=is_top)
    if reason is None and over is not None:
        reason = why_not_below(definitions.get(over.type))
    if reason is None and mouth(editor, load, wrap=wrap):
        top = definitions.get(project.blocks[below[0]].type)
        reason = why_not_chained(top, first_in_stack=False)
    return reason
