"""The kinds of slot: what fits into each, what a person can type there, how it becomes Python.

A kind of field is one object of `KINDS`. Whoever shows, checks, reads or writes a field asks the
kind of its slot; nobody else has a table of kinds but the canvas, for the editors of those that
are not typed in a line (`EDITORS` of `ui/canvas/fields/editors.py`).
"""

from __future__ import annotations

import ast
import keyword
import math
import re
import unicodedata
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Literal

from faults import Text, text_of

from .arithmetic import (
    LARGEST_NUMBER,
    ArithmeticRefused,
    calculate,
    is_number_text,
    number_of,
    number_text,
    typed_number,
)
from .errors import BlocksError

SlotShape = Literal["round", "square", "hexagon", "bracket", "pill", "mouth"]
"""The outline of a slot and of what goes in: number, text, yes or no, list, others, a body."""

Mark = Literal["", "dial", "bar", "tick", "swatch"]
"""What is drawn in a field: beside its text, behind it, or in its place."""

Setting = str | int | float | bool
FieldValue = str | int | float | bool | dict[str, Setting]

LONGEST_TEXT = 10_000
LONGEST_NAME = 100
MOST_SETTINGS = 100
GESTURE_STATE = "gesture_"
"""What the state begins with that a recogniser tells of a gesture."""
ARM_STATE = "arm_"
"""What the state begins with that tells how the arm that wears a watch is held."""

RESULTS = {
    "number": "a number",
    "text": "a text",
    "boolean": "yes or no",
    "list": "a list",
    "table": "a table",
    "colour": "a colour",
    "robot": "a robot",
    "any": "any value",
}
"""What a reporter gives; ``any`` is known only while the program runs (a variable)."""

COLOURS = (
    ("red", "#ff0000"),
    ("orange", "#ff8800"),
    ("yellow", "#ffdd00"),
    ("lime", "#88dd00"),
    ("green", "#00aa00"),
    ("mint", "#00ddaa"),
    ("cyan", "#00dddd"),
    ("sky blue", "#00aaff"),
    ("blue", "#0044ff"),
    ("violet", "#7700ff"),
    ("magenta", "#ff00ff"),
    ("pink", "#ff66aa"),
    ("dark red", "#880000"),
    ("brown", "#884400"),
    ("olive", "#666600"),
    ("dark green", "#005500"),
    ("teal", "#006677"),
    ("navy", "#000088"),
    ("white", "#ffffff"),
    ("light grey", "#cccccc"),
    ("grey", "#888888"),
    ("dark grey", "#444444"),
    ("black", "#000000"),
    ("cream", "#ffeecc"),
)
"""The colours that have a name; the window has it in its own words."""

NAMES_OF_COLOURS = {code: name for name, code in COLOURS}


def nearest_colour(code: str) -> str:
    """The name of the colour that looks most like one such as "#3060ff"; what is none stays."""
    if _why_not_colour(code) is not None:
        return code
    wanted = _as_seen(code)
    return min(COLOURS, key=lambda one: math.dist(wanted, _as_seen(one[1])))[0]


@cache
def _as_seen(code: str) -> tuple[float, float, float]:
    """A colour of the screen in Oklab, where what looks alike is near: Björn Ottosson, 2020."""
    red, green, blue = (
        part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4
        for part in (number / 255 for number in bytes.fromhex(code[1:]))
    )
    long, medium, short = (
        (0.4122214708 * red + 0.5363325363 * green + 0.0514459929 * blue) ** (1 / 3),
        (0.2119034982 * red + 0.6806995451 * green + 0.1073969566 * blue) ** (1 / 3),
        (0.0883024619 * red + 0.2817188376 * green + 0.6299787005 * blue) ** (1 / 3),
    )
    return (
        0.2104542553 * long + 0.7936177850 * medium - 0.0040720468 * short,
        1.9779984951 * long - 2.4285922050 * medium + 0.4505937099 * short,
        0.0259040371 * long + 0.7827717662 * medium - 0.8086757660 * short,
    )


TEXT_RESULTS = frozenset({"text", "colour"})
"""What is a text already where one is needed."""

