"""Put the blocks of a clip into a project, with ids of their own there."""

from __future__ import annotations

from collections.abc import Iterable

from ..editor import Editor
from ..edits import CreateBlocks
from ..errors import EditRefused
from ..places import Place
from ..procedures import DEFINE, header_of
from .animations import bring_animations
from .copying import STEP, UNKNOWN, Clip, Points, copy
from .naming import Names, names_for, renewed
from .selection import page_of_block, require_runs


def paste(editor: Editor, clip: Clip, page: str, x: float, y: float) -> tuple[str, ...]:
    """Put the blocks of a clip on a page, its corner at (x, y); gives the first of each stack.

    Variables and own blocks are found by their names, or made. Raises EditRefused, for blocks of
    another page too.
    """
    _require_blocks(clip)
    left, top = clip.corner
    with editor.transaction("paste blocks"):
        names = names_for(editor, clip)
        bring_animations(editor, clip.project)
        new = tuple(
            _put(
                editor,
                clip,
                stack.body,
                names,
                editor.new_stack(page, x + stack.x - left, y + stack.y - top),
            )[0]
            for stack in clip.stacks
        )
        _add_headers(editor, names, page, x + STEP, y)
    return new


def paste_at(editor: Editor, clip: Clip, place: Place) -> tuple[str, ...]:
    """Put the blocks of a clip of one stack into a place; gives the new blocks of the chain."""
    _require_blocks(clip)
    if len(clip.stacks) > 1:
        raise EditRefused(
            "These are several stacks: they can be pasted onto a page only.",
            checklist=("Click an empty place of the page, and paste there.",),
        )
    with editor.transaction("paste blocks"):
        bring_animations(editor, clip.project)
        return _put(editor, clip, clip.roots[0], names_for(editor, clip), place)


def duplicate(editor: Editor, ids: Iterable[str], at: Points = UNKNOWN) -> tuple[str, ...]:
    """Copy blocks and put the copies beside them as stacks; gives the first of each.

    ``at`` says where blocks lie that do not begin a stack.
    """
    project, ids = editor.project, list(ids)
    page = page_of_block(project, require_runs(project, ids)[0].first)
    clip = copy(project, editor.language, ids, at)
    left, top = clip.corner
    with editor.transaction("duplicate blocks"):
        return paste(editor, clip, page, left + STEP, top + STEP)


def _put(
    editor: Editor, clip: Clip, chain: Iterable[str], names: Names, place: Place
) -> tuple[str, ...]:
    """Create a chain of a clip with ids that are new to the project; gives them."""
    chain = list(chain)
    old = list(clip.project.within(chain))
    ids = {block.id: editor.project.new_id("b") for block in old}
    blocks = tuple(renewed(editor.language, block, ids, names) for block in old)
    roots = tuple(ids[root] for root in chain)
    editor.apply(CreateBlocks(roots, blocks, place))
    return roots


def _add_headers(editor: Editor, names: Names, page: str, x: float, y: float) -> None:
    """Give an own block that was made for a pasted call an empty header, to be filled."""
    for procedure in names.made:
        if not header_of(editor.project, procedure):
            editor.create(DEFINE + procedure, editor.new_stack(page, x + 12 * STEP, y))
            y += 4 * STEP


def _require_blocks(clip: Clip) -> None:
    if not clip.stacks:
        raise EditRefused("There is nothing to paste.", checklist=("Copy some blocks first.",))
