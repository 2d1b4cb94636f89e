"""Places as Python counts them, from 0: item i + 1 of names is names[i] where i is not below 0.

From below 0 Python counts from the end, which no block means: there a function of nep_core counts.
"""

from __future__ import annotations

import ast

from nep_studio.blocks.slots import constant

from .expressions import known_whole
from .kinds import NATURAL, NUMBER, POSITIVE, are, kinds_of, note


def one_more(node: ast.expr) -> ast.expr:
    """A whole number and 1, without sums of numbers in it."""
    return _moved(node, 1)


def one_less(node: ast.expr) -> ast.expr:
    """A whole number less 1, without sums of numbers in it."""
    return _moved(node, -1)


def index_of(number: ast.expr, of: ast.expr) -> ast.expr | None:
    """Where Python has the item of this number; None where it might count from the end.

    An empty list has none at ``len(names) - 1`` either; but another list may have one there.
    """
    whole = known_whole(number)
    if whole is not None:
        return constant(whole - 1) if whole > 0 else None
    index = one_less(number)
    if is_length_of(number, of) or (kinds_of(number) and are(kinds_of(number), POSITIVE)):
        return index
    is_natural = bool(kinds_of(index)) and are(kinds_of(index), NATURAL)
    return index if is_natural else None


def _moved(node: ast.expr, by: int) -> ast.expr:
    whole = known_whole(node)
    if whole is not None:
        return constant(whole + by)
    first, more = node, by
    match node:
        case ast.BinOp(left, ast.Add() | ast.Sub() as sign, ast.Constant(value=int(added))) if (
            type(added) is int
        ):
            first, more = left, by + (added if isinstance(sign, ast.Add) else -added)
    if more == 0:
        return first
    operator = ast.Add() if more > 0 else ast.Sub()
    moved = ast.BinOp(first, operator, constant(abs(more)))
    if not are(kinds_of(moved), NUMBER):
        note(moved, NUMBER)  # the place of a number makes it one
    return moved


def is_length_of(number: ast.expr, of: ast.expr) -> bool:
    """Whether a number is the length of a value with a name, or of one that is typed."""
    match number:
        case ast.Call(func=ast.Name(id="len" | "length_of"), args=[inner]):
            return isinstance(of, ast.Name) and ast.dump(inner) == ast.dump(of)
    return False
