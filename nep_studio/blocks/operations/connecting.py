"""Let a robot of the Robots page be the real one at an address, as one step."""

from __future__ import annotations

from ..deployment import ROBOT_BLOCK, robot_entries
from ..editor import Editor
from ..edits import SetField
from .fixes import append_entry

REAL = "naoqi"
PAGE = "robots"


def use_real_robot(editor: Editor, name: str, address: str, label: str) -> str:
    """Let the robot of a name be at an address; gives its block. Raises EditRefused.

    Where there is no such robot a block is added to the Robots page.
    """
    entries = robot_entries(editor.project, editor.language)
    block = next((entry.block_id for entry in entries if entry.name == name), "")
    with editor.transaction(label):
        block = block or append_entry(editor, PAGE, ROBOT_BLOCK, {"name": name})
        editor.apply(SetField(block, "driver", REAL))
        editor.apply(SetField(block, "address", address))
    return block
