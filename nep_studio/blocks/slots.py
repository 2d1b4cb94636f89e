"""The kinds of slot: how each is drawn, which values may be plugged in, why one is refused."""

from __future__ import annotations

import keyword
import re
import unicodedata
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import date
from typing import Literal

from faults import Text, text_of

from .arithmetic import LARGEST_NUMBER, ArithmeticRefused, calculate, number_of

SlotShape = Literal["round", "square", "hexagon", "bracket", "pill", "mouth"]
"""The outline of a slot and of what goes in: number, text, yes or no, list, others, a body."""


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of slot: what it is called, which block results fit, what a person can type in it.

    ``fits`` are the result types of blocks that may be plugged in; ``typed`` says that the slot
    has a field (a default value that comes back when the plugged block leaves).
    """

    name: str
    noun: str
    shape: SlotShape = "pill"
    fits: frozenset[str] = frozenset()
    typed: bool = True

    @property
    def pluggable(self) -> bool:
        """Whether a reporter block may be put into the slot."""
        return bool(self.fits)


RESULTS = {
    "number": "a number",
    "text": "a text",
    "boolean": "yes or no",
    "list": "a list",
    "colour": "a colour",
    "any": "any value",
}
"""What a reporter gives; ``any`` is known only while the program runs (a variable)."""

RESULT_SHAPES: dict[str, SlotShape] = {
    "number": "round",
    "text": "square",
    "boolean": "hexagon",
    "list": "bracket",
    "colour": "pill",
    "any": "pill",
}
"""The outline of a block that gives such a result."""

_NUMBERS = frozenset({"number", "any"})
_ALL = frozenset(RESULTS)

KINDS: dict[str, Kind] = {
    kind.name: kind
    for kind in (
        Kind("number", "a number", "round", _NUMBERS),
        Kind("angle", "an angle in degrees", "round", _NUMBERS),
        Kind("slider", "a number", "round", _NUMBERS),
        Kind("duration", "a time in seconds", "round", _NUMBERS),
        Kind("text", "a text", "square", _ALL),  # what is no text is written out by str()
        Kind("lines", "a text of several lines", "square", _ALL),
        Kind("line", "one line of text", "square"),
        Kind("date", "a date", "square"),
        Kind("file", "a file", "square"),
        Kind("boolean", "a yes-or-no question", "hexagon", frozenset({"boolean", "any"}), False),
        Kind("list", "a list", "bracket", frozenset({"list", "any"}), False),
        Kind("any", "a value", "pill", _ALL),
        Kind("colour", "a colour", "pill", frozenset({"colour", "any"})),
        Kind("checkbox", "on or off"),
        Kind("state", "a human state"),
        Kind("gesture", "a gesture"),
        Kind("robot", "a robot"),
        Kind("variable", "a variable"),
        Kind("choice", "one of a list"),
        Kind("settings", "a list of settings"),
        Kind("parameter", "a value of this block", typed=False),
        Kind("body", "blocks", "mouth", typed=False),
    )
}


def why_not_fit(kind: Kind, result: str, block_name: str) -> Text | None:
    """Why a block whose result is ``result`` cannot be plugged into a slot, or None when it can."""
    if result in kind.fits:
        return None
    if not kind.pluggable:
        return text_of(
            "This place takes {noun} that is chosen or typed, not a block.", noun=Text(kind.noun)
        )
    return text_of(
        "This place needs {noun}, and “{block_name}” gives {result}.",
        noun=Text(kind.noun),
        block_name=block_name,
        result=Text(RESULTS[result]),
    )


# What a field may hold: checked when a file is loaded and each time a field is set.

Setting = str | int | float | bool
FieldValue = str | int | float | bool | dict[str, Setting]

LONGEST_TEXT = 10_000
LONGEST_NAME = 100
MOST_SETTINGS = 100
_HALF = re.compile("[\ud800-\udfff]")
_JOINERS = "\u200c\u200d"
_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")


def why_not_value(kind_name: str, value: object) -> Text | None:
    """Why a field of this kind cannot hold ``value``, as a sentence, or None when it can."""
    return _CHECKS[kind_name](value)


def why_not_name(value: object) -> Text | None:
    """Why ``value`` cannot be the name of a project, a variable, a robot or a node."""
    reason = why_not_line(value)
    if reason is not None:
        return reason
    if not str(value).strip():
        return Text("A name needs at least one letter.")
    if len(str(value)) > LONGEST_NAME:
        return text_of("A name has at most {longest_name} letters.", longest_name=LONGEST_NAME)
    return None


def why_not_line(value: object) -> Text | None:
    """Why ``value`` is not one line of visible text."""
    reason = why_not_text(value)
    if reason is None and not all(map(_is_visible, str(value))):
        return Text("This text must be one line, without control characters.")
    return reason


def _is_visible(letter: str) -> bool:
    """Whether a letter may be in a line: Japanese has its own space, Persian and emoji join."""
    return letter.isprintable() or letter in _JOINERS or unicodedata.category(letter) == "Zs"


def why_not_text(value: object) -> Text | None:
    """Why ``value`` is not a text that can be saved and printed."""
    if not isinstance(value, str):
        return text_of("A text is needed here, not {told}.", told=_told(value))
    if len(value) > LONGEST_TEXT:
        return text_of(
            "This text is too long: {count} characters, {longest_text} at most.",
            count=len(value),
            longest_text=LONGEST_TEXT,
        )
    if _HALF.search(value):
        return Text(
            "This text has half of a character in it (a lone surrogate), which no file can hold."
        )
    return None


def why_not_number(value: object) -> Text | None:
    """Why ``value`` is not a number that a program can use."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return text_of("A number is needed here, not {told}.", told=_told(value))
    if value != value:  # not a number; math.isnan fails for large integers
        return Text("This number is not a number that can be counted with.")
    if abs(value) > LARGEST_NUMBER:
        return text_of(
            "This number is too large: {largest_number} at most.",
            largest_number=f"{LARGEST_NUMBER:,}",
        )
    return None


