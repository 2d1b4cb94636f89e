"""Change a chain of blocks to another one, keeping the blocks whose Python is the same."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from difflib import SequenceMatcher
from functools import partial

from ..editor import Editor
from ..edits import CreateBlocks, DeleteBlocks, SetComment, SetField
from ..generate.source_map import Code
from ..operations.selection import chain_around
from ..places import InBody, InInput, InStack, Place
from ..program import Block
from .made import Made, blocks_of


class ChainUpdater:
    """Changes stacks that made ``code`` as they were."""

    def __init__(self, editor: Editor, code: Code) -> None:
        self._editor = editor
        self._code = code
        self._lines = code.text.splitlines()
        self._numbers: dict[str, tuple[int, int]] = {}
        for number, block in enumerate(code.blocks, start=1):
            while block in editor.project.blocks:
                first = self._numbers.get(block, (number, 0))[0]
                self._numbers[block] = (first, number)
                block = editor.project.parents[block].owner

    def update_stack(self, first: str, wanted: Sequence[Made]) -> str:
        """Change the stack that begins with a block; its hat stays when it is of the same type.

        Gives the first block as it is then.
        """
        project = self._editor.project
        stack = project.stack_of(first)
        hat = project.blocks[first]
        if self._hat_text(first) == wanted[0].text:
            pass
        elif hat.type != wanted[0].type:
            roots, blocks = blocks_of(project, self._editor.language, wanted[:1])
            self._editor.apply(DeleteBlocks(first, 1))
            if stack.id in project.stacks:
                place: Place = InStack(stack.id, 0)
            else:
                place = self._editor.new_stack("behaviour", stack.x, stack.y)
            self._editor.apply(CreateBlocks(roots, blocks, place))
            stack = project.stack_of(roots[0])
        else:
            self._change(hat, wanted[0])
        self._update(stack.body[1:], wanted[1:], partial(_below_hat, stack.id))
        return stack.body[0]

    def _update(
        self, old: Sequence[str], wanted: Sequence[Made], place: Callable[[int], Place]
    ) -> None:
        """Change the blocks of a chain, from its end on; disabled ones stay where they are."""
        blocks = self._editor.project.blocks
        enabled = [index for index, block in enumerate(old) if not blocks[block].disabled]
        before = [self._text(old[index]) for index in enabled]
        matcher = SequenceMatcher(None, before, [made.text for made in wanted], autojunk=False)
        for what, i, end, j, until in reversed(matcher.get_opcodes()):
            if what == "equal":
                continue
            pairs = min(end - i, until - j)
            for index in reversed(enabled[i + pairs : end]):
                self._editor.apply(DeleteBlocks(old[index], 1))
            for number in range(pairs):
                self._replace(old[enabled[i + number]], wanted[j + number], place)
            if until - j > pairs:
                begin = enabled[i] if i < len(enabled) else len(old)
                begin = enabled[i + pairs - 1] + 1 if pairs else begin
                self._create(wanted[j + pairs : until], place(begin))

    def _replace(self, block_id: str, made: Made, place: Callable[[int], Place]) -> None:
        """Change a block to another: itself when it is of the same type, else by a new one."""
        block = self._editor.project.blocks[block_id]
        groups = {name: count for name, count in block.groups.items() if count}
        wanted = {name: count for name, count in made.groups.items() if count}
        if block.type == made.type and groups == wanted:
            self._change(block, made)
            return
        chain = chain_around(self._editor.project, block_id)
        index = chain.index(block_id) - _first_index(place(0))
        self._editor.apply(DeleteBlocks(block_id, 1))
        self._create([made], place(index))

    def _change(self, block: Block, made: Made) -> None:
        """Give a block other fields, plugged blocks, comment, and what is in its bodies."""
        editor = self._editor
        definition = editor.language.definitions[block.type]
        if block.comment != made.comment:
            editor.apply(SetComment(block.id, made.comment))
        for key, slot in list(definition.keys(block.groups)):
            if slot.kind.name == "body":
                body = list(block.bodies.get(key, []))
                self._update(body, made.bodies.get(key, []), partial(InBody, block.id, key))
                continue
            if key in block.inputs:
                editor.apply(DeleteBlocks(block.inputs[key], 1))
            wanted = made.fields.get(key)
            if wanted is not None and definition.value(block, key) != wanted:
                editor.apply(SetField(block.id, key, wanted))
            if key in made.inputs:
                self._create([made.inputs[key]], InInput(block.id, key))

    def _create(self, chain: Sequence[Made], place: Place) -> int:
        roots, blocks = blocks_of(self._editor.project, self._editor.language, chain)
        self._editor.apply(CreateBlocks(roots, blocks, place))
        return len(roots)

    def _hat_text(self, hat: str) -> str:
        """The lines of a hat, to the one that begins the function."""
        lines = [self._lines[number - 1] for number in self._code.lines_of(hat)]
        end = next((n for n, line in enumerate(lines, 1) if line.startswith("def ")), 0)
        return "\n".join(lines[:end])

    def _text(self, block: str) -> str:
        """The lines that a block makes with all inside it, without their margin."""
        if block not in self._numbers:
            return ""
        first, last = self._numbers[block]
        return textwrap.dedent("\n".join(self._lines[first - 1 : last])).rstrip()


def _below_hat(stack: str, index: int) -> InStack:
    return InStack(stack, index + 1)


def _first_index(place: Place) -> int:
    return place.index if isinstance(place, InStack | InBody) else 0
