"""What blocks do with tables where a dict does something else: docs/language.md says what.

Python takes True for the key 1. These functions keep what is at a truth under a ``TruthKey``; all
that may be such a key goes through them.

The arguments stand in the order of the sentence of the block, in which they are worked out.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any

from .tasks import at_once
from .values import (
    FALSE_KEY,
    LOOK,
    TRUE_KEY,
    TruthKey,
    as_comparable,
    as_number,
    noun_of,
    refuse,
    shown,
)

ASK_EMPTY = "Ask first whether the table is empty."
ASK_FIRST = "Ask first whether the table has it."
TAKE_OTHERWISE = "Or take the block that says what to give if it is not there."
PUT_TABLE = "Put a table into this place."
USE_NAME = "Use a text or a number as the name of what is kept."

Table = dict[Hashable, Any]

_NOTHING: Any = object()


def as_table(value: Any) -> Table:
    """The same value; raises ValueRefused unless it is a table."""
    if isinstance(value, dict):
        return value
    refuse(
        "A table belongs here, and {value} is {noun}.",
        LOOK,
        PUT_TABLE,
        value=shown(value),
        noun=noun_of(value),
    )


def table_of(*keys_and_values: Any) -> Table:
    """A table of keys, each with its value behind it; a key that comes twice has the last value."""
    pairs = zip(keys_and_values[::2], keys_and_values[1::2], strict=True)
    return {_key(key): value for key, value in pairs}


def value_at(table: Any, key: Any, otherwise: Any = _NOTHING) -> Any:
    """What is kept at a key, else ``otherwise``; raises ValueRefused where there is neither."""
    found = as_table(table).get(_key(key), otherwise)
    if found is _NOTHING:
        _refuse_missing(key)
    return found


def set_at(table: Any, key: Any, value: Any) -> None:
    """Keep a value at a key."""
    as_table(table)[_key(key)] = value


def remove_key(key: Any, table: Any) -> None:
    """Take a key with its value out of a table; raises ValueRefused where it is not there."""
    if as_table(table).pop(_key(key), _NOTHING) is _NOTHING:
        _refuse_missing(key)


def change_at(table: Any, key: Any, amount: Any) -> None:
    """Add to the number that is kept at a key; it counts from 0 where nothing is there."""
    with at_once:
        held, more = as_table(table), as_number(amount)
        place = _key(key)
        held[place] = as_number(held.get(place, 0)) + more


def has_key(table: Any, key: Any) -> bool:
    """Whether something is kept at a key."""
    return _key(key) in as_table(table)


def names_in(table: Any) -> list[Any]:
    """The keys of a table in the order in which they were set first."""
    return [key.value if isinstance(key, TruthKey) else key for key in list(as_table(table))]


def name_with_largest(table: Any) -> Any:
    """The first name at which a table keeps its largest value: numbers only, or texts only.

    Raises ValueRefused where the table is empty, or what it keeps cannot be compared.
    """
    names, values = _comparable_values(table)
    return names[values.index(max(values))]


def name_with_smallest(table: Any) -> Any:
    """The first name at which a table keeps its smallest value; as ``name_with_largest``."""
    names, values = _comparable_values(table)
    return names[values.index(min(values))]


def _comparable_values(table: Any) -> tuple[list[Any], list[Any]]:
    """The names of a table and their values, of which each can be compared with the others."""
    kept = list(as_table(table).items())  # at once: another rule may put something in meanwhile
    if not kept:
        refuse("The table is empty: no value in it is the largest or the smallest.", ASK_EMPTY)
    names = [key.value if isinstance(key, TruthKey) else key for key, _ in kept]
    values = [value for _, value in kept]
    return names, as_comparable(values)


def _key(value: Any) -> Hashable:
    """What a table keeps a value under; raises ValueRefused for what is no key."""
    if isinstance(value, bool):
        return TRUE_KEY if value else FALSE_KEY
    if isinstance(value, str | int | float):
        return value
    refuse(
        "Nothing can be kept under {value}: it is {noun}.",
        LOOK,
        USE_NAME,
        value=shown(value),
        noun=noun_of(value),
    )


def _refuse_missing(key: Any) -> None:
    refuse(
        "The table has nothing at {value}.",
        ASK_FIRST,
        TAKE_OTHERWISE,
        value=shown(key),
    )
