"""Let a node of the Nodes page be where the movements come from, as one step."""

from __future__ import annotations

from collections.abc import Mapping

from ..deployment import NODE_BLOCK, NodeEntry, node_entries, robot_entries
from ..editor import Editor
from ..edits import DeleteBlocks, SetField
from ..values import FieldValue, Setting
from .fixes import append_entry

WATCH = "sensory/smartwatch"
STAND_INS = ("sensory/virtual_watch", "sensory/replay")
"""What gives movements as long as there is no real watch."""
PAGE = "nodes"
USUAL_NAME = "watch"


def use_watch(
    editor: Editor,
    settings: Mapping[str, Setting],
    label: str,
    *,
    node: str = WATCH,
    name: str = "",
) -> str:
    """Let a watch with these settings give the movements; gives its block. Raises EditRefused.

    The block of this ``name`` becomes it; without, that of a watch, else of what stands in for
    one; else a block is added to the Nodes page. All other stand-ins go: a virtual watch would
    move at the same time. ``node`` may be a stand-in itself.
    """
    entries = node_entries(editor.project, editor.language)
    changed = watch_entry(entries, name)
    name = name or (changed.name if changed is not None else free_watch_name(editor))
    gone = [one.block_id for one in entries if one.node in STAND_INS and one != changed]
    fields: dict[str, FieldValue] = {"node": node, "name": name, "parameters": dict(settings)}
    with editor.transaction(label):
        for block_id in gone:
            editor.apply(DeleteBlocks(block_id, 1))
        if changed is None:
            return append_entry(editor, PAGE, NODE_BLOCK, fields)
        for slot, value in fields.items():
            editor.apply(SetField(changed.block_id, slot, value))
    return changed.block_id


def watch_entry(entries: tuple[NodeEntry, ...], name: str = "") -> NodeEntry | None:
    """The entry that a watch takes: of this name, else a watch, else a stand-in; None: a new one.

    With a ``name`` that nobody has, a stand-in is taken, but no watch: there may be two.
    """
    if name and (named := next((one for one in entries if one.name == name), None)):
        return named
    wanted = [*([] if name else [WATCH]), *STAND_INS]
    found = [one for node in wanted for one in entries if one.node == node]
    return found[0] if found else None


def free_watch_name(editor: Editor) -> str:
    """A name for another watch: "watch", or with a number."""
    project, language = editor.project, editor.language
    taken = {one.name for one in robot_entries(project, language)}
    taken |= {one.name for one in node_entries(project, language)}
    name, number = USUAL_NAME, 2
    while name in taken:
        name, number = f"{USUAL_NAME} {number}", number + 1
    return name