RESULT_SHAPES: dict[str, SlotShape] = {
    "number": "round",
    "text": "square",
    "boolean": "hexagon",
    "list": "bracket",
    "table": "bracket",
    "colour": "pill",
    "robot": "pill",
    "any": "pill",
}
"""The outline of a block that gives such a result."""


# What a field may hold: checked when a file is loaded and each time a field is set.

_HALF = re.compile("[\ud800-\udfff]")
JOINERS = "\u200c\u200d"
"""What cannot be seen, and is needed by Persian words and many emoji."""
_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")


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
    return letter.isprintable() or letter in JOINERS or unicodedata.category(letter) == "Zs"


def why_not_text(value: object) -> Text | None:
    """Why ``value`` is not a text that can be saved and printed."""
    if not isinstance(value, str):
        return text_of("A text is needed here, not {told}.", told=_described(value))
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
        return text_of("A number is needed here, not {told}.", told=_described(value))
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


_CLOCK = re.compile(r"(?:[01]?[0-9]|2[0-3]):[0-5][0-9]")


def _why_not_clock(value: object) -> Text | None:
    if isinstance(value, str) and _CLOCK.fullmatch(value):
        return None
    return text_of(
        "A time of the day is written like 09:30, from 00:00 to 23:59, not {told}.",
        told=_described(value),
    )


def _clock_time(typed: str) -> str:
    """A time with two digits for the hour, also when a point was typed."""
    text = typed.strip().replace(".", ":")
    return text.rjust(5, "0") if _CLOCK.fullmatch(text) else text


def _why_not_checked(value: object) -> Text | None:
    if isinstance(value, bool):
        return None
    return text_of("This is on or off, not {told}.", told=_described(value))


def _why_not_any(value: object) -> Text | None:
    return why_not_text(value) if isinstance(value, str) else why_not_number(value)


def _why_not_colour(value: object) -> Text | None:
    if isinstance(value, str) and _COLOUR.fullmatch(value):
        return None
    return text_of("A colour is written like #ff8800, not {told}.", told=_described(value))


def _why_not_settings(value: object) -> Text | None:
    if not isinstance(value, Mapping):
        return text_of(
            "Settings are a list of names with values, not {told}.", told=_described(value)
        )
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
            "A setting's name is one word of letters, digits and _, not {told}.",
            told=_described(name),
        )
    if keyword.iskeyword(name) or name in ("node", "name"):
        return text_of("A setting cannot be called “{name}”.", name=name)
    if isinstance(setting, bool):
        return None
    return _why_not_any(setting)


def _described(value: object) -> Text:
    """Name a value of any kind in a few words, whatever it holds."""
    match value:
        case None:
            return Text("nothing")
        case bool():
            return Text("yes or no")
        case int() | float() if abs(value) > LARGEST_NUMBER:
            return Text("a very large number")
        case int() | float():
            return text_of("the number {value}", value=value)
        case str():
            return text_of("the text {value}", value=f"{value[:40]!a}")
    return Text("a list or a group of values")


# What a kind is.

Read = Callable[[str], FieldValue]
Write = Callable[[object], str]
WhyNot = Callable[[object], Text | None]


def _written(value: object) -> str:
    return "" if value is None else str(value)


def _read_any(text: str) -> FieldValue:
    return typed_number(text) if is_number_text(text) else text


