"""Finds the reporter block that made a call of the generated file, by the place of that call."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator

from ..language import Language
from ..program import Block, Project, split_slot
from .source_map import Code

_PLACE = re.compile(r"@(\d+):(\d+)-(\d+)")
_MOST_STATEMENTS = 1000

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
            if len(self._known) >= _MOST_STATEMENTS:
                self._known.clear()
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
        slots = list(definition.slots) if definition is not None else []
        in_order = sorted(
            block.inputs,
            key=lambda key: (split_slot(key)[1], _index(slots, split_slot(key)[0])),
        )
        for key in in_order:
            plugged = self._project.blocks[block.inputs[key]]
            made = self._definitions.get(plugged.type)
            if plugged.disabled or made is None:
                continue
            if made.call is not None:
                yield made.call.name, plugged.id
            yield from self._reporters(plugged)


def _index(slots: list[str], name: str) -> int:
    return slots.index(name) if name in slots else len(slots)


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
