"""Generated Python with a map: which block made each line, and which lines a block made."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Block, Project, split_slot


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
        Functions inside a rule, as for parts that go on together, are made above the loop in which
        they are used, if there is one: it is the line that uses them.
        """
        every, text = self.lines_of(block), self.text.splitlines()
        said = [text[line - 1].lstrip() for line in every]
        lines = [n for n, one in zip(every, said, strict=True) if not one.startswith("#")] or every
        if not lines:
            return 0
        first = text[lines[0] - 1]
        if not first.lstrip().startswith(("@", "def ")):
            return lines[0]
        if first.startswith(" ") and not first.lstrip().startswith("@"):
            return lines[-1]
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


# Finds the reporter block that made a call of the generated file, by the place of that call.

_PLACE = re.compile(r"@(\d+):(\d+)-(\d+)")

Place = tuple[int, int, int]
"""A line, from 1, and where in it a call begins and ends, in bytes, from 0."""


class ReporterPlaces:
    """The reporters of one generated file; made anew when the project changes."""

    def __init__(self, code: Code, project: Project, language: Language) -> None:
        self._code = code
        self._project = project
        self._definitions = language.of(project).definitions
        self._lines = code.text.splitlines()
        self._known: dict[str, dict[Place, str]] = {}

    def block_at(self, place: str) -> str | None:
        """The reporter at a place such as "@12:4-20", which the program's values are told by."""
        read = _PLACE.fullmatch(place)
        if read is None:
            return None
        line, begin, end = map(int, read.groups())
        statement = self._code.block_at(line)
        if statement is None or statement not in self._project.blocks:
            return None
        if statement not in self._known:
            self._known[statement] = self._places(statement)
        return self._known[statement].get((line, begin, end))

    def _places(self, statement: str) -> dict[Place, str]:
        """The reporters plugged into a statement, by the places of their calls."""
        calls: defaultdict[str, list[Place]] = defaultdict(list)
        for line in self._code.lines_of(statement):
            for name, place in _calls(self._lines[line - 1], line):
                calls[name].append(place)
        blocks: defaultdict[str, list[str]] = defaultdict(list)
        for name, block in self._reporters(self._project.blocks[statement]):
            blocks[name].append(block)
        return {
            place: block
            for name, made in blocks.items()
            for place, block in _paired(calls[name], made)
        }

    def _reporters(self, block: Block) -> Iterator[tuple[str, str]]:
        """The called names and ids of the reporters in a block, in their order in its sentence."""
        definition = self._definitions.get(block.type)
        if definition is None:
            return
        slots, keys = list(definition.slots), [(*split_slot(key), key) for key in block.inputs]
        in_order = sorted((number, slots.index(name), key) for name, number, key in keys)
        for _, _, key in in_order:
            plugged = self._project.blocks[block.inputs[key]]
            made = self._definitions.get(plugged.type)
            if plugged.disabled or made is None:
                continue
            if made.call is not None:
                yield made.call.name, plugged.id
            yield from self._reporters(plugged)


def _paired(places: list[Place], blocks: list[str]) -> Iterator[tuple[Place, str]]:
    """Calls of one name with the blocks that make such calls; none where that is not sure."""
    if len(blocks) == 1:  # the Python of some blocks says what is plugged into them twice
        yield from ((place, blocks[0]) for place in places)
    elif len(places) == len(blocks):
        yield from zip(places, blocks, strict=True)


def _calls(text: str, line: int) -> list[tuple[str, Place]]:
    """The calls in a line, those that begin first, and of these the longest, first."""
    head = next((word for word in ("@", "el") if text.lstrip().startswith(word)), "")
    inner = text.lstrip()[len(head) :]
    shift = len(text.encode()) - len(inner.encode())
    try:
        tree = ast.parse(f"{inner} pass" if inner.endswith(":") else inner)
    except SyntaxError:  # such as "else:"
        return []
    found = [
        (_called(node), (line, node.col_offset + shift, (node.end_col_offset or 0) + shift))
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
    ]
    return sorted(found, key=lambda call: (call[1][1], -call[1][2]))


def _called(node: ast.Call) -> str:
    if isinstance(node.func, ast.Attribute):
        return node.func.attr
    return node.func.id if isinstance(node.func, ast.Name) else ""
