"""What blocks do with values where Python does something else: docs/language.md says what.

A value is a number, a text, a truth, a list or a table. Nothing becomes another kind by itself;
what does not fit is a ``ValueRefused``, whose sentence is made where the error is told.

The arguments stand in the order of the sentence of the block, in which they are worked out.
"""

from __future__ import annotations

import math
import random
import re
import statistics
from collections.abc import Iterable, Sequence
from decimal import Decimal, InvalidOperation
from typing import Any, NoReturn

from faults import Text
from nep_core.errors import ValueRefused

from .tasks import at_once

Number = int | float

# How values are told: the words for true, false and “and”, and the decimal mark, by language.

WORDS: dict[str, tuple[str, str, str, str]] = {
    "en": ("true", "false", "and", "."),
    "de": ("wahr", "falsch", "und", ","),
    "es": ("verdadero", "falso", "y", ","),
    "fr": ("vrai", "faux", "et", ","),
    "it": ("vero", "falso", "e", ","),
    "ja": ("真", "偽", "と", "."),
}
MOST_DIGITS = 12
"""Digits of a fraction that are told: what is left then is what computers cannot hold."""
LARGEST_PLAIN = 15
SMALLEST_PLAIN = -6
"""The powers of ten between which a fraction is told without an exponent."""
LARGEST_POWER_DIGITS = 1000
"""A longer whole number as a power is refused: it would take the computer's time and memory."""
LARGEST_PLAIN_POWER = 3
"""Squares and cubes are no larger than what is multiplied."""
LONGEST = 40
"""Letters of a value in a sentence."""
DEEPEST_LIST, MOST_LISTS = 100, 100_000
"""A list in more lists than these, or with more in it, is in itself or grows without end."""

_language = "en"


def speak(language: str) -> None:
    """Tell values in a language from now on; in English where it is not known."""
    global _language
    _language = language if language in WORDS else "en"


def spoken_language() -> str:
    """The code of the language in which the program tells values."""
    return _language


