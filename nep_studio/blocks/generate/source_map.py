"""Generated Python with a map: which block made each line, and which lines a block made."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from ..program import Project


@dataclass(frozen=True)
class Code:
    """A generated file; ``blocks[i]`` made line i + 1 (an empty text where no block did).

    ``variables`` are the Python names of the project's variables, by their ids.
    """

    text: str
    blocks: tuple[str, ...]
    variables: Mapping[str, str] = field(default_factory=dict)

    def block_at(self, line: int) -> str | None:
        """The block that made a line, counted from 1, or None."""
        if not 1 <= line <= len(self.blocks):
            return None
        return self.blocks[line - 1] or None

    def lines_of(self, block: str) -> tuple[int, ...]:
        """The lines that a statement block made itself, without those of the blocks inside it."""
        return self._lines.get(block, ())

    def stop_at(self, block: str) -> int:
        """The line before which a program pauses that is to pause at a block; 0 where none is.

        At a rule that is the first line inside: its own line is run once, when it is made known.
        Functions inside a rule, as for parts that go on together, are made when it gets there.
        """
        lines, text = self.lines_of(block), self.text.splitlines()
        if not lines:
            return 0
        if not text[lines[0] - 1].startswith(("@", "def ")):
            return lines[0]
        if text[lines[-1] - 1].strip() == "pass":
            return lines[-1]
        inside = range(lines[-1] + 1, len(self.blocks) + 1)
        return next((line for line in inside if self.blocks[line - 1]), 0)

    def statement_of(self, block: str, project: Project) -> str | None:
        """The statement block that a block is, or in whose lines it is, or None."""
        while block and block not in self._lines:
            parent = project.parents.get(block)
            block = parent.owner if parent is not None else ""
        return block or None

    @cached_property
    def _lines(self) -> dict[str, tuple[int, ...]]:
        lines: defaultdict[str, list[int]] = defaultdict(list)
        for number, block in enumerate(self.blocks, start=1):
            if block:
                lines[block].append(number)
        return {block: tuple(numbers) for block, numbers in lines.items()}
