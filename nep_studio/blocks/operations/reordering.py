"""The repeated parts of a block (else-ifs, items): add, remove, put in another order."""

from __future__ import annotations

from ..definitions import Definition
from ..editor import Editor
from ..edits import AddGroup, MoveBlocks, RemoveGroup, SetField
from ..errors import EditRefused
from ..places import InBody, InInput, place_of
from ..program import Block
from ..values import FieldValue
from .moving import Point, set_aside
from .selection import Run


def add_part(editor: Editor, block_id: str, group: str, index: int | None = None) -> int:
    """Add a part to a block, as number ``index`` from 1, else the last; gives its number."""
    block, definition = _require(editor, block_id, group)
    number = block.groups.get(group, 0) + 1 if index is None else index
    slots = definition.group_slots(group)
    fields = {slot: definition.defaults[slot] for slot in slots if slot in definition.defaults}
    editor.apply(AddGroup(block_id, group, number, slots, fields), "add a part")
    return number


def remove_part(
    editor: Editor, block_id: str, group: str, index: int, beside: Point | None = None
) -> None:
    """Remove a part of a block; blocks inside it become stacks, at ``beside`` and below it."""
    _, definition = _require(editor, block_id, group)
    slots = definition.group_slots(group)
    with editor.transaction("remove a part"):
        for run in _runs_in_part(editor, block_id, slots, index).values():
            set_aside(editor, run, beside)
            beside = (beside[0], beside[1] + 60.0) if beside else None
        editor.apply(RemoveGroup(block_id, group, index, slots))


def why_not_remove_part(editor: Editor, block_id: str, group: str, index: int) -> str | None:
    """Why a part cannot be removed, or None when it can."""
    try:
        _, definition = _require(editor, block_id, group)
    except EditRefused as refused:
        return refused.sentence
    return editor.why_not(RemoveGroup(block_id, group, index, definition.group_slots(group)))


def move_part(editor: Editor, block_id: str, group: str, index: int, to: int) -> None:
    """Make part number ``index`` of a block its part number ``to``, with all that is in it."""
    block, definition = _require(editor, block_id, group)
    count = block.groups.get(group, 0)
    if not (1 <= index <= count and 1 <= to <= count):
        raise EditRefused("There is no such part in this block.")
    if index == to:
        return
    slots = definition.group_slots(group)
    step = 1 if to > index else -1
    with editor.transaction("move a part"):
        for number in range(index, to, step):
            _swap(editor, block, slots, number, number + step)


def _swap(editor: Editor, block: Block, slots: tuple[str, ...], one: int, other: int) -> None:
    """Exchange what is in two parts: fields by setting them, blocks by moving them."""
    first = _runs_in_part(editor, block.id, slots, one)
    second = _runs_in_part(editor, block.id, slots, other)
    fields = {
        slot: (block.fields.get(f"{slot}.{one}"), block.fields.get(f"{slot}.{other}"))
        for slot in slots
    }
    for run in first.values():
        set_aside(editor, run)
    for slot, run in second.items():
        _put_in(editor, block, f"{slot}.{one}", run)
    for slot, run in first.items():
        _put_in(editor, block, f"{slot}.{other}", run)
    for slot, (here, there) in fields.items():
        _set(editor, block, f"{slot}.{one}", there)
        _set(editor, block, f"{slot}.{other}", here)


def _set(editor: Editor, block: Block, key: str, value: FieldValue | None) -> None:
    if block.fields.get(key) != value:
        editor.apply(SetField(block.id, key, value))


def _put_in(editor: Editor, block: Block, key: str, run: Run) -> None:
    slot = editor.language.definitions[block.type].slot(key, block.groups)
    is_body = slot is not None and slot.kind.name == "body"
    place = InBody(block.id, key, 0) if is_body else InInput(block.id, key)
    if place_of(editor.project, run.first, run.count) != place:
        editor.apply(MoveBlocks(run.first, run.count, place))


def _runs_in_part(
    editor: Editor, block_id: str, slots: tuple[str, ...], index: int
) -> dict[str, Run]:
    """What is in a part of a block, by slot."""
    block = editor.project.blocks[block_id]
    found = {}
    for slot in slots:
        key = f"{slot}.{index}"
        if key in block.inputs:
            found[slot] = Run(block.inputs[key], 1)
        elif block.bodies.get(key):
            found[slot] = Run(block.bodies[key][0], len(block.bodies[key]))
    return found


def _require(editor: Editor, block_id: str, group: str) -> tuple[Block, Definition]:
    block = editor.project.blocks.get(block_id)
    definition = editor.language.definitions.get(block.type) if block is not None else None
    if block is None or definition is None or group not in definition.groups:
        raise EditRefused("This block has no such part.")
    return block, definition
