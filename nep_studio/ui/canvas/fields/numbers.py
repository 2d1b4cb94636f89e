"""Numbers as people type them into a field, and one step up or down from them."""

from __future__ import annotations

import math
import re
from decimal import Decimal

from nep_studio.blocks.arithmetic import ArithmeticRefused, calculate, number_of

_PLAIN = re.compile(r"[+-]?(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+)")


def is_number(text: str) -> bool:
    """Whether a text is one number, not arithmetic."""
    return _PLAIN.fullmatch(text.strip()) is not None


def typed_number(text: str) -> int | float | str:
    """The number that a text is; what is arithmetic (or nothing) stays a text.

    Both a point and a comma are taken for the decimal sign.
    """
    plain = text.strip().replace("−", "-")  # noqa: RUF001 the minus sign that some keyboards give
    if not is_number(plain):
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


def result_text(text: str) -> str:
    """What arithmetic comes to, as "= 2.094"; empty for a plain number, or for no arithmetic."""
    if is_number(text) or not text.strip():
        return ""
    try:
        value = calculate(text).value
    except ArithmeticRefused:
        return ""
    return f"= {value:.4g}" if isinstance(value, float) else f"= {value}"


def stepped(value: object, steps: int) -> int | float:
    """A number so many ones higher or lower, without the dust of binary fractions."""
    try:
        number = number_of(value)
    except (ArithmeticRefused, TypeError):
        number = 0
    moved = Decimal(repr(number)) + steps
    return int(moved) if moved == moved.to_integral_value() else float(moved)
