"""The values of docs/language.md and what is done with them: the reference interpreter's half.

Written from that page alone, and to be kept so.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from fractions import Fraction


class Table:
    """Keys with values, in the order of first setting."""

    def __init__(self) -> None:
        self.keys: list = []
        self.values: list = []

    def __len__(self) -> int:
        return len(self.keys)

    def place(self, key: Value) -> int | None:
        """Where a key is, or None."""
        if isinstance(key, list | Table):
            raise Wrong("no key")
        return next((n for n, one in enumerate(self.keys) if equal(one, key)), None)

    def at(self, key: Value) -> Value:
        found = self.place(key)
        if found is None:
            raise Wrong("nothing there")
        return self.values[found]

    def put(self, key: Value, value: Value) -> None:
        found = self.place(key)
        if found is None:
            self.keys.append(key)
            self.values.append(value)
        else:
            self.values[found] = value

    def remove(self, key: Value) -> None:
        found = self.place(key)
        if found is None:
            raise Wrong("nothing there")
        del self.keys[found], self.values[found]

    def copy(self) -> Table:
        other = Table()
        other.keys, other.values = list(self.keys), list(self.values)
        return other


Value = int | float | str | bool | list | Table

MOST_STEPS = 4_000
MOST_CALLS = 40
LARGEST = 1e290
CLOSE = 1e-9


class Wrong(Exception):
    """What the page calls an error."""


class GivenUp(Exception):
    """The program takes too long, or its numbers get too large, to be judged."""


# Values

WORDS = {
    "en": ("true", "false", " and ", ", ", "."),
    "de": ("wahr", "falsch", " und ", ", ", ","),
    "es": ("verdadero", "falso", " y ", ", ", ","),
    "fr": ("vrai", "faux", " et ", ", ", ","),
    "it": ("vero", "falso", " e ", ", ", ","),
    "ja": ("真", "偽", " と ", ", ", "."),
}


spoken = ["en"]
"""The language of the program that is run."""


def told(value: Value) -> str:
    """A value as a text."""
    if isinstance(value, list | Table):
        _require_small(value)
    true, false, last, between, mark = WORDS[spoken[0]]
    if isinstance(value, bool):
        return true if value else false
    if isinstance(value, str):
        return value
    if isinstance(value, list):
        items = [told(item) for item in value]
        return last.join([between.join(items[:-1]), items[-1]]) if items[1:] else "".join(items)
    if isinstance(value, Table):
        entries = zip(value.keys, value.values, strict=True)
        return ", ".join(f"{told(key)}: {told(held)}" for key, held in entries)
    return _digits(value).replace(".", mark)


def _digits(value: float) -> str:
    if isinstance(value, int) or value == int(value):
        return str(int(value))
    rounded = float(f"{value:.11e}")
    if not 1e-6 <= abs(rounded) < 1e16:
        mantissa, exponent = f"{rounded:.11e}".split("e")
        mantissa = mantissa.rstrip("0").rstrip(".")
        return f"{mantissa}e{exponent}"
    places = max(0, 11 - math.floor(math.log10(abs(rounded))))
    text = f"{rounded:.{places}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def is_yes(value: Value) -> bool:
    """Whether a value counts as yes in a condition."""
    if isinstance(value, bool):
        return value
    return len(value) > 0 if isinstance(value, str | list | Table) else value != 0


def kind(value: Value) -> str:
    if isinstance(value, bool):
        return "truth"
    return {str: "text", list: "list", Table: "table"}.get(type(value), "number")


def _require_small(value: list | Table) -> None:
    """Give up on what is in each other so often that nobody can go through it."""
    left, seen = [value], 0
    while left:
        found = left.pop()
        items = found.values if isinstance(found, Table) else found
        seen += len(items)
        if seen > MOST_STEPS:
            raise GivenUp
        left += [item for item in items if isinstance(item, list | Table)]


def equal(one: Value, other: Value) -> bool:
    if isinstance(one, list | Table) and kind(one) == kind(other):
        _require_small(one)
    if kind(one) != kind(other):
        return False
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(equal, one, other))
    if isinstance(one, Table) and isinstance(other, Table):
        places = [other.place(key) for key in one.keys]
        return len(one) == len(other) and all(
            place is not None and equal(held, other.values[place])
            for held, place in zip(one.values, places, strict=True)
        )
    return one == other


def number(value: Value) -> int | float:
    if kind(value) != "number":
        raise Wrong("a number is needed")
    if isinstance(value, float) and not math.isfinite(value):
        raise GivenUp
    if abs(value) > LARGEST:  # type: ignore[arg-type]
        raise GivenUp
    return value  # type: ignore[return-value]


def whole(value: Value) -> int:
    if number(value) != math.floor(number(value)):
        raise Wrong("a whole number is needed")
    return int(number(value))


def rounded(value: Value) -> int:
    """The nearest whole number; a half goes away from zero."""
    exact = Fraction(number(value))
    nearest = math.floor(abs(exact) + Fraction(1, 2))
    return nearest if exact >= 0 else -nearest


def items_of(value: Value) -> list:
    if not isinstance(value, list):
        raise Wrong("a list is needed")
    return value


def table(value: Value) -> Table:
    if not isinstance(value, Table):
        raise Wrong("a table is needed")
    return value


def numbers_of(value: Value) -> list[int | float]:
    return [number(item) for item in items_of(value)]


def place(value: Value, end: str, length: int) -> int:
    """The index of a place that must be there."""
    wanted = whole(value)
    if not 1 <= wanted <= length:
        raise Wrong("no such place")
    return wanted - 1 if end == "start" else length - wanted


# Operations


def _power(a: int | float, b: int | float) -> int | float:
    if a == 0 and b < 0:
        raise Wrong("divided by zero")
    if a < 0 and b != math.floor(b):
        raise Wrong("no real number")
    if isinstance(a, int) and isinstance(b, int) and b >= 0:
        if b > 3 and abs(a) > 1 and b * math.log10(abs(a)) >= 1000:
            raise Wrong("too many digits")
        return a**b
    try:
        return float(a) ** float(b) if b != math.floor(b) or isinstance(b, float) else a**b
    except OverflowError:
        raise Wrong("too large") from None


def divisor_of(b: int | float) -> int | float:
    if b == 0:
        raise Wrong("divided by zero")
    return b


ARITHMETIC: dict[str, Callable[[int | float, int | float], int | float]] = {
    "add": lambda a, b: a + b,
    "subtract": lambda a, b: a - b,
    "multiply": lambda a, b: a * b,
    "divide": lambda a, b: a / divisor_of(b),
    "power": _power,
    "remainder": lambda a, b: a % divisor_of(b),
    "floor_divide": lambda a, b: a // divisor_of(b),
}
PROPERTIES: dict[str, Callable[[int | float], bool]] = {
    "even": lambda n: n % 2 == 0,
    "odd": lambda n: n % 2 == 1,
    "whole": lambda n: n == math.floor(n),
    "positive": lambda n: n > 0,
    "negative": lambda n: n < 0,
}


def _logarithm(function: Callable[[float], float]) -> Callable[[int | float], float]:
    def logarithm(n: int | float) -> float:
        if n <= 0:
            raise Wrong("no logarithm")
        return function(n)

    return logarithm


def _root(n: int | float) -> float:
    if n < 0:
        raise Wrong("no root")
    return math.sqrt(n)


def _exponential(n: int | float) -> float:
    if n > 700:
        raise GivenUp
    return math.exp(n)


FUNCTIONS: dict[str, Callable[[int | float], int | float]] = {
    "absolute": abs,
    "root": _root,
    "minus": lambda n: -n,
    "ln": _logarithm(math.log),
    "log10": _logarithm(math.log10),
    "exp": _exponential,
    "pow10": lambda n: _power(10, n),
}


def _mean(items: list[int | float]) -> int | float:
    if not items:
        raise Wrong("no items")
    mean = sum(map(Fraction, items), Fraction(0)) / len(items)
    return int(mean) if mean.denominator == 1 else float(mean)


def _median(items: list[int | float]) -> int | float:
    if not items:
        raise Wrong("no items")
    ordered = sorted(items)
    middle = len(ordered) // 2
    return ordered[middle] if len(ordered) % 2 else (ordered[middle - 1] + ordered[middle]) / 2


def _deviation(items: list[int | float]) -> float:
    if len(items) < 2:
        raise Wrong("too few items")
    mean = sum(map(Fraction, items), Fraction(0)) / len(items)
    squares = sum(((Fraction(item) - mean) ** 2 for item in items), Fraction(0))
    return math.sqrt(squares / (len(items) - 1))


def _extreme(choose: Callable[[list[int | float]], int | float]) -> Callable[..., int | float]:
    def extreme(items: list[int | float]) -> int | float:
        if not items:
            raise Wrong("no items")
        return choose(items)

    return extreme


OF_LIST: dict[str, Callable[[list[int | float]], int | float]] = {
    "sum": sum,
    "min": _extreme(min),
    "max": _extreme(max),
    "mean": _mean,
    "median": _median,
    "stdev": _deviation,
}

_NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?")


def number_in(text: str) -> int | float:
    written = text.strip()
    if _NUMBER.fullmatch(written) is None:
        raise Wrong("no number")
    if written.lstrip("+-").isdigit():
        if len(written.lstrip("+-0")) > 1000:
            raise Wrong("too many digits")
        return int(written)
    found = float(written.replace(",", "."))
    if not math.isfinite(found):
        raise GivenUp
    return int(found) if found == int(found) else found


def less(a: Value, b: Value) -> bool:
    if kind(a) != kind(b) or kind(a) not in ("number", "text"):
        raise Wrong("not to be compared")
    return a < b  # type: ignore[operator]


COMPARISONS: dict[str, Callable[[Value, Value], bool]] = {
    "equal": equal,
    "not_equal": lambda a, b: not equal(a, b),
    "less": less,
    "less_or_equal": lambda a, b: less(a, b) or a == b,
    "greater": lambda a, b: less(b, a),
    "greater_or_equal": lambda a, b: less(b, a) or a == b,
}
