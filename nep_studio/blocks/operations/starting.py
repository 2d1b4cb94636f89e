"""Let a program that has no beginning begin when it starts."""

from __future__ import annotations

from ..editor import Editor
from ..edits import CreateBlocks
from ..places import InStack

STARTED = "event.started"
PAGE = "behaviour"


def add_start(editor: Editor) -> str:
    """Put “when the program starts” above the first stack without a beginning; gives its id.

    Where there is no such stack it stands alone. Raises EditRefused.
    """
    with editor.transaction("Add a beginning"):
        block = editor.language.definitions[STARTED].new_block(editor.project.new_id("b"))
        for stack in editor.project.pages[PAGE]:
            edit = CreateBlocks((block.id,), (block,), InStack(stack.id, 0))
            if editor.why_not(edit) is None:
                editor.apply(edit)
                return block.id
        place = editor.new_stack(PAGE, 40.0, 40.0)
        editor.apply(CreateBlocks((block.id,), (block,), place))
        return block.id
