"""What the buttons inside blocks do: add and remove parts, unfold."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.blocks.operations.flags import set_collapsed
from nep_studio.blocks.operations.reordering import add_part, move_part, remove_part
from nep_studio.blocks.program import split_slot
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from ..canvas import Canvas

_BESIDE = 40.0
"""How far to the side of its block a part's blocks are put when the part goes."""


def add(canvas: Canvas, block: str, group: str) -> str:
    """Add a part at the end; gives the key of its first field, where there is one."""
    made: list[int] = []
    if not canvas.attempt(lambda: made.append(add_part(canvas.editor, block, group))):
        return ""
    canvas.announced.emit(tr("Added"))
    definition = canvas.editor.language.definitions[canvas.editor.project.blocks[block].type]
    keys = (
        f"{name}.{made[0]}"
        for name in definition.group_slots(group)
        if definition.slots[name].kind.typed
    )
    return next(keys, "")


def remove(canvas: Canvas, block: str, group: str, number: int) -> None:
    """Remove a part; blocks in it are put beside the block."""
    placed = canvas.page_layout.placed(block)
    side = _BESIDE * (-1 if canvas.measures.is_mirrored else 1)
    beside = None
    if placed is not None:
        edge = placed.x if canvas.measures.is_mirrored else placed.x + placed.box.width
        beside = (edge + side, placed.y)
    if canvas.attempt(lambda: remove_part(canvas.editor, block, group, number, beside)):
        canvas.announced.emit(tr("Removed"))


def expand(canvas: Canvas, block: str) -> None:
    """Show a collapsed block again."""
    canvas.attempt(lambda: set_collapsed(canvas.editor, [block], False))


def move_item(canvas: Canvas, block: str, key: str, *, down: bool) -> str:
    """Move the part that a slot is in; gives the slot's key in its new place, or nothing."""
    name, number = split_slot(key)
    there = canvas.editor.project.blocks[block]
    definition = canvas.editor.language.definitions[there.type]
    group = definition.slots[name].group
    to = number + (1 if down else -1)
    if not group or not 1 <= to <= there.groups.get(group, 0):
        return ""
    if not canvas.attempt(lambda: move_part(canvas.editor, block, group, number, to)):
        return ""
    canvas.announced.emit(tr("Moved to place {n}", n=to))
    return f"{name}.{to}"