@dataclass(frozen=True, slots=True, eq=False)  # there is one of each
class Kind:
    """A kind of slot: what it is called, which block results fit, what a person can type in it.

    ``fits`` are the result types of blocks that may be plugged in, unless the slot is closed
    (``Slot.closed``); ``typed`` says that the slot
    has a field (a default value that comes back when the plugged block leaves). ``why_not`` says
    why a field cannot hold a value; ``read`` makes a value of what is typed, ``write`` a text of a
    value. ``constants`` are the types of Python's constants that a field can hold. ``noun``,
    ``hint`` and a ``unit`` of letters are English words, translated where they are shown.
    """

    name: str
    noun: str
    shape: SlotShape = "pill"
    fits: frozenset[str] = frozenset()
    why_not: WhyNot = why_not_line
    read: Read = str
    write: Write = _written
    typed: bool = True
    constants: tuple[type, ...] = (str,)
    """Empty for what stands in Python as a name."""
    prefix: str = ""
    """What Python has before the value."""
    of_nothing: Callable[[], ast.expr] | None = None
    """What a place without a field is in Python while it is empty."""
    words: Mapping[str, FieldValue] = field(default_factory=dict)
    """Words that mean a value, as people type them into the insert bar."""
    new: FieldValue | None = None
    """What the field of a new own block holds."""
    is_number: bool = False
    lowest: float = -math.inf
    table: str = ""
    """The table of choices that says how its values are called, in each language."""
    takes_any_words: bool = False
    """Whether a field may hold any word: a text, or a name that a person gives."""
    becomes_text: bool = False
    """Whether what is plugged in is written out by str() where it is no text."""
    missing: Text | None = None
    """What is said of an empty one that must not be empty."""
    advice: str = "Choose or type one."

    # How it looks

    hint: str = ""
    """What an empty one says of itself."""
    unit: str = ""
    """What stands behind the value, unless the sentence of the block says it there."""
    mark: Mark = ""
    opens: bool = False
    """Whether its value is chosen in a list or a window: it has an arrow."""
    has_lines: bool = False
    is_pressed: bool = False
    """Whether a press changes it: it needs no editor."""

    def to_python(self, value: FieldValue | None) -> ast.expr:
        """The expression of a field that stands for itself: no name, no arithmetic."""
        if self.of_nothing is not None:
            return self.of_nothing()
        return constant(f"{self.prefix}{value}" if self.prefix else value)

    def from_python(self, value: str | int | float | bool) -> FieldValue | None:
        """What a field holds so that it makes this constant, or None."""
        if type(value) not in self.constants:
            return None
        if not self.prefix:
            return value
        text = str(value)
        return text.removeprefix(self.prefix) if text.startswith(self.prefix) else None


def constant(value: FieldValue | None) -> ast.expr:
    """A constant of a field; a negative number is a sign and a number, or ``**`` binds wrongly."""
    if isinstance(value, int | float) and math.copysign(1, value) < 0:
        return ast.UnaryOp(ast.USub(), ast.Constant(-value))
    if value is None or isinstance(value, dict):
        raise TypeError(f"a field of kind {type(value).__name__} is no constant")
    return ast.Constant(value)


# The kinds.

_ALL = frozenset(RESULTS)
_WORDS = frozenset({"text", "any"})
"""What fits where a word is meant out of those that there are: they are looked up while it runs."""
_COLOUR_WORDS: dict[str, FieldValue] = {
    "red": "#ff0000",
    "green": "#00ff00",
    "blue": "#0000ff",
    "yellow": "#ffff00",
    "orange": "#ff8800",
    "purple": "#8800ff",
    "pink": "#ff66cc",
    "white": "#ffffff",
    "black": "#000000",
    "cyan": "#00ffff",
}
_SWITCH_WORDS: dict[str, FieldValue] = {"on": True, "off": False, "yes": True, "no": False}


_number = partial(
    Kind,
    shape="round",
    fits=frozenset({"number", "any"}),
    why_not=why_not_quantity,
    read=typed_number,
    write=number_text,
    constants=(int, float),
    new=0,
    is_number=True,
)
"""A kind of field that holds a number, or arithmetic that comes to one."""

_words = partial(
    Kind,
    shape="square",
    fits=_ALL,
    why_not=why_not_text,
    new="",
    takes_any_words=True,
    becomes_text=True,
    hint="text",
)
"""A kind of field that holds a text; what is plugged in and is no text is written out."""


def _message(typed: str) -> str:
    """The words of a message, as they are compared."""
    return " ".join(typed.split())


def _state(typed: str) -> str:
    """The state that a node tells of, of which people see the words."""
    return "_".join(typed.split())


def _name(
    name: str,
    noun: str,
    *,
    prefix: str = "",
    table: str = "",
    missing: bool = True,
    is_said: bool = True,
    read: Read = str,
    fits: frozenset[str] | None = None,
    new: FieldValue | None = None,
) -> Kind:
    """A kind of field that holds a name; one that is not ``is_said`` is a name in Python too.

    What is said in Python as it is may come from a block too.
    """
    is_open = is_said and not prefix
    told = text_of("{noun} is missing.", noun=Text(noun)) if missing else None
    return Kind(
        name,
        noun,
        fits=(_WORDS if is_open else frozenset()) if fits is None else fits,
        constants=(str,) if is_said else (),
        prefix=prefix,
        table=table,
        read=read,
        takes_any_words=missing,
        becomes_text=is_open,
        new=new,
        missing=told,
        hint=name,
        opens=True,
    )


