"""The generator functions of facts, of what own blocks need, and of what is to be reached.

A fact is a name, and as many values as its block has. What is wanted are facts that are plugged in.
In Python each of these blocks is one call, whose arguments are the fact.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping

from nep_studio.blocks.program import Block

from .expressions import Expressions, Piece, StatementGenerator, ValueGenerator, show

TASK_LINES = ("needs", "makes_true", "makes_untrue")
"""The statements by which an own block says what it is for, to who plans with it."""

_NO_ARGUMENTS = ast.arguments([], [], None, [], [], None, [])


def _fact(function: str) -> ValueGenerator:
    """The generator of a call of nep_core with the fact of a block."""
    return lambda code, block: code.api_call(function, *_fact_of(code, block))


def _fact_of(code: Expressions, block: Block) -> list[ast.expr]:
    return [code.slot(block, "fact"), *code.slots(block, "value", "of")]


def _wanted(function: str) -> ValueGenerator:
    """The generator of a call of nep_core with the facts that are wanted."""
    return lambda code, block: code.api_call(
        function, code.slot(block, "goal"), *code.slots(block, "more_goal", "more")
    )


def _line_of(value: ValueGenerator) -> StatementGenerator:
    """The generator of a statement that is a call alone."""
    return lambda code, block: [show(value(code, block))]


def _true_while(code: Expressions, block: Block) -> list[Piece]:
    """The condition is asked each time, and so is a function; the values are worked out once."""
    fact, condition = _fact_of(code, block), code.slot(block, "condition")
    return [show(code.api_call("true_while", ast.Lambda(_NO_ARGUMENTS, condition), *fact))]


FACT_VALUES: Mapping[str, ValueGenerator] = {
    "fact": _fact("fact"),
    "is_true": _fact("is_true"),
    "the_plan": _wanted("the_plan"),
}
FACT_LINES: Mapping[str, StatementGenerator] = {
    **{name: _line_of(_fact(name)) for name in ("now_true", "no_longer_true", *TASK_LINES)},
    "reach": _line_of(_wanted("reach")),
    "true_while": _true_while,
}
