"""Put a C block around blocks, or take one away from around them."""

from __future__ import annotations

from collections.abc import Iterable

from ..editor import Editor
from ..edits import DeleteBlocks, MoveBlocks
from ..errors import EditRefused
from ..places import InBody, InInput, InStack, place_of
from .landing import first_body
from .selection import Run, members, page_of_block, require_runs


def wrap(editor: Editor, ids: Iterable[str], block_type: str) -> str:
    """Put a new C block around selected blocks that follow each other; gives its id.

    A hat at the beginning stays outside. Raises EditRefused.
    """
    run = _without_hat(editor, _single(editor, ids))
    page = page_of_block(editor.project, run.first)
    with editor.transaction("put a block around"):
        stack = editor.project.stack_of(run.first)
        outer = editor.create(block_type, editor.new_stack(page, stack.x, stack.y))
        block = editor.project.blocks[outer]
        body = first_body(editor.language.definitions[block_type], block)
        if not body:
            raise EditRefused("This block has no place for blocks inside it.")
        place = place_of(editor.project, run.first, run.count)
        editor.apply(MoveBlocks(run.first, run.count, InBody(outer, body, 0)))
        editor.apply(MoveBlocks(outer, 1, place))
    return outer


def unwrap(editor: Editor, block_id: str) -> tuple[str, ...]:
    """Take a C block away; the blocks inside it take its place, those of all bodies in order.

    Gives the blocks that were inside. Raises EditRefused when they cannot stand there.
    """
    block = editor.project.blocks.get(block_id)
    definition = editor.language.definitions.get(block.type) if block is not None else None
    if block is None or definition is None or definition.shape != "c":
        raise EditRefused(
            "This block has no blocks inside it that could stay.",
            checklist=("Choose a block that holds others, such as “repeat”.",),
        )
    keys = [key for key, slot in definition.keys(block.groups) if slot.kind.name == "body"]
    chains = [list(block.bodies[key]) for key in keys if block.bodies.get(key)]
    inside = tuple(inner for chain in chains for inner in chain)
    place = place_of(editor.project, block_id, 1)
    with editor.transaction("take a block away from around others"):
        if chains:
            _set_aside_in_one_stack(editor, block_id, chains)
        editor.apply(DeleteBlocks(block_id, 1))
        if chains:
            editor.apply(MoveBlocks(inside[0], len(inside), place))
    return inside


def why_not_wrap(editor: Editor, ids: Iterable[str]) -> str | None:
    """Why no block can be put around selected blocks, or None when one can."""
    try:
        _without_hat(editor, _single(editor, ids))
    except EditRefused as refused:
        return refused.sentence
    return None


def _set_aside_in_one_stack(editor: Editor, block_id: str, chains: list[list[str]]) -> None:
    stack = editor.project.stack_of(block_id)
    aside = editor.new_stack(editor.project.page_of(stack.id), stack.x, stack.y)
    editor.apply(MoveBlocks(chains[0][0], len(chains[0]), aside))
    for chain in chains[1:]:
        end = len(editor.project.stacks[aside.stack].body)
        editor.apply(MoveBlocks(chain[0], len(chain), InStack(aside.stack, end)))


def _single(editor: Editor, ids: Iterable[str]) -> Run:
    chosen = require_runs(editor.project, ids)
    if len(chosen) > 1:
        raise EditRefused(
            "These blocks do not follow each other.",
            checklist=("Select blocks of one stack that are directly below each other.",),
        )
    if isinstance(place_of(editor.project, chosen[0].first, 1), InInput):
        raise EditRefused(
            "A block that gives a value cannot be inside another in this way.",
            checklist=("Choose the block that it is a part of.",),
        )
    return chosen[0]


def _without_hat(editor: Editor, run: Run) -> Run:
    blocks = editor.project.blocks
    definition = editor.language.definitions.get(blocks[run.first].type)
    if definition is None or definition.shape != "hat":
        return run
    if run.count == 1:
        raise EditRefused(
            "A “when” block begins a stack: no block goes around it.",
            checklist=("Choose the blocks below it.",),
        )
    return Run(members(editor.project, run)[1], run.count - 1)
