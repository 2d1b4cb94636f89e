"""Put a C block that is there already around a run of blocks: exactly these go into its mouth."""

from __future__ import annotations

from ..connections import why_not_below
from ..editor import Editor
from ..edits import MoveBlocks
from ..errors import EditRefused
from ..places import InBody, NewStack, place_of
from .landing import first_body
from .selection import Run, chain_around, members, page_of_block


def without_hat(editor: Editor, run: Run) -> Run | None:
    """The run without a hat at its beginning; None when nothing else is in it."""
    definition = editor.language.definitions.get(editor.project.blocks[run.first].type)
    if definition is None or definition.shape != "hat":
        return run
    return Run(members(editor.project, run)[1], run.count - 1) if run.count > 1 else None


def why_not_enclose(editor: Editor, block_type: str, run: Run) -> str | None:
    """Why a C block of a type cannot go around a run of blocks, or None when it can."""
    chain = chain_around(editor.project, run.first)
    end = chain.index(run.first) + run.count
    if end > len(chain):
        return "These blocks do not follow each other any more."
    return why_not_below(editor.language.definitions.get(block_type)) if end < len(chain) else None


def enclose(editor: Editor, block: str, run: Run) -> None:
    """Put a C block, which comes out of its place alone, around a run; raises EditRefused."""
    project = editor.project
    body = first_body(
        editor.language.definitions[project.blocks[block].type], project.blocks[block]
    )
    if not body or project.blocks[block].bodies.get(body):
        raise EditRefused(
            "This block has no free place for blocks inside it.",
            checklist=("Take out what is inside it, or take another block.",),
        )
    with editor.transaction("put a block around"):
        if not isinstance(place_of(project, block, 1), NewStack):
            stack, page = project.stack_of(run.first), page_of_block(project, run.first)
            editor.apply(MoveBlocks(block, 1, editor.new_stack(page, stack.x, stack.y)))
        place = place_of(project, run.first, run.count)
        editor.apply(MoveBlocks(run.first, run.count, InBody(block, body, 0)))
        editor.apply(MoveBlocks(block, 1, place))
