"""Arithmetic typed into a number field, such as 2*pi/3: its value, and its tree for the code.

Known are numbers, + - * / // % **, parentheses, pi, e, tau and a few functions; angles of sin, cos
and tan are in radians, as in Python. Each step of a calculation is kept small, so that no text,
however hostile, takes long here or in the program.
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from functools import lru_cache

from faults import Text, text_of

from .errors import BlocksError

LONGEST_ARITHMETIC = 200
DEEPEST_ARITHMETIC = 25
LARGEST_NUMBER = 10**15
_LARGEST_BITS = 60

Number = int | float

_TOKEN = re.compile(
    r"\s+|[A-Za-z_][A-Za-z_0-9]*|(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?(?![A-Za-z0-9_.])"
    r"|\*\*|//|[-+*/%(),]"
)
_SIGNS = str.maketrans({"×": "*", "·": "*", "÷": "/", "−": "-", "^": "**", "π": "pi", "τ": "tau"})  # noqa: RUF001 signs that people type
_CONSTANTS = {"pi": math.pi, "e": math.e, "tau": math.tau}
_OF_MATH: dict[str, Callable[[float], float]] = {
    "sqrt": math.sqrt,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
}


def _power(a: Number, b: Number) -> Number:
    """A power whose size is looked at before it is calculated."""
    if a and abs(b) * abs(math.log2(abs(a))) > _LARGEST_BITS:
        raise ArithmeticRefused("This power is too large or too small.")
    value = a**b
    if isinstance(value, complex):
        raise ArithmeticRefused("A root of a negative number is no number on the number line.")
    return value


_OPERATIONS: dict[type[ast.operator], Callable[[Number, Number], Number]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: _power,
}


class ArithmeticRefused(BlocksError):
    """A text that cannot be calculated."""


@dataclass(frozen=True, slots=True)
class Arithmetic:
    """What a text comes to, the tree that says so in Python, and whether it needs ``math``."""

    value: Number
    node: ast.expr
    needs_math: bool


@lru_cache(maxsize=4096)
def calculate(text: str) -> Arithmetic:
    """Read and calculate a text, or raise ArithmeticRefused."""
    if len(text) > LONGEST_ARITHMETIC:
        raise ArithmeticRefused(
            "This is too long: {longest_arithmetic} signs at most.",
            longest_arithmetic=LONGEST_ARITHMETIC,
        )
    plain = text.translate(_SIGNS).strip()
    if not plain:
        raise ArithmeticRefused("A number is needed here.")
    # Python warns of “2pi”, and of much else: only signs of arithmetic reach it
    position = 0
    while position < len(plain):
        token = _TOKEN.match(plain, position)
        if token is None or not token[0].isascii():
            raise ArithmeticRefused(_not_understood(plain))
        position = token.end()
    if "\n" in plain or "\r" in plain:
        raise ArithmeticRefused("A number is written on one line.")
    try:
        value, node = _read(ast.parse(plain, mode="eval").body, 0)
    except (SyntaxError, RecursionError, MemoryError) as error:
        raise ArithmeticRefused(_not_understood(text)) from error
    except (ArithmeticError, ValueError) as error:
        raise ArithmeticRefused("“{text}” cannot be calculated.", text=text) from error
    return Arithmetic(value, node, any(isinstance(n, ast.Attribute) for n in ast.walk(node)))


def number_of(value: object) -> Number:
    """The number that a field holds: itself, or what its text comes to."""
    if isinstance(value, str):
        return calculate(value).value
    if isinstance(value, int | float):
        return value
    raise TypeError(f"{type(value).__name__} is no number")


def _not_understood(text: str) -> Text:
    shown = text if len(text) <= 40 else text[:39] + "…"
    return text_of("{shown} is not a number, nor arithmetic such as 2*pi/3.", shown=repr(shown))


def _read(node: ast.expr, depth: int) -> tuple[Number, ast.expr]:
    """The value of a part, and a clean tree of it; SyntaxError when it is no arithmetic."""
    if depth > DEEPEST_ARITHMETIC:
        raise ArithmeticRefused("There are too many parentheses in each other.")
    match node:
        case ast.Constant(value=int(value) | float(value)) if not isinstance(value, bool):
            return _small(value), ast.Constant(value)
        case ast.Name(id=name) if name in _CONSTANTS:
            return _CONSTANTS[name], ast.Attribute(ast.Name("math"), name)
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return _read(operand, depth + 1)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            value, inner = _read(operand, depth + 1)
            return -value, ast.UnaryOp(ast.USub(), inner)
        case ast.BinOp(left=left, op=sign, right=right):
            (a, first), (b, second) = _read(left, depth + 1), _read(right, depth + 1)
            if type(sign) not in _OPERATIONS:
                raise SyntaxError(f"no sign of arithmetic: {sign}")
            return _small(_OPERATIONS[type(sign)](a, b)), ast.BinOp(first, sign, second)
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
            return _call(name, [_read(argument, depth + 1) for argument in arguments])
    raise SyntaxError("this is no arithmetic")


def _call(name: str, read: list[tuple[Number, ast.expr]]) -> tuple[Number, ast.expr]:
    values, nodes = [value for value, _ in read], [node for _, node in read]
    function: ast.expr = ast.Name(name)
    if name in ("min", "max") and len(values) >= 2:
        value = min(values) if name == "min" else max(values)
    elif len(values) == 1 and name in ("abs", "round"):
        value = abs(values[0]) if name == "abs" else round(values[0])
    elif len(values) == 1 and name in _OF_MATH:
        value, function = _OF_MATH[name](values[0]), ast.Attribute(ast.Name("math"), name)
    else:
        raise SyntaxError(f"no function of arithmetic: {name}")
    return _small(value), ast.Call(function, nodes, [])


def _small(value: Number) -> Number:
    if value != value or abs(value) > LARGEST_NUMBER:
        raise ArithmeticRefused(
            "This number is too large: {largest_number} at most.",
            largest_number=f"{LARGEST_NUMBER:,}",
        )
    return value


# Numbers as people type them into a field.

_PLAIN = re.compile(r"[+-]?(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+)")


def is_number_text(text: str) -> bool:
    """Whether a text is one number, not arithmetic."""
    return _PLAIN.fullmatch(text.strip()) is not None


def typed_number(text: str) -> Number | str:
    """The number that a text is; what is arithmetic (or nothing) stays a text.

    Both a point and a comma are taken for the decimal sign.
    """
    plain = text.strip().replace("−", "-")  # noqa: RUF001 the minus sign that some keyboards give
    if not is_number_text(plain):
        return text.strip()
    plain = plain.replace(",", ".")
    number = float(plain)
    if "." in plain and not number.is_integer():
        return number
    return int(Decimal(plain)) if math.isfinite(number) else number


def number_text(value: object) -> str:
    """A number as a person would write it."""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return "" if value is None else str(value)
