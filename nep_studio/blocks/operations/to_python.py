"""The Python of selected blocks, for the clipboard."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable

from ..edits import AddVariable, CreateBlocks, MoveBlocks
from ..generate.program import generate_program
from ..generate.source_map import Code
from ..language import Language
from ..places import InInput, InStack
from ..program import Project
from .copying import copy

HAT, HOLDER, HELD = "event.started", "variable.set", "value"
"""What makes lines of blocks that make none by themselves: a hat, a statement and its slot."""


def python_of(project: Project, language: Language, ids: Iterable[str]) -> str:
    """The Python of selected blocks: rules whole, other blocks as the lines that they make.

    Raises CodeRefused, which names the block.
    """
    clip = copy(project, language, ids).project
    language = language.of(clip)
    added = {
        stack.id: _complete(clip, language, stack.body[0])
        for stack in list(clip.pages["behaviour"])
    }
    code = generate_program(clip, language)
    lines = code.text.splitlines()
    texts = [_lines(clip, code, lines, stack, blocks) for stack, blocks in added.items()]
    return "\n\n".join(text for text in texts if text)


def _complete(clip: Project, language: Language, first: str) -> set[str]:
    """Put a hat above a stack that has none, and a value into a statement; gives what was added."""
    definition = language.definitions.get(clip.blocks[first].type)
    if definition is None or definition.shape == "hat":
        return set()
    stack = clip.stack_of(first).id
    hat = _create(clip, language, HAT, stack)
    if not definition.is_value:
        return {hat}
    holder = _create(clip, language, HOLDER, stack)
    clip.blocks[holder].fields["variable"] = _variable(clip)
    MoveBlocks(first, 1, InInput(holder, HELD)).apply(clip)
    MoveBlocks(holder, 1, InStack(stack, 1)).apply(clip)
    return {hat, holder}


def _create(clip: Project, language: Language, block_type: str, stack: str) -> str:
    block = language.definitions[block_type].new_block(clip.new_id("b"))
    CreateBlocks((block.id,), (block,), InStack(stack, 0)).apply(clip)
    return block.id


def _variable(clip: Project) -> str:
    variable, name = clip.new_id("v"), "value"
    while any(known.name == name for known in clip.variables):
        name += "_"
    AddVariable(variable, name, len(clip.variables)).apply(clip)
    return variable


def _lines(clip: Project, code: Code, lines: list[str], stack: str, added: set[str]) -> str:
    """The lines of a stack, without those of the blocks that were added to it."""
    held = [line for block in added for line in code.lines_of(block) if len(added) == 2]
    if held:  # the last of them is “name = value”
        return lines[max(held) - 1].partition(" = ")[2]
    inside = (block.id for block in clip.within(clip.stacks[stack].body) if block.id not in added)
    numbers = [line for block in inside for line in code.lines_of(block)]
    if not numbers:
        return ""
    return textwrap.dedent("\n".join(lines[min(numbers) - 1 : max(numbers)]))
