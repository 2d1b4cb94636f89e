"""Movements out of Choregraphe: the text that it exports, read without being executed.

Choregraphe writes a timeline as Python or C++: lists of joint names, of key times and of angles,
with or without Bezier handles ("simplified export", "bezier export").
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from faults import Words
from robots.errors import RobotError

from .keyframes import SHORTEST_STEP_S, Handle, Keyframes, Track

# Reads lists that a program in Python or C++ fills with numbers and texts, without running it.

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


class _Lists:
    """The lists of a program so far."""

    def __init__(self) -> None:
        self._values: dict[str, Value] = {}
        self._found: list[tuple[Value, Value, Value]] = []

    def movements(self) -> list[tuple[Value, Value, Value]]:
        """The (names, times, keys) of each movement, in their order."""
        self._close()
        return self._found

    def take(self, statement: str) -> None:
        """Follow one statement; what cannot fill a list is passed over."""
        try:
            (node,) = ast.parse(statement).body
            match node:
                case ast.Assign(targets=[ast.Subscript() as place], value=value):
                    self._put(place, self._value(value))
                case ast.Assign(targets=[target], value=value):
                    name, assigned = _name(target), self._value(value)
                    if name == "names":
                        self._close()
                    self._values[name] = assigned
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
        except (SyntaxError, ValueError, RecursionError, MemoryError, _Unknown, ArithmeticError):
            return

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
        path, target = [_index(place.slice)], place.value
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
            case ast.Call(func=ast.Name(id="list"), args=[]):
                return []
            case (
                ast.List(elts=parts)
                | ast.Tuple(elts=parts)
                | ast.Call(func=ast.Name(id="array"), args=parts)
            ):
                return [self._value(part) for part in parts]
            case ast.UnaryOp(op=ast.USub() | ast.UAdd() as sign, operand=inner):
                number = self._number(inner)
                return -number if isinstance(sign, ast.USub) else number
            case ast.BinOp(left=left, op=operation, right=right) if type(operation) in OPERATIONS:
                first, second = self._number(left), self._number(right)
                return float(OPERATIONS[type(operation)](first, second))
            case ast.Name(id=name) | ast.Attribute(attr=name):
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


LONGEST_TEXT = 2_000_000
EXPORTING = (
    "In Choregraphe, right-click in the timeline and export the motion to Python or C++.",
    "Copy the whole text, from the first joint to the last, and nothing else.",
)
NO_HANDLE: Handle = (0.0, 0.0, 0.0, 0.0)


class KeyframesUnreadable(RobotError):
    """A text that holds no movement, or one that cannot be used."""

    title = "This text holds no movement that can be read"

    def __init__(
        self, sentence: Words, /, *, checklist: Sequence[Words] = EXPORTING, **values: Any
    ) -> None:
        super().__init__(sentence, checklist=checklist, **values)


def read_choregraphe(text: str) -> Keyframes:
    """Return the movement in a text that Choregraphe exported. Raises KeyframesUnreadable."""
    if len(text) > LONGEST_TEXT:
        raise KeyframesUnreadable(
            "The text is too long for a movement: it has more than 2 million letters.",
        )
    lists = _Lists()
    for statement in _statements(text):
        lists.take(statement)
    found = lists.movements()
    if not found:
        raise KeyframesUnreadable("The text has no joint names, times and keys in it.")
    if len(found) > 1:
        raise KeyframesUnreadable(
            "The text has {count} movements in it; one at a time can be read.",
            count=len(found),
        )
    names, times, keys = found[0]
    return _keyframes(_rows(names), _rows(times), _rows(keys))


def _keyframes(names: list[Value], times: list[Value], keys: list[Value]) -> Keyframes:
    if not len(names) == len(times) == len(keys) or not names:
        raise KeyframesUnreadable(
            "The text has {count} joint names, but {count_2} lists of times and {count_3} lists of "
            "keys.",
            count=len(names),
            count_2=len(times),
            count_3=len(keys),
        )
    tracks: dict[str, Track] = {}
    for name, joint_times, joint_keys in zip(names, times, keys, strict=True):
        if not isinstance(name, str) or not name:
            raise KeyframesUnreadable("A joint's name is not a text in quotes.")
        if name in tracks:
            raise KeyframesUnreadable("{name} is there twice.", name=name)
        tracks[name] = _track(name, _rows(joint_times), _rows(joint_keys))
    return Keyframes(tracks)


def _track(name: str, times: list[Value], keys: list[Value]) -> Track:
    if len(times) != len(keys) or not keys:
        raise KeyframesUnreadable(
            "{name} has {count} times for {count_2} keys.",
            name=name,
            count=len(times),
            count_2=len(keys),
        )
    seconds = tuple(_number(name, time) for time in times)
    if seconds[0] < 0.0 or any(b - a < SHORTEST_STEP_S - 1e-9 for a, b in pairwise(seconds)):
        raise KeyframesUnreadable(
            "The times of {name} do not rise by {shortest_step_s} s or more.",
            name=name,
            shortest_step_s=SHORTEST_STEP_S,
        )
    read = [_key(name, key) for key in keys]
    handles = tuple(handle or NO_HANDLE for _, handle in read)
    has_handles = any(handle for _, handle in read)
    # A movement begins where the robot is: a key at 0 s is reached a moment later
    late = max(0.0, SHORTEST_STEP_S - seconds[0])
    later, angles = tuple(time + late for time in seconds), tuple(angle for angle, _ in read)
    return Track(later, angles, handles if has_handles else None)


def _key(name: str, key: Value) -> tuple[float, Handle | None]:
    """A key's angle and its handles: 0.3, [0.3], or [0.3, [3, -0.2, 0.0], [3, 0.2, 0.0]]."""
    match key:
        case [angle, [_, *before], [_, *after]] if len(before) == len(after) == 2:
            before_s, before_rad, after_s, after_rad = (_number(name, n) for n in before + after)
            return _number(name, angle), (before_s, before_rad, after_s, after_rad)
        case [angle] | (float() | str() as angle):
            return _number(name, angle), None
    raise KeyframesUnreadable(
        "A key of {name} is neither an angle nor an angle with two handles.",
        name=name,
    )


def _number(name: str, value: Value) -> float:
    if isinstance(value, float) and math.isfinite(value):
        return value
    raise KeyframesUnreadable("One of the numbers of {name} cannot be read.", name=name)


def _rows(value: Value) -> list[Value]:
    return value if isinstance(value, list) else [value]
