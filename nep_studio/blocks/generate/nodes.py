"""Expression trees that blocks make often: constants, calls, whole numbers."""

from __future__ import annotations

import ast
import math
from collections.abc import Mapping

from ..values import FieldValue


def constant(value: FieldValue | None) -> ast.expr:
    """A constant of a field; a negative number is a sign and a number, or ``**`` binds wrongly."""
    if isinstance(value, int | float) and math.copysign(1, value) < 0:
        return ast.UnaryOp(ast.USub(), ast.Constant(-value))
    if value is None or isinstance(value, dict):
        raise TypeError(f"a field of kind {type(value).__name__} is no constant")
    return ast.Constant(value)


def call(name: str, /, *arguments: ast.expr, **keywords: ast.expr) -> ast.Call:
    """A call of a function by its name."""
    return ast.Call(ast.Name(name), list(arguments), _keywords(keywords))


def method_call(
    target: ast.expr,
    method: str,
    arguments: list[ast.expr] | None = None,
    keywords: Mapping[str, ast.expr] | None = None,
) -> ast.Call:
    """A call of a method."""
    return ast.Call(ast.Attribute(target, method), arguments or [], _keywords(keywords or {}))


def whole(node: ast.expr) -> ast.expr:
    """Make sure that a number is whole: what is not known to be goes through int()."""
    return node if is_whole(node) else call("int", node)


def is_whole(node: ast.expr) -> bool:
    """Whether an expression is known to give a whole number."""
    match node:
        case ast.Constant(value=value):
            return type(value) is int
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return is_whole(operand)
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() | ast.Mult(), right=right):
            return is_whole(left) and is_whole(right)
        case ast.Call(func=ast.Attribute(value=ast.Name(id="random"), attr="randint")):
            return True
        case ast.Call(func=ast.Attribute(value=ast.Name(id="math"), attr="floor" | "ceil")):
            return True
        case ast.Call(func=ast.Name(id="len" | "int" | "round"), args=[_]):
            return True
    return False


def known_whole(node: ast.expr) -> int | None:
    """The whole number that an expression is, when it is written there as such."""
    match node:
        case ast.Constant(value=int(value)) if type(value) is int:
            return value
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int(value))):
            return -value
    return None


def plus(node: ast.expr, number: int) -> ast.expr:
    """A whole number with another added or taken away, as short as it can be."""
    known = known_whole(node)
    if known is not None:
        return constant(known + number)
    sign = ast.Add() if number > 0 else ast.Sub()
    return ast.BinOp(node, sign, ast.Constant(abs(number))) if number else node


def compare(left: ast.expr, sign: ast.cmpop, right: ast.expr) -> ast.Compare:
    """A comparison of two values."""
    return ast.Compare(left, [sign], [right])


def _keywords(keywords: Mapping[str, ast.expr]) -> list[ast.keyword]:
    return [ast.keyword(name, value) for name, value in keywords.items()]