def as_text(value: object) -> str:
    """A value as it is told to people; raises ValueRefused for what is no number at all."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return WORDS[_language][0] if value else WORDS[_language][1]
    if isinstance(value, int):
        return _digits(value)
    if isinstance(value, float):
        return _told_fraction(value)
    if isinstance(value, _DEEP):
        _require_end(value)
        return _told_inside(value)
    return "" if value is None else str(value)


class TruthKey:
    """A truth as the key of a table, in which Python takes True for 1."""

    __slots__ = ("value",)

    def __init__(self, value: bool) -> None:
        self.value = value

    def __repr__(self) -> str:
        return repr(self.value)


TRUE_KEY, FALSE_KEY = TruthKey(True), TruthKey(False)

_DEEP = (list, tuple, dict)
"""What has values in it."""


def _told_inside(value: object) -> str:
    """A value that comes to an end, as it is told to people."""
    if isinstance(value, dict):
        entries = list(value.items())  # another rule may set it meanwhile
        return ", ".join(f"{_told_key(key)}: {_told_inside(held)}" for key, held in entries)
    if isinstance(value, list | tuple):
        return _enumerated([_told_inside(item) for item in value])
    return as_text(value)


def _told_key(key: object) -> str:
    return as_text(key.value if isinstance(key, TruthKey) else key)


def _values_in(value: Any) -> list[Any]:
    return list(value.values() if isinstance(value, dict) else value)


def _require_end(items: object) -> None:
    """Raise ValueRefused for a list or a table through which nobody comes to an end."""
    level, seen = [items], 0
    for _ in range(DEEPEST_LIST):
        seen += len(level)
        if not level or seen > MOST_LISTS:
            break
        level = [one for many in level for one in _values_in(many) if isinstance(one, _DEEP)]
    if level:
        if isinstance(items, dict):
            refuse("This table goes too deep: perhaps it is kept in itself.", LOOK, SHOW_VALUES)
        refuse("This list goes too deep: perhaps it is an item of itself.", LOOK, CHECK_LIST)


def _digits(number: int) -> str:
    try:
        return str(number)
    except ValueError:  # Python writes numbers of some thousand digits only
        refuse(
            "A number cannot be written: it is too long, or it is no number at all.",
            STOP_GROWING,
            NO_NAN,
        )


def _told_fraction(number: float) -> str:
    if not math.isfinite(number):
        refuse(
            "A number cannot be written: it is too long, or it is no number at all.",
            STOP_GROWING,
            NO_NAN,
        )
    if number.is_integer():
        return str(int(number))
    rounded = Decimal(f"{number:.{MOST_DIGITS - 1}e}")
    if SMALLEST_PLAIN <= rounded.adjusted() <= LARGEST_PLAIN:
        text = f"{rounded:f}"
        text = text.rstrip("0").rstrip(".") if "." in text else text
    else:
        mantissa, _, exponent = f"{number:.{MOST_DIGITS - 1}e}".partition("e")
        text = f"{mantissa.rstrip('0').rstrip('.')}e{exponent}"
    return text.replace(".", WORDS[_language][3])


def _enumerated(items: Sequence[str]) -> str:
    if len(items) < 2:
        return "".join(items)
    return f"{', '.join(items[:-1])} {WORDS[_language][2]} {items[-1]}"


# What is refused, in the words that the program's own errors have.

LOOK = "Look at the block that is marked: what does it get?"
SHOW_VALUES = "Run again and watch the values of the variables."
CONVERT = "Turn the text into a number, or the number into a text, with a block that does that."
ASK_LENGTH = "Ask first how many items there are, and take only those."
ASK_EMPTY = "Ask first whether the list is empty."
CHECK_LIST = "Check what the list holds at that moment."
CHECK_NUMBER = "Check the number: the first item is number 1."
TEST_ZERO = "Ask with an “if” whether it is zero before you divide."
TYPE_NUMBER = "Write digits only, with a dot where it is not whole."
STOP_GROWING = "Look for a loop that makes the number larger and larger."
NO_NAN = "Check the calculation that the number comes from."
PUT_LIST = "Put a list into this place."
PUT_ROBOT = "Put a robot, or the name of one, into this place."
ROUND_IT = "Round the number with a block that does that."

TOO_LARGE = "A number became too large."

_KINDS: tuple[tuple[type | tuple[type, ...], Text], ...] = (
    (bool, Text("true or false")),
    ((int, float), Text("a number")),
    (str, Text("a text")),
    ((list, tuple), Text("a list")),
    (dict, Text("a table")),
    (type(None), Text("nothing")),
)


def refuse(sentence: str, *steps: str, **values: Any) -> NoReturn:
    """Raise what tells a person that a value does not fit."""
    raise ValueRefused(sentence, checklist=steps, **values)


def shown(value: Any) -> str:
    """A value in a sentence, on one line, clipped."""
    if isinstance(value, str):
        text = f"“{value[: LONGEST + 1]}”"
    elif _is_number(value) and not -(10**LONGEST) < value < 10**LONGEST:
        return "…"
    elif isinstance(value, list | dict):
        try:
            if isinstance(value, list):
                text = as_text(value[:LONGEST]) or "[]"
            else:
                text = as_text(dict(list(value.items())[:LONGEST])) or "{}"
        except ValueRefused:
            return "…"
    else:
        text = as_text(value)
    text = " ".join(text.split())
    return text if len(text) <= LONGEST + 2 else f"{text[:LONGEST]}…"


def noun_of(value: object) -> Text:
    """What a value is; what is no value of Python itself, such as a robot, says so itself."""
    other: Text = getattr(type(value), "NOUN", Text("something else"))
    return next((noun for kind, noun in _KINDS if isinstance(value, kind)), other)


# A value that must be of a kind.


def as_number(value: Any) -> Number:
    """The same value; raises ValueRefused unless it is a number (a text of digits is none)."""
    if type(value) is int:
        return value
    if type(value) is float:
        if math.isfinite(value):
            return value
        refuse(TOO_LARGE, STOP_GROWING, SHOW_VALUES)
    refuse(
        "A number belongs here, and {value} is {noun}.",
        LOOK,
        CONVERT,
        value=shown(value),
        noun=noun_of(value),
    )


def as_list(value: Any) -> list[Any]:
    """The same value; raises ValueRefused unless it is a list."""
    if isinstance(value, list):
        return value
    refuse(
        "A list belongs here, and {value} is {noun}.",
        LOOK,
        PUT_LIST,
        value=shown(value),
        noun=noun_of(value),
    )


def _whole(value: Any) -> int:
    """A number without a fraction, such as a place; raises ValueRefused."""
    number = as_number(value)
    if isinstance(number, int):
        return number
    if number.is_integer():
        return int(number)
    refuse(
        "A whole number belongs here, and {number} is not whole.",
        LOOK,
        ROUND_IT,
        number=shown(number),
    )


# Comparing.


def is_same(a: Any, b: Any) -> bool:
    """Whether two values are of one kind and equal; 1 is neither true nor the text "1"."""
    if isinstance(a, bool) or isinstance(b, bool):
        return a is b
    if _are_deep(a, b):
        if a is b or len(a) != len(b):
            return a is b
        _require_end(a)
        return _have_same(a, b)
    return bool(a == b)


def _are_deep(a: Any, b: Any) -> bool:
    """Whether both are lists, or both are tables."""
    return any(isinstance(a, kind) and isinstance(b, kind) for kind in (list, dict))


def _have_same(a: Any, b: Any) -> bool:
    """Whether two lists, or two tables, have the same in them, and come to an end."""
    if len(a) != len(b) or (isinstance(a, dict) and a.keys() != b.keys()):
        return False
    pairs = (
        [(a[key], b[key]) for key in list(a)] if isinstance(a, dict) else zip(a, b, strict=False)
    )
    return all(
        _have_same(one, other) if _are_deep(one, other) else is_same(one, other)
        for one, other in pairs
    )


def is_less(a: Any, b: Any) -> bool:
    """Whether a < b; raises ValueRefused unless both are numbers or both are texts."""
    return bool(_comparable(a, b) and a < b)


def is_more(a: Any, b: Any) -> bool:
    """Whether a > b; raises ValueRefused unless both are numbers or both are texts."""
    return bool(_comparable(a, b) and a > b)


def is_at_most(a: Any, b: Any) -> bool:
    """Whether a <= b; raises ValueRefused unless both are numbers or both are texts."""
    return bool(_comparable(a, b) and a <= b)


def is_at_least(a: Any, b: Any) -> bool:
    """Whether a >= b; raises ValueRefused unless both are numbers or both are texts."""
    return bool(_comparable(a, b) and a >= b)


def _comparable(a: Any, b: Any) -> bool:
    if (_is_number(a) and _is_number(b)) or (isinstance(a, str) and isinstance(b, str)):
        return True
    refuse(
        "It cannot be told which is larger, {left} or {right}: one is {noun}, the other {result}.",
        LOOK,
        CONVERT,
        left=shown(a),
        right=shown(b),
        noun=noun_of(a),
        result=noun_of(b),
    )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


# Numbers.


def to_nearest(number: Any) -> int:
    """The nearest whole number; a half goes away from zero."""
    value = as_number(number)
    if isinstance(value, int):
        return value
    size = math.floor(abs(value))
    size += abs(value) - size >= 0.5
    return size if value > 0 else -size


def to_power(number: Any, power: Any) -> Number:
    """The power of a number; raises ValueRefused where there is no real one, or a too long one."""
    base, exponent = as_number(number), as_number(power)
    if base == 0 and exponent < 0:
        refuse("A number was divided by zero.", LOOK, TEST_ZERO, SHOW_VALUES)
    if isinstance(base, int) and isinstance(exponent, int) and exponent > LARGEST_PLAIN_POWER:
        digits_at_least = (base.bit_length() - 1) * exponent * math.log10(2)
        if digits_at_least > LARGEST_POWER_DIGITS:  # asked before it takes its time
            refuse(TOO_LARGE, STOP_GROWING, SHOW_VALUES)
    try:
        result: Any = base**exponent
    except OverflowError:
        refuse(TOO_LARGE, STOP_GROWING, SHOW_VALUES)
    if isinstance(result, complex):
        refuse(
            "This has no result for that number, such as the root of a number below zero.",
            LOOK,
            SHOW_VALUES,
        )
    is_other = exponent > LARGEST_PLAIN_POWER
    if is_other and isinstance(result, int) and abs(result) >= 10**LARGEST_POWER_DIGITS:
        refuse(TOO_LARGE, STOP_GROWING, SHOW_VALUES)
    return as_number(result)


def random_whole(low: Any, high: Any) -> int:
    """A whole number between two, both included, whichever is larger."""
    ends = to_nearest(low), to_nearest(high)
    return random.randint(min(ends), max(ends))


def count_from(first: Any, last: Any, step: Any = 1) -> Iterable[Number]:
    """The numbers from one towards another, up or down; raises ValueRefused for a step of 0.

    The last is reached if rounding alone keeps the count from it.
    """
    start, end, by = as_number(first), as_number(last), abs(as_number(step))
    if by == 0:
        refuse(
            "Counting in steps of zero never ends.",
            "Make the step 1, or any number that is not zero.",
        )
    way = 1 if end >= start else -1
    if isinstance(start, int) and isinstance(end, int) and isinstance(by, int):
        return range(start, end + way, way * by)
    steps = math.floor(abs(end - start) / by + 1e-9)
    return (start + way * by * done for done in range(steps + 1))


def count_up(first: Any, last: Any, step: Any = 1) -> Iterable[Number]:
    """The numbers from one up to another, as count_from; none where that is below the first."""
    return count_from(first, last, step) if as_number(first) <= as_number(last) else _none(step)


def count_down(first: Any, last: Any, step: Any = 1) -> Iterable[Number]:
    """The numbers from one down to another, as count_from; none where that is above the first."""
    return count_from(first, last, step) if as_number(first) >= as_number(last) else _none(step)


def _none(step: Any) -> Iterable[Number]:
    """No numbers; raises ValueRefused for a step with which nobody counts."""
    count_from(0, 0, step)
    return ()


_NUMBER = re.compile(r"\s*([+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?)\s*", re.ASCII)
_LARGEST_EXPONENT = 400


def number_in(text: str) -> Number:
    """The number that a text says, with a point or a comma; raises ValueRefused."""
    found = _NUMBER.fullmatch(text)
    if found is None:
        refuse(
            "The text “{text}” is not a number.",
            TYPE_NUMBER,
            "Ask with an “if” what the text is, before it is turned into a number.",
            text=shown(text)[1:-1],
        )
    try:
        number = Decimal(found[1].replace(",", "."))
    except InvalidOperation:  # an exponent of some twenty digits
        digits, _, exponent = found[1].lower().partition("e")
        if not exponent.startswith("-") and digits.strip("+-.,0"):
            refuse(TOO_LARGE, STOP_GROWING, SHOW_VALUES)
        return 0
    if number == 0:
        return 0
    is_short = "e" in found[1].lower()
    if number.adjusted() >= (_LARGEST_EXPONENT if is_short else LARGEST_POWER_DIGITS):
        refuse(TOO_LARGE, STOP_GROWING, SHOW_VALUES)
    if number.adjusted() >= 0 and number == number.to_integral_value():
        return int(number)
    return as_number(float(number))


def sum_of(items: Any) -> Number:
    """The sum of a list of numbers; 0 of an empty one."""
    return as_number(sum(_numbers(items)))


def smallest_of(items: Any) -> Number:
    """The smallest number of a list."""
    return min(_numbers(items, least=1))


def largest_of(items: Any) -> Number:
    """The largest number of a list."""
    return max(_numbers(items, least=1))


def mean_of(items: Any) -> Number:
    """The mean of a list of numbers."""
    return statistics.mean(_numbers(items, least=1))


def median_of(items: Any) -> Number:
    """The median of a list of numbers."""
    return as_number(statistics.median(_numbers(items, least=1)))


def deviation_of(items: Any) -> Number:
    """The standard deviation of the numbers of a list, which are a sample."""
    return as_number(statistics.stdev(_numbers(items, least=2)))


def _numbers(items: Any, least: int = 0) -> list[Number]:
    numbers = [as_number(item) for item in as_list(items)]
    if len(numbers) < least:
        refuse(
            "There is no result for a list that has too few items.",
            ASK_EMPTY,
            CHECK_LIST,
        )
    return numbers


# Texts.


def length_of(value: Any) -> int:
    """How much a list or a table has in it; else with how many letters the value is told."""
    return len(value) if isinstance(value, list | dict) else len(as_text(value))


def letter_of(number: Any, text: str) -> str:
    """The letter at a place, from 1; raises ValueRefused where there is none."""
    place = _whole(number)
    if not 1 <= place <= len(text):
        refuse(
            "The text has {count} letters, and letter {number} was asked for.",
            CHECK_NUMBER,
            ASK_LENGTH,
            count=str(len(text)),
            number=shown(place),
        )
    return text[place - 1]


def has_part(text: str, part: str) -> bool:
    """Whether a text contains another."""
    return part in text


def place_in_text(part: str, text: str) -> int:
    """Where a part begins in a text for the first time, from 1; 0 if nowhere."""
    return text.find(part) + 1


def replace_part(text: str, new: str, part: str) -> str:
    """A text with another in place of each part of it; an empty part is nowhere."""
    return text.replace(part, new) if part else text


def title_case(text: str) -> str:
    """A text with a capital at each word and small letters behind it."""
    return re.sub(r"\S+", lambda word: word[0][0].upper() + word[0][1:].lower(), text)


def append_text(text: str, to: Any) -> str:
    """A value told as a text, with a text behind it."""
    return as_text(to) + text


def parts_of(text: str, mark: str) -> list[str]:
    """The parts of a text between a mark; its letters where the mark is empty."""
    return text.split(mark) if mark else list(text)


def join_items(items: Any, mark: str) -> str:
    """The items of a list, each told as a text, with a mark between them."""
    return mark.join(map(as_text, as_list(items)))


# Lists. Places are counted from 1, from the start or from the end.


def item_of(number: Any, items: Any, from_end: bool = False) -> Any:
    """The item at a place; raises ValueRefused where there is none."""
    held = as_list(items)
    return held[_index(number, held, from_end)]


def take_item(number: Any, items: Any, from_end: bool = False) -> Any:
    """Take the item at a place out of a list; raises ValueRefused where there is none."""
    with at_once:
        held = as_list(items)
        return held.pop(_index(number, held, from_end))


def set_item(number: Any, items: Any, value: Any, from_end: bool = False) -> None:
    """Put a value at a place of a list; raises ValueRefused where there is none."""
    with at_once:
        held = as_list(items)
        held[_index(number, held, from_end)] = value


def remove_item(number: Any, items: Any, from_end: bool = False) -> None:
    """Remove the item at a place; raises ValueRefused where there is none."""
    with at_once:
        held = as_list(items)
        del held[_index(number, held, from_end)]


def add_item(value: Any, items: Any) -> None:
    """Put a value at the end of a list."""
    as_list(items).append(value)


def insert_item(value: Any, number: Any, items: Any, from_end: bool = False) -> None:
    """Put a value into a list, so that it is at that place afterwards, counted from that end."""
    with at_once:
        held = as_list(items)
        index = _index(number, held, from_end, more=1)
        held.insert(index, value)


def items_between(first: Any, last: Any, items: Any) -> list[Any]:
    """A list of those items of another whose places are from one to another, both included."""
    low, high = _whole(first), _whole(last)
    return as_list(items)[max(low, 1) - 1 : max(high, 0)]


def has_item(items: Any, item: Any) -> bool:
    """Whether an item of a list is the same as a value."""
    return any(is_same(one, item) for one in as_list(items))


def place_of(item: Any, items: Any) -> int:
    """The place of the first item that is the same, from 1; 0 if there is none."""
    places = (place for place, one in enumerate(as_list(items), 1) if is_same(one, item))
    return next(places, 0)


def list_with(item: Any, times: Any) -> list[Any]:
    """A list of a value so many times, rounded; a list or a table is copied for each place."""
    count = max(to_nearest(times), 0)
    copied = type(item) if isinstance(item, list | dict) else None
    return [item if copied is None else copied(item) for _ in range(count)]


def sorted_items(items: Any, reverse: bool = False) -> list[Any]:
    """The numbers, or the texts, of a list in their order."""
    return sorted(as_comparable(as_list(items)), reverse=reverse)


def as_comparable(values: list[Any]) -> list[Any]:
    """The same values; raises ValueRefused unless they are all numbers, or all texts."""
    for value in values:
        _comparable(values[0], value)
    return values


def _index(number: Any, items: Sequence[Any], from_end: bool, more: int = 0) -> int:
    """Where a place is in a list that is so many items longer afterwards."""
    place, count = _whole(number), len(items) + more
    if 1 <= place <= count:
        return count - place if from_end else place - 1
    sentence = (
        "The list has {count} items, and item {number} from the end was asked for."
        if from_end
        else "The list has {count} items, and item {number} was asked for."
    )
    refuse(
        sentence,
        CHECK_NUMBER,
        CHECK_LIST,
        ASK_LENGTH,
        count=str(len(items)),
        number=shown(place),
    )
