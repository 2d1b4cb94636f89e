"""The generator functions of reporters and booleans that are more than one call."""

from __future__ import annotations

import ast

from ..program import Block
from .expressions import Expressions, ValueGenerator
from .list_words import LIST_REPORTERS
from .nodes import whole
from .number_words import NUMBER_REPORTERS
from .own_blocks import OWN_REPORTERS

_OPERATIONS: dict[str, ast.operator] = {
    "add": ast.Add(),
    "subtract": ast.Sub(),
    "multiply": ast.Mult(),
    "divide": ast.Div(),
    "power": ast.Pow(),
    "remainder": ast.Mod(),
    "floor_divide": ast.FloorDiv(),
}
_COMPARISONS: dict[str, ast.cmpop] = {
    "equal": ast.Eq(),
    "not_equal": ast.NotEq(),
    "less": ast.Lt(),
    "less_or_equal": ast.LtE(),
    "greater": ast.Gt(),
    "greater_or_equal": ast.GtE(),
}


def _number(code: Expressions, block: Block) -> ast.expr:
    return code.slot(block, "number")


def _text(code: Expressions, block: Block) -> ast.expr:
    return code.slot(block, "text")


def _variable(code: Expressions, block: Block) -> ast.expr:
    return ast.Name(code.variable(block))


def _arithmetic(code: Expressions, block: Block) -> ast.expr:
    operation = _OPERATIONS[code.choice(block, "operation")]
    return ast.BinOp(code.slot(block, "a"), operation, code.slot(block, "b"))


def _random_integer(code: Expressions, block: Block) -> ast.expr:
    low, high = whole(code.slot(block, "low")), whole(code.slot(block, "high"))
    return code.module_call("random", "randint", low, high)


def _join(code: Expressions, block: Block) -> ast.expr:
    items = code.slots(block, "item", "item")
    joined = items[0]
    for item in items[1:]:
        joined = ast.BinOp(joined, ast.Add(), item)
    return joined


def _compare(code: Expressions, block: Block) -> ast.expr:
    sign = _COMPARISONS[code.choice(block, "comparison")]
    return ast.Compare(code.slot(block, "a"), [sign], [code.slot(block, "b")])


def _junction(code: Expressions, block: Block) -> ast.expr:
    word = ast.And() if code.choice(block, "junction") == "and" else ast.Or()
    values = [code.slot(block, "a"), code.slot(block, "b"), *code.slots(block, "c", "more")]
    return ast.BoolOp(word, values)


def _not(code: Expressions, block: Block) -> ast.expr:
    return ast.UnaryOp(ast.Not(), code.slot(block, "a"))


def _truth(code: Expressions, block: Block) -> ast.expr:
    return ast.Constant(code.choice(block, "truth") == "true")


def _human_state_is(code: Expressions, block: Block) -> ast.expr:
    return ast.Compare(code.api_call("human_state"), [ast.Eq()], [code.slot(block, "state")])


REPORTERS: dict[str, ValueGenerator] = {
    "number": _number,
    "text": _text,
    "variable": _variable,
    "arithmetic": _arithmetic,
    "random_integer": _random_integer,
    "join": _join,
    "compare": _compare,
    "junction": _junction,
    "not": _not,
    "truth": _truth,
    "human_state_is": _human_state_is,
    **LIST_REPORTERS,
    **NUMBER_REPORTERS,
    **OWN_REPORTERS,
}
