"""Disable, collapse and comment several blocks at once."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from ..editor import Editor
from ..edits import SetComment, SetFlag
from .selection import members, require_runs

Flag = Literal["disabled", "collapsed"]

LABELS: dict[tuple[Flag, bool], str] = {
    ("disabled", True): "disable blocks",
    ("disabled", False): "enable blocks",
    ("collapsed", True): "collapse blocks",
    ("collapsed", False): "expand blocks",
}
"""What the step is called, whole, so that it can be translated."""


def set_disabled(editor: Editor, ids: Iterable[str], on: bool) -> None:
    """Disable selected blocks, or enable them again; those inside them go along."""
    _set(editor, _outer(editor, ids), "disabled", on)


def set_collapsed(editor: Editor, ids: Iterable[str], on: bool) -> None:
    """Collapse selected blocks, or open them again."""
    _set(editor, ids, "collapsed", on)


def toggle(editor: Editor, ids: Iterable[str], flag: Flag) -> bool:
    """Turn a flag on for all selected blocks, or off when all have it; gives what it is now."""
    blocks = _outer(editor, ids)
    on = not all(getattr(editor.project.blocks[block], flag) for block in blocks)
    if flag == "disabled":
        set_disabled(editor, blocks, on)
    else:
        set_collapsed(editor, blocks, on)
    return on


def set_comment(editor: Editor, block: str, comment: str) -> None:
    """Write the comment of a block; an empty one takes it away."""
    editor.apply(SetComment(block, comment), "write a comment")


def _outer(editor: Editor, ids: Iterable[str]) -> list[str]:
    """The selected blocks that are not inside other selected ones."""
    chosen = require_runs(editor.project, ids)
    return [block for run in chosen for block in members(editor.project, run)]


def _set(editor: Editor, ids: Iterable[str], flag: Flag, on: bool) -> None:
    with editor.transaction(LABELS[flag, on]):
        for block in ids:
            there = editor.project.blocks.get(block)
            if there is not None and getattr(there, flag) != on:
                editor.apply(SetFlag(block, flag, on))
