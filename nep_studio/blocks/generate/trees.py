"""The generator functions of the parts of behaviour trees."""

from __future__ import annotations

import ast

from nep_studio.blocks.program import Block

from .expressions import Body, Expressions, Function, Piece, StatementGenerator, show

_NO_ARGUMENTS = ast.arguments([], [], None, [], [], None, [])
_YES = ast.Constant(True)
_ORDERS: dict[str, dict[str, ast.expr]] = {
    "memory": {},
    "reactive": {"reactive": _YES},
    "keeps": {"keeps_place": _YES},
}
_OUTCOMES = {"invert": "Invert", "success": "ForceSuccess", "failure": "ForceFailure"}


def _later(value: ast.expr) -> ast.expr:
    """A value that is worked out each time that the tree looks."""
    return ast.Lambda(_NO_ARGUMENTS, value)


def _number(code: Expressions, block: Block, key: str) -> ast.expr:
    """A number, or what gives it each time that the part begins."""
    number = code.slot(block, key)
    return number if isinstance(number, ast.Constant) else _later(number)


def _around(made: ast.expr, slot: str = "do") -> list[Piece]:
    """A part with others in it."""
    return [f"with {show(made)}:", Body(slot, is_with=True)]


def _in_order(part: str) -> StatementGenerator:
    """The generator of a part that asks those in it in their order."""
    return lambda code, block: _around(code.api_call(part, **_ORDERS[code.choice(block, "order")]))


def _with_limit(part: str, key: str) -> StatementGenerator:
    """The generator of a part that may have a number."""

    def generate(code: Expressions, block: Block) -> list[Piece]:
        limit = [_number(code, block, f"{key}.1")] if block.groups.get("limit") else []
        return _around(code.api_call(part, *limit))

    return generate


def _timed(part: str) -> StatementGenerator:
    """The generator of a part that has a time."""
    return lambda code, block: _around(code.api_call(part, _number(code, block, "seconds")))


def _while(code: Expressions, block: Block) -> list[Piece]:
    return _around(code.api_call("WhileTrue", _later(code.slot(block, "condition"))))


def _instead(code: Expressions, block: Block) -> list[Piece]:
    return _around(code.api_call(_OUTCOMES[code.choice(block, "outcome")]))


def _check(code: Expressions, block: Block) -> list[Piece]:
    return [show(code.api_call("Check", _later(code.slot(block, "condition"))))]


def _step(code: Expressions, block: Block) -> list[Piece]:
    decorator = show(code.api_call("Step", code.slot(block, "name")))
    return [Function(code.part_name(code.text(block, "name")), "do", f"@{decorator}")]


def _sub_tree(code: Expressions, block: Block) -> list[Piece]:
    made = code.api_call("SubTree", code.slot(block, "name"))
    return _around(made, "ports.1") if block.groups.get("ports") else [show(made)]


def _input(code: Expressions, block: Block) -> list[Piece]:
    value = _later(code.slot(block, "value"))
    return [show(code.api_call("Input", code.slot(block, "key"), value))]


def _output(code: Expressions, block: Block) -> list[Piece]:
    names = code.slot(block, "key"), code.slot(block, "ours")
    return [show(code.api_call("Output", *names))]


TREE_PARTS: dict[str, StatementGenerator] = {
    "tree_sequence": _in_order("Sequence"),
    "tree_fallback": _in_order("Fallback"),
    "tree_parallel": _with_limit("Parallel", "enough"),
    "tree_while": _while,
    "tree_retry": _with_limit("Retry", "times"),
    "tree_repeat": _with_limit("Repeat", "times"),
    "tree_time_limit": _timed("TimeLimit"),
    "tree_cool_down": _timed("CoolDown"),
    "tree_delay": _timed("Delay"),
    "tree_instead": _instead,
    "tree_check": _check,
    "tree_step": _step,
    "tree_sub_tree": _sub_tree,
    "tree_input": _input,
    "tree_output": _output,
}
