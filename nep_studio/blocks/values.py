"""What a field may hold: checked when a file is loaded and each time a field is set."""

from __future__ import annotations

import keyword
import re
import unicodedata
from collections.abc import Callable, Mapping
from datetime import date

from .arithmetic import LARGEST_NUMBER, ArithmeticRefused, calculate, number_of

Setting = str | int | float | bool
FieldValue = str | int | float | bool | dict[str, Setting]

LONGEST_TEXT = 10_000
LONGEST_NAME = 100
MOST_SETTINGS = 100
_HALF = re.compile("[\ud800-\udfff]")
_JOINERS = "\u200c\u200d"
_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")


def why_not_value(kind_name: str, value: object) -> str | None:
    """Why a field of this kind cannot hold ``value``, as a sentence, or None when it can."""
    return _CHECKS[kind_name](value)


def why_not_name(value: object) -> str | None:
    """Why ``value`` cannot be the name of a project, a variable, a robot or a node."""
    reason = why_not_line(value)
    if reason is not None:
        return reason
    if not str(value).strip():
        return "A name needs at least one letter."
    if len(str(value)) > LONGEST_NAME:
        return f"A name has at most {LONGEST_NAME} letters."
    return None


def why_not_line(value: object) -> str | None:
    """Why ``value`` is not one line of visible text."""
    reason = why_not_text(value)
    if reason is None and not all(map(_is_visible, str(value))):
        return "This text must be one line, without control characters."
    return reason


def _is_visible(letter: str) -> bool:
    """Whether a letter may be in a line: Japanese has its own space, Persian and emoji join."""
    return letter.isprintable() or letter in _JOINERS or unicodedata.category(letter) == "Zs"


def why_not_text(value: object) -> str | None:
    """Why ``value`` is not a text that can be saved and printed."""
    if not isinstance(value, str):
        return f"A text is needed here, not {_told(value)}."
    if len(value) > LONGEST_TEXT:
        return f"This text is too long: {len(value)} characters, {LONGEST_TEXT} at most."
    if _HALF.search(value):
        return "This text has half of a character in it (a lone surrogate), which no file can hold."
    return None


def why_not_number(value: object) -> str | None:
    """Why ``value`` is not a number that a program can use."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return f"A number is needed here, not {_told(value)}."
    if value != value:  # not a number; math.isnan fails for large integers
        return "This number is not a number that can be counted with."
    if abs(value) > LARGEST_NUMBER:
        return f"This number is too large: {LARGEST_NUMBER:,} at most."
    return None


def why_not_quantity(value: object) -> str | None:
    """Why ``value`` is neither a number nor arithmetic that comes to one."""
    if not isinstance(value, str):
        return why_not_number(value)
    try:
        calculate(value)
    except ArithmeticRefused as refused:
        return str(refused)
    return None


def why_not_between(value: object, low: float, high: float) -> str | None:
    """Why a number, or what arithmetic comes to, is not between two others."""
    reason = why_not_quantity(value)
    if reason is None and not low <= number_of(value) <= high:
        return f"This number must be from {low:g} to {high:g}."
    return reason


def _why_not_duration(value: object) -> str | None:
    reason = why_not_quantity(value)
    if reason is None and number_of(value) < 0:
        return "A time cannot be less than 0 seconds."
    return reason


def _why_not_date(value: object) -> str | None:
    try:
        if isinstance(value, str) and len(value) == 10 and date.fromisoformat(value):
            return None
    except ValueError:
        pass
    return f"A date is written like 2026-01-31, not {_told(value)}."


def _why_not_checked(value: object) -> str | None:
    return None if isinstance(value, bool) else f"This is on or off, not {_told(value)}."


def _why_not_any(value: object) -> str | None:
    return why_not_text(value) if isinstance(value, str) else why_not_number(value)


def _why_not_colour(value: object) -> str | None:
    if isinstance(value, str) and _COLOUR.fullmatch(value):
        return None
    return f"A colour is written like #ff8800, not {_told(value)}."


def _why_not_settings(value: object) -> str | None:
    if not isinstance(value, Mapping):
        return f"Settings are a list of names with values, not {_told(value)}."
    if len(value) > MOST_SETTINGS:
        return f"There are too many settings: {len(value)}, {MOST_SETTINGS} at most."
    for name, setting in value.items():
        reason = _why_not_setting(name, setting)
        if reason is not None:
            return reason
    return None


def _why_not_setting(name: object, setting: object) -> str | None:
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,99}", name):
        return f"A setting's name is one word of letters, digits and _, not {_told(name)}."
    if keyword.iskeyword(name) or name in ("node", "name"):
        return f"A setting cannot be called “{name}”."
    if isinstance(setting, bool):
        return None
    return _why_not_any(setting)


def _told(value: object) -> str:
    """Name a value of any kind in a few words, whatever it holds."""
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return "yes or no"
    if isinstance(value, int | float):
        return f"the number {value}" if abs(value) <= LARGEST_NUMBER else "a very large number"
    if isinstance(value, str):
        return f"the text {value[:40]!a}"
    return "a list or a group of values"


_CHECKS: dict[str, Callable[[object], str | None]] = {
    "number": why_not_quantity,
    "angle": why_not_quantity,
    "slider": why_not_quantity,
    "duration": _why_not_duration,
    "text": why_not_text,
    "lines": why_not_text,
    "date": _why_not_date,
    "file": why_not_line,
    "checkbox": _why_not_checked,
    "any": _why_not_any,
    "line": why_not_line,
    "state": why_not_line,
    "gesture": why_not_line,
    "robot": why_not_line,
    "variable": why_not_line,
    "colour": _why_not_colour,
    "choice": why_not_line,
    "settings": _why_not_settings,
}