KINDS: dict[str, Kind] = {
    kind.name: kind
    for kind in (
        _number("number", "a number", hint="number"),
        _number("angle", "an angle in degrees", hint="angle", unit="°", mark="dial"),
        _number("slider", "a number", mark="bar"),
        _number(
            "duration",
            "a time in seconds",
            hint="time",
            unit="s",
            why_not=_why_not_duration,
            lowest=0.0,
        ),
        _words("text", "a text"),
        _words("lines", "a text of several lines", has_lines=True),
        Kind(
            "line",
            "one line of text",
            "square",
            _WORDS,
            new="",
            takes_any_words=True,
            becomes_text=True,
            hint="text",
        ),
        Kind(
            "boolean",
            "a yes-or-no question",
            "hexagon",
            frozenset({"boolean", "any"}),
            typed=False,
            of_nothing=lambda: ast.Constant(False),
            missing=Text("a question is missing."),
            advice="Put a six-sided block into the slot.",
            hint="yes or no?",
        ),
        Kind(
            "list",
            "a list",
            "bracket",
            frozenset({"list", "any"}),
            typed=False,
            of_nothing=lambda: ast.List([]),
            missing=Text("a list is missing."),
            advice="Put a list or a variable into the slot.",
            hint="list",
        ),
        Kind(
            "table",
            "a table",
            "bracket",
            frozenset({"table", "any"}),
            typed=False,
            of_nothing=lambda: ast.Dict([], []),
            missing=Text("a table is missing."),
            advice="Put a table or a variable into the slot.",
            hint="table",
        ),
        Kind(
            "any",
            "a value",
            "pill",
            _ALL,
            _why_not_any,
            _read_any,
            number_text,
            constants=(str, int, float),
            new=0,
            hint="value",
        ),
        Kind(
            "colour",
            "a colour",
            "pill",
            frozenset({"colour", "any"}),
            _why_not_colour,
            new="#ff8800",
            words=_COLOUR_WORDS,
            mark="swatch",
            opens=True,
        ),
        Kind(
            "checkbox",
            "on or off",
            fits=frozenset({"boolean", "any"}),
            why_not=_why_not_checked,
            constants=(bool,),
            words=_SWITCH_WORDS,
            mark="tick",
            is_pressed=True,
        ),
        Kind("clock", "a time of the day", why_not=_why_not_clock, read=_clock_time, hint="time"),
        _name("message", "a message", read=_message),
        _name("state", "a human state", read=_state),
        _name("mode", "a state of the program", read=_message),
        _name("gesture", "a gesture", prefix=GESTURE_STATE, table="gestures"),
        Kind("goal", "a goal", fits=_WORDS, new="", takes_any_words=True, hint="goal", opens=True),
        _name(
            "robot", "a robot", is_said=False, fits=frozenset({"robot", "text", "any"}), new="NAO"
        ),
        Kind(
            "rule",
            "a rule",
            constants=(),
            missing=text_of("{noun} is missing.", noun=Text("a rule")),
            advice="Choose a rule in this block.",
            hint="rule",
            opens=True,
        ),
        _name("variable", "a variable", missing=False, is_said=False),
        Kind("choice", "one of a list", fits=_WORDS, hint="choose", opens=True),
        Kind(
            "settings",
            "a list of settings",
            why_not=_why_not_settings,
            constants=(),
            hint="no settings",
            opens=True,
        ),
        Kind("parameter", "a value of this block", typed=False),
        Kind("body", "blocks", "mouth", typed=False, constants=()),
    )
}


def kind_of(name: str) -> Kind:
    """The kind of a name; raises BlocksError, which names it, when there is none."""
    kind = KINDS.get(name)
    if kind is None:
        raise BlocksError("There is no kind of field called “{name}”.", name=name)
    return kind
