"""The generator functions of hats: what a rule waits for, and what its function is called."""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass

from ..procedures import parameters, procedure_of
from ..program import Block
from .expressions import Expressions
from .nodes import method_call


@dataclass(frozen=True, slots=True)
class Hat:
    """The decorator of a rule's function, and a text from which the function gets its name.

    The function of an own block has no decorator, but ``arguments``.
    """

    decorator: ast.expr | None
    name: str
    arguments: tuple[str, ...] = ()


HatGenerator = Callable[[Expressions, Block], Hat]


def _when_started(code: Expressions, block: Block) -> Hat:
    return Hat(ast.Attribute(ast.Name("behavior"), "when_started"), "when_started")


def _when_gesture(code: Expressions, block: Block) -> Hat:
    return _when(code, block, "gesture")


def _when_human_state(code: Expressions, block: Block) -> Hat:
    return _when(code, block, "state")


def _when(code: Expressions, block: Block, key: str) -> Hat:
    state = code.slot(block, key)
    again = code.choice(block, "again")
    keywords: dict[str, ast.expr] = {} if again == "ignore" else {"again": ast.Constant(again)}
    decorator = method_call(ast.Name("behavior"), "when", [state], keywords)
    word = str(code.definition(block).value(block, key))
    return Hat(decorator, f"when_{key}_{word}" if key == "gesture" else f"when_{word}")


def _own_define(code: Expressions, block: Block) -> Hat:
    procedure = code.project.procedures[procedure_of(block.type)]
    given = [f"{procedure.id}.{parameter.id}" for parameter in parameters(procedure)]
    arguments = [code.names.parameters[key] for key in given]
    return Hat(None, code.names.procedures[procedure.id], tuple(arguments))


HATS: dict[str, HatGenerator] = {
    "when_started": _when_started,
    "when_gesture": _when_gesture,
    "when_human_state": _when_human_state,
    "own_define": _own_define,
}