def why_not_quantity(value: object) -> Text | None:
    """Why ``value`` is neither a number nor arithmetic that comes to one."""
    if not isinstance(value, str):
        return why_not_number(value)
    try:
        calculate(value)
    except ArithmeticRefused as refused:
        return refused.sentence
    return None


def why_not_between(value: object, low: float, high: float) -> Text | None:
    """Why a number, or what arithmetic comes to, is not between two others."""
    reason = why_not_quantity(value)
    if reason is None and not low <= number_of(value) <= high:
        return text_of(
            "This number must be from {low} to {high}.", low=f"{low:g}", high=f"{high:g}"
        )
    return reason


def _why_not_duration(value: object) -> Text | None:
    reason = why_not_quantity(value)
    if reason is None and number_of(value) < 0:
        return Text("A time cannot be less than 0 seconds.")
    return reason


def _why_not_date(value: object) -> Text | None:
    try:
        if isinstance(value, str) and len(value) == 10 and date.fromisoformat(value):
            return None
    except ValueError:
        pass
    return text_of("A date is written like 2026-01-31, not {told}.", told=_told(value))


def _why_not_checked(value: object) -> Text | None:
    if isinstance(value, bool):
        return None
    return text_of("This is on or off, not {told}.", told=_told(value))


def _why_not_any(value: object) -> Text | None:
    return why_not_text(value) if isinstance(value, str) else why_not_number(value)


def _why_not_colour(value: object) -> Text | None:
    if isinstance(value, str) and _COLOUR.fullmatch(value):
        return None
    return text_of("A colour is written like #ff8800, not {told}.", told=_told(value))


def _why_not_settings(value: object) -> Text | None:
    if not isinstance(value, Mapping):
        return text_of("Settings are a list of names with values, not {told}.", told=_told(value))
    if len(value) > MOST_SETTINGS:
        return text_of(
            "There are too many settings: {count}, {most_settings} at most.",
            count=len(value),
            most_settings=MOST_SETTINGS,
        )
    for name, setting in value.items():
        reason = _why_not_setting(name, setting)
        if reason is not None:
            return reason
    return None


def _why_not_setting(name: object, setting: object) -> Text | None:
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,99}", name):
        return text_of(
            "A setting's name is one word of letters, digits and _, not {told}.", told=_told(name)
        )
    if keyword.iskeyword(name) or name in ("node", "name"):
        return text_of("A setting cannot be called “{name}”.", name=name)
    if isinstance(setting, bool):
        return None
    return _why_not_any(setting)


def _told(value: object) -> Text:
    """Name a value of any kind in a few words, whatever it holds."""
    if value is None:
        return Text("nothing")
    if isinstance(value, bool):
        return Text("yes or no")
    if isinstance(value, int | float):
        is_large = abs(value) > LARGEST_NUMBER
        return (
            Text("a very large number") if is_large else text_of("the number {value}", value=value)
        )
    if isinstance(value, str):
        return text_of("the text {value}", value=f"{value[:40]!a}")
    return Text("a list or a group of values")


_CHECKS: dict[str, Callable[[object], Text | None]] = {
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
