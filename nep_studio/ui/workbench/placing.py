"""Where new blocks go that were not carried there: after the cursor, or where one looks."""

from __future__ import annotations

from collections.abc import Iterator

from PySide6.QtCore import QPointF

from nep_studio.blocks.operations.copying import Clip, paste
from nep_studio.blocks.operations.moving import create_and_drop, why_not_create
from nep_studio.blocks.places import InBody, InInput, InStack, Place
from nep_studio.blocks.program import Project
from nep_studio.blocks.text import sentence
from nep_studio.ui.canvas.host import CanvasHost
from nep_studio.ui.canvas.layout.layout import Layout
from nep_studio.ui.words import tr

STEP = 32.0
"""How far loose blocks move to find a free place, in canvas units."""

BESIDE = 30.0


def insert_clip(
    canvas: CanvasHost, clip: Clip, *, at: QPointF | None = None, place: Place | None = None
) -> str:
    """Put new blocks into a program as one step, and select them; gives the first, or nothing.

    They go into ``place`` if one is named, loose to ``at`` if that is, else after the block at the
    cursor (a value into its first empty slot), else loose to the middle of the view.
    """
    made: list[str] = []
    if not canvas.attempt(lambda: made.extend(_insert(canvas, clip, at, place))) or not made:
        return ""
    canvas.selection.set([made[0]])
    canvas.show_block(made[0])
    project, language = canvas.editor.project, canvas.editor.language
    canvas.news.announced.emit(tr("added: {block}", block=sentence(project, language, made[0])))
    return made[0]


def place_after_cursor(canvas: CanvasHost, clip: Clip) -> Place | None:
    """The place after the cursor's block, or in it, that takes the blocks; None when none does."""
    editor = canvas.editor
    if canvas.selection.cursor not in editor.project.blocks:
        return None
    for place in _places(canvas, clip, canvas.selection.cursor):
        if why_not_create(editor, clip, place) is None:
            return place
    return None


def _insert(
    canvas: CanvasHost, clip: Clip, at: QPointF | None, place: Place | None
) -> tuple[str, ...]:
    editor = canvas.editor
    if place is None and at is None:
        place = place_after_cursor(canvas, clip)
    if place is None:
        where = at or free_place(canvas, clip)
        return paste(editor, clip, canvas.page_layout.page, where.x(), where.y())
    return create_and_drop(editor, clip, place, beside=_beside(canvas))


def _places(canvas: CanvasHost, clip: Clip, cursor: str) -> Iterator[Place]:
    """The places to try, the best first: the slots of the block, then below it and its owners."""
    editor = canvas.editor
    project = editor.project
    language = editor.language.of(clip.project)  # it may bring own blocks of a library
    first = language.definitions.get(clip.project.blocks[clip.roots[0][0]].type)
    if first is None or first.is_value:
        yield from _slots(canvas, cursor)
        return
    block = cursor
    while block in project.blocks:
        yield from _below(project, block)
        block = project.parents[block].owner


def _slots(canvas: CanvasHost, block_id: str) -> Iterator[Place]:
    """The empty slots of a block; those that can only hold a block come first."""
    block = canvas.editor.project.blocks[block_id]
    definition = canvas.editor.language.definitions.get(block.type)
    if definition is None:
        return
    free = [
        (slot.kind.typed, key)
        for key, slot in definition.keys(block.groups)
        if slot.pluggable and key not in block.inputs
    ]
    for _is_typed, key in sorted(free, key=lambda pair: pair[0]):
        yield InInput(block_id, key)


def _below(project: Project, block_id: str) -> Iterator[Place]:
    parent = project.parents[block_id]
    chain = project.chain_of(parent)
    if chain is None or block_id not in chain:
        return  # plugged into a slot: below its owner then
    index = chain.index(block_id) + 1
    if parent.slot:
        yield InBody(parent.owner, parent.slot, index)
    else:
        yield InStack(parent.owner, index)


def free_place(canvas: CanvasHost, clip: Clip) -> QPointF:
    """About the middle of the view, where no blocks are; the corner of the clip goes there."""
    project = clip.project
    layout = Layout(project, canvas.editor.language.of(project), canvas.look.measures)
    chain = layout.chain(clip.roots[0])
    seen = canvas.sight.visible_page_rect()
    width, height = min(chain.width, seen.width), min(chain.height, seen.height)
    side = 1.0 if canvas.look.measures.is_mirrored else -1.0
    x = seen.x + seen.width / 2 + side * width / 2
    y = seen.y + seen.height / 2 - height / 2
    while _is_taken(canvas, x, y, chain.width) and y < seen.bottom - STEP:
        x, y = x - side * STEP / 2, y + STEP
    return QPointF(x, y)


def _is_taken(canvas: CanvasHost, x: float, y: float, width: float) -> bool:
    side = -1.0 if canvas.look.measures.is_mirrored else 1.0
    return any(
        canvas.page_layout.hit(x + side * width * part, y + down) is not None
        for part in (0.05, 0.5, 0.95)
        for down in (-STEP / 4, STEP / 2, STEP)
    )


def _beside(canvas: CanvasHost) -> tuple[float, float] | None:
    """Where blocks go that the new ones push out: beside the cursor's block."""
    placed = canvas.page_layout.placed(canvas.selection.cursor)
    if placed is None:
        return None
    if placed.box.is_mirrored:
        return placed.x - BESIDE, placed.y + BESIDE
    return placed.x + placed.box.reach + BESIDE, placed.y + BESIDE
