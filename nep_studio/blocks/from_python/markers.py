"""Names and numbers that stand for slots in a learned piece of Python, and how they are told."""

from __future__ import annotations

import re

_SLOT, _BODY, _PART, _VARIABLE = "SLOT_", "BODY_", "PART_", "VARIABLE_"
MARKS = (_SLOT, _BODY, _PART, _VARIABLE)
_FIRST_NUMBER, _STEP, _REACH = 7_000_000, 1000, 20
_WORD = re.compile(r"qslotq([a-z0-9]+?)q")


def slot_name(key: str) -> str:
    """A name that stands for what is in a slot."""
    return _SLOT + key.replace(".", "_N")


def body_name(key: str) -> str:
    """A name that stands for the blocks in a body."""
    return _BODY + key.replace(".", "_N")


def part_name(number: int) -> str:
    """A name that stands for the name of a function."""
    return f"{_PART}{number}"


VARIABLE_NAME = f"{_VARIABLE}variable"


def slot_of(name: str) -> str:
    """The slot that a name stands for, or an empty text."""
    return _key(name, _SLOT)


def body_of(name: str) -> str:
    """The body that a name stands for, or an empty text."""
    return _key(name, _BODY)


def is_part(name: str) -> bool:
    """Whether a name stands for the name of a function."""
    return name.startswith(_PART)


def number_for(position: int) -> int:
    """A number that stands for a whole number typed into slot number ``position``."""
    return _FIRST_NUMBER + _STEP * position


def position_of(number: object) -> tuple[int, int] | None:
    """The position that a number stands for, and what was added to it; or None."""
    if type(number) is not int or number < _FIRST_NUMBER - _REACH:
        return None
    position, more = divmod(number - _FIRST_NUMBER + _REACH, _STEP)
    return (position, more - _REACH) if more <= 2 * _REACH else None


def word_for(position: int) -> str:
    """A word that stands for what is typed into slot number ``position``."""
    return f"qslotq{position}q"


def word_pattern(text: str) -> tuple[re.Pattern[str], list[int]] | None:
    """How a text with such words in it is matched, and which positions they have; or None."""
    positions = [int(number) for number in _WORD.findall(text)]
    if not positions:
        return None
    parts = [re.escape(part) for part in re.split(r"qslotq[a-z0-9]+?q", text)]
    return re.compile("(.*)".join(parts), re.DOTALL), positions


def _key(name: str, start: str) -> str:
    return name.removeprefix(start).replace("_N", ".") if name.startswith(start) else ""
