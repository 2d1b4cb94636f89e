"""Reads lists that a program in Python or C++ fills with numbers and texts, without running it."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Iterator
from typing import Any

Value = float | str | list[Any]

ROLE_NAMES = ("names", "times", "keys")
ROLES = {
    "names": "names",
    "jointnames": "names",
    "times": "times",
    "timelist": "times",
    "timelists": "times",
    "keys": "keys",
    "angles": "keys",
    "anglelist": "keys",
    "anglelists": "keys",
}
"""What lists of this name (in small letters) mean."""

CALLS = {
    "angleInterpolation": ("names", "keys", "times"),
    "angleInterpolationBezier": ("names", "times", "keys"),
}
"""What the arguments of NAOqi's calls mean, however the lists are named."""

CONSTANTS = {"pi": math.pi, "TO_RAD": math.pi / 180.0, "True": 1.0, "False": 0.0}
OPERATIONS: dict[type[ast.operator], Any] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
OPEN, CLOSED, ENDS = frozenset("(["), frozenset(")]"), frozenset("{};")
PARTS = re.compile(
    r""" "(?:[^"\\\n]|\\.)*" | '(?:[^'\\\n]|\\.)*' | (?:\#|//)[^\n]* | . | \n """, re.X
)
"""Texts in quotes, comments, and all other letters one by one."""
LONGEST_LIST = 100_000


class _Unknown(Exception):
    """Something that is neither a number, nor a text, nor a list of these."""


def movement_lists(text: str) -> list[tuple[Value, Value, Value]]:
    """Return the (names, times, keys) of each movement in a program, in their order."""
    lists = _Lists()
    for statement in _statements(text):
        lists.take(statement)
    return lists.movements()


class _Lists:
    """The lists of a program so far."""

    def __init__(self) -> None:
        self._values: dict[str, Value] = {}
        self._found: list[tuple[Value, Value, Value]] = []

    def movements(self) -> list[tuple[Value, Value, Value]]:
        self._close()
        return self._found

    def take(self, statement: str) -> None:
        """Follow one statement; what cannot fill a list is passed over."""
        try:
            (node,) = ast.parse(statement).body
            self._follow(node)
        except (SyntaxError, ValueError, RecursionError, MemoryError, _Unknown, ArithmeticError):
            return

    def _follow(self, node: ast.stmt) -> None:
        match node:
            case ast.Assign(targets=[ast.Subscript() as place], value=value):
                self._put(place, self._value(value))
            case ast.Assign(targets=[target], value=value):
                self._assign(_name(target), self._value(value))
            case ast.Expr(value=ast.Call(func=ast.Attribute(attr=call), args=arguments)) if (
                call in CALLS and len(arguments) >= 3
            ):
                self._use(dict(zip(CALLS[call], map(self._value, arguments), strict=False)))
            case ast.Expr(
                value=ast.Call(
                    func=ast.Attribute(value=target, attr="append" | "push_back"), args=[value]
                )
            ):
                self._row(_name(target)).append(self._value(value))

    def _assign(self, name: str, value: Value) -> None:
        if name == "names":
            self._close()
        self._values[name] = value

    def _use(self, lists: dict[str, Value]) -> None:
        """Take the lists that a call plays; names of its own make it another movement."""
        if isinstance(lists["names"], str):
            lists = {role: [value] for role, value in lists.items()}
        if lists["names"] is not self._values.get("names"):
            self._close()
        self._values |= lists

    def _close(self) -> None:
        """The movement so far is complete: new names begin another one."""
        names, times, keys = (self._values.get(role) for role in ROLE_NAMES)
        if names and times and keys:
            self._found.append((names, times, keys))
            for role in ROLE_NAMES:
                del self._values[role]

    def _row(self, name: str) -> list[Any]:
        row = self._values.setdefault(name, [])
        if not isinstance(row, list):
            raise _Unknown
        return row

    def _put(self, place: ast.Subscript, value: Value) -> None:
        """Follow ``times[0][1] = 0.8``, as in C++; rows grow as they are filled."""
        path, target = [], place.value
        path.append(_index(place.slice))
        while isinstance(target, ast.Subscript):
            path.insert(0, _index(target.slice))
            target = target.value
        row = self._row(_name(target))
        for step in path[:-1]:
            row = _cell(row, step)
        _cell(row, path[-1])
        row[path[-1]] = value

    def _value(self, node: ast.expr) -> Value:
        match node:
            case ast.Constant(value=str() as text):
                return text
            case ast.Constant(value=int() | float() as number):
                return float(number)
            case ast.List(elts=parts) | ast.Tuple(elts=parts):
                return [self._value(part) for part in parts]
            case ast.UnaryOp(op=ast.USub() | ast.UAdd() as sign, operand=inner):
                number = self._number(inner)
                return -number if isinstance(sign, ast.USub) else number
            case ast.BinOp(left=left, op=operation, right=right) if type(operation) in OPERATIONS:
                first, second = self._number(left), self._number(right)
                return float(OPERATIONS[type(operation)](first, second))
            case ast.Call(func=ast.Name(id="list"), args=[]):
                return []
            case ast.Call(func=ast.Name(id="array"), args=parts):
                return [self._value(part) for part in parts]
            case ast.Name() | ast.Attribute():
                return self._known(node)
        raise _Unknown

    def _known(self, node: ast.Name | ast.Attribute) -> Value:
        name = node.id if isinstance(node, ast.Name) else node.attr
        if name in CONSTANTS:
            return CONSTANTS[name]
        if (value := self._values.get(_name(node))) is not None:
            return value
        raise _Unknown

    def _number(self, node: ast.expr) -> float:
        value = self._value(node)
        if not isinstance(value, float):
            raise _Unknown
        return value


def _name(node: ast.expr) -> str:
    """A list's role, or else its name; ``self.names`` is ``names``."""
    match node:
        case ast.Name(id=name) | ast.Attribute(value=ast.Name(id="self"), attr=name):
            return ROLES.get(name.casefold(), name)
    raise _Unknown


def _index(node: ast.expr) -> int:
    match node:
        case ast.Constant(value=int() as index) if 0 <= index < LONGEST_LIST:
            return index
    raise _Unknown


def _cell(row: list[Any], index: int) -> Any:
    if not isinstance(row, list):
        raise _Unknown
    while len(row) <= index:
        row.append([])
    return row[index]


def _statements(text: str) -> Iterator[str]:
    """The statements of a program in Python or C++, one by one, without their comments."""
    depth, words = 0, ""
    for part in PARTS.findall(text.replace("AL::ALValue::array", "array")):
        depth = max(0, depth + (part in OPEN) - (part in CLOSED))
        if part in ENDS or (part == "\n" and depth == 0):
            yield words.strip()
            depth, words = 0, ""
        elif not part.startswith(("#", "//")):
            words += part
    yield words.strip()
