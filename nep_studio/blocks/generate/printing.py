"""Print an expression tree as one line of Python.

Only the nodes that blocks make are known. ``ast.parse(show(node))`` gives ``node`` again: that is
a property test, and the reason why no text of a user can become code. ``ast.unparse`` is several
times slower and prefers single quotes.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Callable

_LAMBDA, _OR, _AND, _NOT, _COMPARE, _SUM, _TERM, _SIGN, _POWER, _ATOM, _TARGET = range(11)

_BINARY: dict[type[ast.operator], tuple[str, int]] = {
    ast.Add: (" + ", _SUM),
    ast.Sub: (" - ", _SUM),
    ast.Mult: (" * ", _TERM),
    ast.Div: (" / ", _TERM),
    ast.FloorDiv: (" // ", _TERM),
    ast.Mod: (" % ", _TERM),
    ast.Pow: (" ** ", _POWER),
}
_COMPARISON: dict[type[ast.cmpop], str] = {
    ast.Eq: " == ",
    ast.NotEq: " != ",
    ast.Lt: " < ",
    ast.LtE: " <= ",
    ast.Gt: " > ",
    ast.GtE: " >= ",
    ast.In: " in ",
    ast.NotIn: " not in ",
}


class Verbatim(ast.expr):
    """Python that a person wrote, printed as it is; ``is_closed`` needs no parentheses."""

    def __init__(self, text: str, *, is_closed: bool) -> None:
        super().__init__()
        self.text = text
        self.is_closed = is_closed


def show(node: ast.expr, least: int = _LAMBDA) -> str:
    """Print an expression; it is put in parentheses when it binds weaker than ``least``."""
    text, strength = _PRINTERS[type(node)](node)
    return text if strength >= least else f"({text})"


def literal(value: object) -> str:
    """Print a constant; texts in double quotes unless that takes more escapes.

    ``repr`` escapes whatever is not printable: line breaks of every kind, control characters,
    marks that turn the direction of writing, and halves of characters.
    """
    text = repr(value)
    if text[0] == "'" and '"' not in text:
        return f'"{text[1:-1]}"'
    return text


def _constant(node: ast.Constant) -> tuple[str, int]:
    value = node.value
    if isinstance(value, int | float) and (not math.isfinite(value) or math.copysign(1, value) < 0):
        raise ValueError(f"{value} must be written with a sign of its own")
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return literal(value), _ATOM if is_number else _TARGET  # a dot after a number is its point


def _name(node: ast.Name) -> tuple[str, int]:
    return node.id, _TARGET


def _attribute(node: ast.Attribute) -> tuple[str, int]:
    return f"{show(node.value, _TARGET)}.{node.attr}", _TARGET


def _call(node: ast.Call) -> tuple[str, int]:
    arguments = [show(argument) for argument in node.args]
    arguments += [f"{keyword.arg}={show(keyword.value)}" for keyword in node.keywords]
    return f"{show(node.func, _TARGET)}({', '.join(arguments)})", _TARGET


def _list(node: ast.List) -> tuple[str, int]:
    return f"[{', '.join(map(show, node.elts))}]", _TARGET


def _binary(node: ast.BinOp) -> tuple[str, int]:
    sign, strength = _BINARY[type(node.op)]
    if strength == _POWER:  # binds to the right, and a sign may stand right of it
        return f"{show(node.left, _ATOM)}{sign}{show(node.right, _SIGN)}", _POWER
    return f"{show(node.left, strength)}{sign}{show(node.right, strength + 1)}", strength


def _unary(node: ast.UnaryOp) -> tuple[str, int]:
    if isinstance(node.op, ast.Not):
        return f"not {show(node.operand, _NOT)}", _NOT
    return f"-{show(node.operand, _SIGN)}", _SIGN


def _junction(node: ast.BoolOp) -> tuple[str, int]:
    word, strength = (" and ", _AND) if isinstance(node.op, ast.And) else (" or ", _OR)
    return word.join([show(value, strength + 1) for value in node.values]), strength


def _compare(node: ast.Compare) -> tuple[str, int]:
    text = show(node.left, _SUM)
    for sign, right in zip(node.ops, node.comparators, strict=True):
        text += _COMPARISON[type(sign)] + show(right, _SUM)
    return text, _COMPARE


def _lambda(node: ast.Lambda) -> tuple[str, int]:
    return f"lambda: {show(node.body)}", _LAMBDA


def _choose(node: ast.IfExp) -> tuple[str, int]:
    test, body = show(node.test, _OR), show(node.body, _OR)
    return f"{body} if {test} else {show(node.orelse)}", _LAMBDA


def _subscript(node: ast.Subscript) -> tuple[str, int]:
    return f"{show(node.value, _TARGET)}[{show(node.slice)}]", _TARGET


def _slice(node: ast.Slice) -> tuple[str, int]:
    low = show(node.lower) if node.lower is not None else ""
    high = show(node.upper) if node.upper is not None else ""
    return f"{low}:{high}", _LAMBDA


def _verbatim(node: Verbatim) -> tuple[str, int]:
    return node.text, _TARGET if node.is_closed else _LAMBDA


_PRINTERS: dict[type[ast.expr], Callable[..., tuple[str, int]]] = {
    ast.Constant: _constant,
    ast.Name: _name,
    ast.Attribute: _attribute,
    ast.Call: _call,
    ast.List: _list,
    ast.BinOp: _binary,
    ast.UnaryOp: _unary,
    ast.BoolOp: _junction,
    ast.Compare: _compare,
    ast.Lambda: _lambda,
    ast.IfExp: _choose,
    ast.Subscript: _subscript,
    ast.Slice: _slice,
    Verbatim: _verbatim,
}
