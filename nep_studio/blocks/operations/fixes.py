"""Carry out what a problem offers to do about itself, as one step."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ..checks.problem import Fix, Problem
from ..deployment import GESTURE_NODE, NODE_BLOCK, ROBOT_BLOCK, node_entries, robot_entries
from ..editor import Editor
from ..edits import CreateBlocks, SetField
from ..errors import EditRefused
from ..places import InBody, InStack, Place, place_of
from ..values import FieldValue

Data = Mapping[str, str]
WAIT, POSTURE = "control.wait", "robot.do"


def apply_fix(editor: Editor, problem: Problem) -> str:
    """Carry out the fix of a problem; gives the block that it made or changed, to be shown.

    Raises EditRefused when there is no fix, or when the program has changed too much for it.
    """
    fix = problem.fix
    if fix is None or fix.name not in FIXES:
        raise EditRefused(
            "The program cannot do this by itself.", checklist=problem.checklist or ()
        )
    with editor.transaction(label_of(fix)):
        return FIXES[fix.name](editor, fix.data)


def label_of(fix: Fix) -> str:
    """What the button of a fix says, and the step that undoes it."""
    return fix.label


def _add_robot(editor: Editor, data: Data) -> str:
    return append_entry(editor, "robots", ROBOT_BLOCK, {"name": data["name"]})


def _add_gesture_node(editor: Editor, data: Data) -> str:
    gesture = data["gesture"]
    fields: dict[str, FieldValue] = {
        "node": GESTURE_NODE,
        "name": _free_name(editor, gesture),
        "parameters": {"gesture": gesture},
    }
    return append_entry(editor, "nodes", NODE_BLOCK, fields)


def _add_wait(editor: Editor, data: Data) -> str:
    """A wait at the end of a loop; before the blocks inside it when nothing goes below those."""
    owner = editor.project.blocks.get(data["block"])
    if owner is None:
        raise EditRefused("This block is not there any more.")
    end = InBody(owner.id, data["slot"], len(owner.bodies.get(data["slot"], [])))
    begin = InBody(owner.id, data["slot"], 0)
    new = editor.language.definitions[WAIT].new_block(editor.project.new_id("b"))
    fits = editor.why_not(CreateBlocks((new.id,), (new,), end)) is None
    return editor.create(WAIT, end if fits else begin)


def _stand_first(editor: Editor, data: Data) -> str:
    if data["block"] not in editor.project.blocks:
        raise EditRefused("This block is not there any more.")
    standing = editor.language.profile.standing
    postures = editor.language.choices.get("postures", {})
    posture = next((name for name in postures if name in standing), min(standing, default=""))
    place = place_of(editor.project, data["block"], 1)
    return _create(editor, POSTURE, place, {"robot": data["robot"], "posture": posture})


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


def _free_name(editor: Editor, wanted: str) -> str:
    """A name that no robot and no node has."""
    project, language = editor.project, editor.language
    taken = {entry.name for entry in robot_entries(project, language)}
    taken |= {entry.name for entry in node_entries(project, language)}
    name, number = wanted, 2
    while name in taken:
        name, number = f"{wanted} {number}", number + 1
    return name


FIXES: dict[str, Callable[[Editor, Data], str]] = {
    "add_robot": _add_robot,
    "add_gesture_node": _add_gesture_node,
    "add_wait": _add_wait,
    "stand_first": _stand_first,
}
"""What the checks offer, by name; a test sees to it that none is missing."""
