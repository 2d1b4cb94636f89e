"""The generator functions of statement blocks that are more than one call.

Each gives pieces in order: lines, bodies (the chain of blocks in a slot, one step further in), and
functions (a body of its own, for what runs at the same time).
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..program import Block
from .expressions import Expressions, whole
from .printing import show


@dataclass(frozen=True, slots=True)
class Body:
    """The chain of blocks in a slot; CPython limits how deep those of a ``loop`` are nested."""

    slot: str
    loop: bool = False


@dataclass(frozen=True, slots=True)
class Function:
    """A function without arguments whose body is the chain of blocks in a slot."""

    name: str
    slot: str


@dataclass(frozen=True, slots=True)
class Assignment:
    """A line that assigns to a variable of the whole program."""

    variable: str
    line: str


@dataclass(frozen=True, slots=True)
class Gap:
    """An empty line, to keep apart what does not belong together."""


Piece = str | Body | Function | Assignment | Gap
StatementGenerator = Callable[[Expressions, Block], Sequence[Piece]]

_NO_ARGUMENTS = ast.arguments([], [], None, [], [], None, [])


def _wait_until(code: Expressions, block: Block) -> list[Piece]:
    condition = ast.Lambda(_NO_ARGUMENTS, code.slot(block, "condition"))
    return [show(code.api_call("wait_until", condition))]


def _repeat(code: Expressions, block: Block) -> list[Piece]:
    times = whole(code.slot(block, "times"))
    return [f"for _ in range({show(times)}):", Body("do", loop=True)]


def _forever(code: Expressions, block: Block) -> list[Piece]:
    return ["while True:", Body("do", loop=True)]


def _while(code: Expressions, block: Block) -> list[Piece]:
    return [f"while {show(code.slot(block, 'condition'))}:", Body("do", loop=True)]


def _if(code: Expressions, block: Block) -> list[Piece]:
    pieces: list[Piece] = [f"if {show(code.slot(block, 'condition'))}:", Body("do")]
    for number in range(1, block.groups.get("also", 0) + 1):
        condition = show(code.slot(block, f"also_condition.{number}"))
        pieces += [f"elif {condition}:", Body(f"also_do.{number}")]
    if block.groups.get("otherwise"):
        pieces += ["else:", Body("otherwise_do.1")]
    return pieces


def _together(code: Expressions, block: Block) -> list[Piece]:
    count = block.groups.get("part", 0)
    functions = [Function(code.part_name(), f"do.{number}") for number in range(1, count + 1)]
    started = code.api_call("together", *(ast.Name(function.name) for function in functions))
    return [*functions, Gap(), show(started)]


def _set_variable(code: Expressions, block: Block) -> list[Piece]:
    name = code.variable(block)
    return [Assignment(name, f"{name} = {show(code.slot(block, 'value'))}")]


def _change_variable(code: Expressions, block: Block) -> list[Piece]:
    name = code.variable(block)
    return [Assignment(name, f"{name} += {show(code.slot(block, 'amount'))}")]


STATEMENTS: dict[str, StatementGenerator] = {
    "wait_until": _wait_until,
    "repeat": _repeat,
    "forever": _forever,
    "while": _while,
    "if": _if,
    "together": _together,
    "set_variable": _set_variable,
    "change_variable": _change_variable,
}
