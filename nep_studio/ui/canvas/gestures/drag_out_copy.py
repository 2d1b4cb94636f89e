"""New blocks that are pulled out of others: a variable out of a header, or a copy."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.blocks.operations.copying import copy
from nep_studio.blocks.operations.parameters_out import reporter_of

from ..page import Hit
from .cargo import NewBlocks

if TYPE_CHECKING:
    from ..canvas import Canvas

HEADERS = ("hat", "c")
"""The shapes of blocks that give a name to what runs inside them."""


def pulled_out(canvas: Canvas, hit: Hit) -> NewBlocks | None:
    """The reporter that is pulled out of a parameter, or of the variable of a header; or None."""
    editor, piece = canvas.editor, hit.piece
    if piece is None or piece.kind not in ("parameter", "variable"):
        return None
    definition = editor.language.definitions.get(hit.placed.box.type)
    if definition is None or (piece.kind == "variable" and definition.shape not in HEADERS):
        return None
    clip = reporter_of(editor.project, editor.language, hit.block, piece.key)
    if clip is None:
        return None
    right = piece.x + (piece.width if canvas.measures.is_mirrored else 0.0)
    return NewBlocks(canvas, clip, (hit.placed.x + right, hit.placed.y + piece.y))


def copy_of(canvas: Canvas, hit: Hit) -> NewBlocks:
    """A copy of a block, or of the selection that it is one of, lying on the original."""
    editor, selection = canvas.editor, canvas.selection
    ids = selection.ids if hit.block in selection else (hit.block,)
    clip = copy(editor.project, editor.language, ids, canvas.corners(ids))
    return NewBlocks(canvas, clip, clip.corner)
