"""Carry out what a problem offers to do about itself, as one step."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping

from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.blocks.deployment import (
    NODE_BLOCK,
    NodeEntry,
    node_entries,
    robot_entries,
)
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import CreateBlocks, DeleteBlocks
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.places import InBody, InStack, Place, place_of
from nep_studio.blocks.program import ROBOT_BLOCK
from nep_studio.blocks.slots import FieldValue, Setting

Data = Mapping[str, str]
WAIT, POSTURE = "control.wait", "robot.do"


def apply_fix(editor: Editor, problem: Diagnostic) -> str:
    """Carry out the fix of a problem; gives the block that it made or changed, to be shown.

    Raises EditRefused when there is no fix, or when the program has changed too much for it.
    """
    fix = problem.fix
    if fix is None or fix.name not in FIXES:
        raise EditRefused(
            "The program cannot do this by itself.", checklist=problem.checklist or ()
        )
    with editor.transaction(fix.label):
        return FIXES[fix.name](editor, fix.data)


def _add_robot(editor: Editor, data: Data) -> str:
    return append_entry(editor, "robots", ROBOT_BLOCK, {"name": data["name"]})


def _add_wait(editor: Editor, data: Data) -> str:
    """A wait at the end of a loop; before the blocks inside it when nothing goes below those."""
    owner = editor.project.blocks.get(data["block"])
    if owner is None:
        raise EditRefused("This block is not there any more.")
    place = InBody(owner.id, data["slot"], len(owner.bodies.get(data["slot"], [])))
    new = editor.language.definitions[WAIT].new_block(editor.project.new_id("b"))
    if editor.why_not(CreateBlocks((new.id,), (new,), place)) is not None:
        place = InBody(owner.id, data["slot"], 0)
    return editor.create(WAIT, place)


def _stand_first(editor: Editor, data: Data) -> str:
    if data["block"] not in editor.project.blocks:
        raise EditRefused("This block is not there any more.")
    standing = editor.language.standing
    postures = editor.language.choices.get("postures", {})
    posture = next((name for name in postures if name in standing), min(standing, default=""))
    place = place_of(editor.project, data["block"], 1)
    return _create(editor, POSTURE, place, {"robot": data["robot"], "posture": posture})


def _let_robot(editor: Editor, data: Data) -> str:
    """Let another robot do what a block asks."""
    block = editor.project.blocks.get(data["block"])
    definition = editor.language.definitions.get(block.type) if block is not None else None
    slots = definition.slots.values() if definition is not None else ()
    robot = next((slot.name for slot in slots if slot.kind.name == "robot"), "")
    return _choose(editor, {"block": data["block"], "slot": robot, "value": data["robot"]})


def _choose(editor: Editor, data: Data) -> str:
    editor.apply(SetField(data["block"], data["slot"], data["value"]))
    return data["block"]


def append_entry(
    editor: Editor, page: str, block_type: str, fields: Mapping[str, FieldValue]
) -> str:
    """Make a block at the end of the last stack of a page that takes it, else below them."""
    stacks = editor.project.pages[page]
    new = editor.language.definitions[block_type].new_block(editor.project.new_id("b"))
    for stack in reversed(stacks):
        place = InStack(stack.id, len(stack.body))
        if editor.why_not(CreateBlocks((new.id,), (new,), place)) is None:
            return _create(editor, block_type, place, fields)
    lowest = max((stack.y for stack in stacks), default=-60.0)
    return _create(editor, block_type, editor.new_stack(page, 40.0, lowest + 100.0), fields)


def _create(editor: Editor, block_type: str, place: Place, fields: Mapping[str, FieldValue]) -> str:
    block = editor.create(block_type, place)
    for slot, value in fields.items():
        editor.apply(SetField(block, slot, value))
    return block


def free_name(editor: Editor, wanted: str) -> str:
    """A name that no robot and no node has: the wanted one, or with a number."""
    project, language = editor.project, editor.language
    taken = {entry.name for entry in robot_entries(project, language)}
    taken |= {entry.name for entry in node_entries(project, language)}
    names = (f"{wanted} {number}" if number > 1 else wanted for number in itertools.count(1))
    return next(name for name in names if name not in taken)


FIXES: dict[str, Callable[[Editor, Data], str]] = {
    "add_robot": _add_robot,
    "add_wait": _add_wait,
    "stand_first": _stand_first,
    "let_robot": _let_robot,
    "choose": _choose,
}
"""What the checks offer, by name; a test sees to it that none is missing."""


# Let a robot of the Robots page be the real one at an address, as one step.

REAL = "naoqi"


def use_real_robot(editor: Editor, name: str, address: str, label: str) -> str:
    """Let the robot of a name be at an address; gives its block. Raises EditRefused.

    Where there is no such robot a block is added to the Robots page.
    """
    entries = robot_entries(editor.project, editor.language)
    block = next((entry.block_id for entry in entries if entry.name == name), "")
    with editor.transaction(label):
        block = block or append_entry(editor, "robots", ROBOT_BLOCK, {"name": name})
        editor.apply(SetField(block, "driver", REAL))
        editor.apply(SetField(block, "address", address))
    return block


def rename_robot(editor: Editor, block: str, name: str) -> None:
    """Give a robot of the Robots page another name, as one step; raises EditRefused.

    The blocks that name it follow, and the Python that people wrote. They stay where they are
    while another robot has the old name, or the new one is that of another.
    """
    definition = editor.language.definitions[editor.project.blocks[block].type]
    old = str(definition.value(editor.project.blocks[block], "name"))
    others = {
        entry.name
        for entry in robot_entries(editor.project, editor.language)
        if entry.block_id != block
    }
    is_followed = old.strip() != "" and not others & {old, name}
    follow = editor.renaming({old: name} if is_followed else {})
    with editor.transaction("rename a robot"), follow:
        for use, key in list(_uses_of_robot(editor, old)) if is_followed else ():
            editor.apply(SetField(use, key, name))
        editor.apply(SetField(block, "name", name))


def _uses_of_robot(editor: Editor, name: str) -> Iterator[tuple[str, str]]:
    for block in editor.project.blocks.values():
        definition = editor.language.definitions.get(block.type)
        for key, slot in definition.keys(block.groups) if definition is not None else ():
            is_named = slot.kind.name == "robot" and definition is not None
            if is_named and definition is not None and definition.value(block, key) == name:
                yield block.id, key


# Let a node of the Nodes page be where the movements come from, as one step.

WATCH = "sensory/smartwatch"
STAND_INS = ("sensory/virtual_watch", "sensory/replay")
"""What gives movements as long as there is no real watch."""
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
    name = name or (changed.name if changed is not None else free_name(editor, USUAL_NAME))
    gone = [one.block_id for one in entries if one.node in STAND_INS and one != changed]
    fields: dict[str, FieldValue] = {"node": node, "name": name, "parameters": dict(settings)}
    with editor.transaction(label):
        for block_id in gone:
            editor.apply(DeleteBlocks(block_id, 1))
        if changed is None:
            return append_entry(editor, "nodes", NODE_BLOCK, fields)
        for slot, value in fields.items():
            editor.apply(SetField(changed.block_id, slot, value))
    return changed.block_id


def watch_entry(entries: tuple[NodeEntry, ...], name: str = "") -> NodeEntry | None:
    """The entry that a watch takes: of this name, else a watch, else a stand-in; None: a new one.

    With a ``name`` that nobody has, a stand-in is taken, but no watch: there may be two.
    """
    if name and (named := next((one for one in entries if one.name == name), None)):
        return named
    wanted = STAND_INS if name else (WATCH, *STAND_INS)
    return next((one for node in wanted for one in entries if one.node == node), None)


# Let a program that has no beginning begin when it starts.

STARTED = "event.started"


def add_start(editor: Editor) -> str:
    """Put “when the program starts” above the first stack without a beginning; gives its id.

    Where there is no such stack it stands alone. Raises EditRefused.
    """
    with editor.transaction("Add a beginning"):
        block = editor.language.definitions[STARTED].new_block(editor.project.new_id("b"))
        for stack in editor.project.pages["behaviour"]:
            edit = CreateBlocks((block.id,), (block,), InStack(stack.id, 0))
            if editor.why_not(edit) is None:
                editor.apply(edit)
                return block.id
        place = editor.new_stack("behaviour", 40.0, 40.0)
        editor.apply(CreateBlocks((block.id,), (block,), place))
        return block.id
