"""Rename what blocks name, everywhere in one step."""

from __future__ import annotations

from ..deployment import ROBOT_BLOCK, robot_entries
from ..editor import Editor
from ..edits import RenameVariable, SetField
from ..errors import EditRefused
from ..program import ALL_ROBOTS
from ..values import why_not_name


def rename_variable(editor: Editor, variable: str, name: str) -> None:
    """Give a variable another name; blocks name it by its id and follow."""
    editor.apply(RenameVariable(variable, name), "rename a variable")


def rename_robot(editor: Editor, old: str, new: str) -> None:
    """Give a robot another name, on the Robots page and in all blocks that name it."""
    if (reason := why_not_rename_robot(editor, old, new)) is not None:
        raise EditRefused(reason)
    with editor.transaction("rename a robot"):
        for block in list(editor.project.blocks.values()):
            definition = editor.language.definitions.get(block.type)
            if definition is None:
                continue
            for key, slot in list(definition.keys(block.groups)):
                is_name = slot.kind.name == "robot" or (block.type == ROBOT_BLOCK and key == "name")
                if is_name and definition.value(block, key) == old:
                    editor.apply(SetField(block.id, key, new))


def why_not_rename_robot(editor: Editor, old: str, new: str) -> str | None:
    """Why a robot cannot have another name, or None when it can."""
    if old == ALL_ROBOTS or new == ALL_ROBOTS:
        return f"“{ALL_ROBOTS}” stands for all robots, and cannot be the name of one."
    if new != old and any(e.name == new for e in robot_entries(editor.project, editor.language)):
        return f"There is a robot “{new}” already."
    return why_not_name(new)
