"""Texts behind each other in Python: f-strings, and sums of texts, which say the same."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from ..generate.kinds import NUMBER, are, kinds_of
from .naming import within

TOLD = ("as_text", "str")
"""The functions that tell a value as a text."""

_AS_STR = ord("s")
"""The conversion of what Python's str() tells, or of a text: not what a block tells."""


def as_joined(node: object, *, knows_texts: bool = False) -> object:
    """A sum of texts, or an f-string, in one form: letters that stand together are one constant.

    Python need not show that a sum is one of texts where the other side ``knows_texts``.
    """
    if not isinstance(node, ast.BinOp | ast.JoinedStr):
        return node
    parts = list(_parts(node))
    is_shown = any(map(_is_text, parts))
    if isinstance(node, ast.BinOp) and not is_shown and not knows_texts:
        return node
    values: list[ast.expr] = []
    for part in (inner for one in parts for inner in _values(one)):
        last = values[-1] if values else None
        if isinstance(part, ast.Constant) and isinstance(last, ast.Constant):
            values[-1] = ast.Constant(str(last.value) + str(part.value))
        elif not isinstance(part, ast.Constant) or part.value:
            values.append(part)
    is_typed = all(isinstance(value, ast.Constant) for value in values)
    if is_typed and isinstance(node, ast.JoinedStr):
        return values[0] if values else ast.Constant("")
    return ast.JoinedStr(values)


def told_in_braces(
    ours: ast.FormattedValue, theirs: ast.FormattedValue
) -> list[tuple[object, object]]:
    """What must be the same of two values in f-strings, the first in a person's Python.

    Braces mean a value as blocks tell it, whatever Python would tell; str() does of a number, and
    of all else means what it says.
    """
    if ours.conversion == _AS_STR and not is_number(ours.value):
        return [(ours.value, theirs.value)]
    pairs: list[tuple[object, object]] = [(within(ours.value, TOLD), within(theirs.value, TOLD))]
    if not {ours.conversion, theirs.conversion} <= {-1, _AS_STR}:
        pairs.append((ours.conversion, theirs.conversion))
    return [*pairs, (ours.format_spec, theirs.format_spec)]


def is_number(node: ast.expr) -> bool:
    """Whether a value is surely a number."""
    kinds = kinds_of(node)
    return bool(kinds) and are(kinds, NUMBER)


def _parts(node: ast.expr) -> Iterator[ast.expr]:
    """What a sum is made of, from left to right, without recursion: sums are nested to the left."""
    right: list[ast.expr] = []
    while isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        right.append(node.right)
        node = node.left
    yield node
    yield from reversed(right)


def _is_text(node: ast.expr) -> bool:
    """Whether Python shows by itself that a value is a text: then a sum with it is one."""
    is_typed = isinstance(node, ast.Constant) and isinstance(node.value, str)
    return is_typed or isinstance(node, ast.JoinedStr) or within(node, TOLD) is not node


def _values(node: ast.expr) -> list[ast.expr]:
    """A text as parts of an f-string."""
    match node:
        case ast.JoinedStr(values=values) | ast.FormattedValue(
            ast.JoinedStr(values=values), -1, None
        ):
            return [inner for value in values for inner in _values(value)]
        case ast.Constant(value=str()) | ast.FormattedValue():
            return [node]
    inner = within(node, TOLD)
    is_block = inner is not node and within(node, ("as_text",)) is inner
    return [ast.FormattedValue(inner, -1 if is_block else _AS_STR)]
