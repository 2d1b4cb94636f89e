"""Put a C block around blocks, or take one away from around them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from faults import Text
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddGroup, RemoveGroup, SetField, SetFlag
from nep_studio.blocks.edits.placing import DeleteBlocks, MoveBlocks
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.places import InBody, InInput, InStack, place_of
from nep_studio.blocks.program import Block
from nep_studio.blocks.slots import FieldValue

from .moving import Point, first_body, set_aside, without_hat
from .selection import Run, members, require_runs


def wrap(editor: Editor, ids: Iterable[str], block_type: str) -> str:
    """Put a new C block around selected blocks that follow each other; gives its id.

    A hat at the beginning stays outside. Raises EditRefused.
    """
    run = _without_hat(editor, _single(editor, ids))
    page = editor.project.page_of(run.first)
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


def why_not_wrap(editor: Editor, ids: Iterable[str]) -> Text | None:
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
    left = without_hat(editor, run)
    if left is None:
        raise EditRefused(
            "A “when” block begins a stack: no block goes around it.",
            checklist=("Choose the blocks below it.",),
        )
    return left


# Disable, collapse and comment several blocks at once.

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


# The repeated parts of a block (else-ifs, items): add, remove, put in another order.


def add_part(editor: Editor, block_id: str, group: str) -> int:
    """Add a part to the end of a block; gives its number."""
    block, definition = _require(editor, block_id, group)
    number = block.groups.get(group, 0) + 1
    slots = definition.group_slots(group)
    beginnings = ((slot, definition.beginning(slot)) for slot in slots)
    fields = {slot: value for slot, value in beginnings if value is not None}
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
            # Exchange what is in two parts: fields by setting them, blocks by moving them
            other = number + step
            first = _runs_in_part(editor, block.id, slots, number)
            second = _runs_in_part(editor, block.id, slots, other)
            fields = {
                slot: (block.fields.get(f"{slot}.{number}"), block.fields.get(f"{slot}.{other}"))
                for slot in slots
            }
            for run in first.values():
                set_aside(editor, run)
            for slot, run in second.items():
                _put_in(editor, block, f"{slot}.{number}", run)
            for slot, run in first.items():
                _put_in(editor, block, f"{slot}.{other}", run)
            for slot, (here, there) in fields.items():
                _set_groups(editor, block, f"{slot}.{number}", there)
                _set_groups(editor, block, f"{slot}.{other}", here)


def _set_groups(editor: Editor, block: Block, key: str, value: FieldValue | None) -> None:
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
