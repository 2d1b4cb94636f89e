"""Facts: what is true at present for the program, each a name with values, such as “at NAO hall”.

A fact that nobody has made true is not. One that a sensor tells is true while its condition is.
What own blocks need of facts, and make of them, is what plans are made of.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from enum import Enum

from nep_core.errors import FactNotSo

from .tasks import current_task, wait_until
from .values import LOOK, as_text, refuse, shown

MOST_FACTS = 10_000
"""A program that makes more facts true than these does so without end."""
MOST_VALUES = 20
SETTLE_S = 2.0
"""For so long a sensor may take to see what the program has just done."""


class Truth(Enum):
    """A truth among the values of a fact, where 1 is not the same as true."""

    NO = False
    YES = True


Value = str | int | float | Truth
Fact = tuple[Value, ...]
"""The name of a fact, and its values."""
Condition = Callable[[], object]


def fact_of(items: object) -> Fact:
    """A fact of the list that a program has of it: its name, then its values."""
    if not isinstance(items, list | tuple) or not items:
        refuse("A fact is a name with values, not {value}.", LOOK, value=shown(items))
    if len(items) > MOST_VALUES + 1:
        refuse("A fact has {most} values at most.", LOOK, most=MOST_VALUES)
    name, *values = items
    if not isinstance(name, str) or not name.strip():
        refuse("A fact begins with its name, not with {value}.", LOOK, value=shown(name))
    return (name.strip(), *map(_value, values))


def _value(value: object) -> Value:
    if isinstance(value, bool):
        return Truth(value)
    if isinstance(value, str | int | float | Truth):
        return value
    refuse(
        "A value of a fact is a number, a text or a truth, not {value}.", LOOK, value=shown(value)
    )


def plain(value: Value) -> str | int | float | bool:
    """A value of a fact as the program has it."""
    return value.value if isinstance(value, Truth) else value


def told_fact(fact: Fact) -> str:
    """A fact in words: its name and its values."""
    return " ".join(as_text(plain(part)) for part in fact)


class Facts:
    """The facts of a program; any thread may ask and change them."""

    def __init__(self) -> None:
        self._true: set[Fact] = set()
        self._sensed: dict[Fact, Condition] = {}
        self._lock = threading.Lock()

    def clear(self) -> None:
        """Forget all: nothing is true any more."""
        with self._lock:
            self._true.clear()
            self._sensed.clear()

    def put(self, fact: Fact, *, is_true: bool) -> None:
        """Make a fact true, or no longer true; one that a sensor tells must become so by itself."""
        with self._lock:
            condition = self._sensed.get(fact)
            if condition is None:
                self._keep(fact, is_true=is_true)
                return
        if not wait_until(lambda: bool(condition()) is is_true, SETTLE_S):
            sentence = "“{fact}” should be true now, but what is sensed says that it is not."
            if not is_true:
                sentence = "“{fact}” should no longer be true, but what is sensed says that it is."
            raise FactNotSo(
                sentence,
                checklist=("Did the robot do what it was asked?", "Try the sensor by itself."),
                fact=told_fact(fact),
            )

    def sense(self, fact: Fact, condition: Condition) -> None:
        """Let a fact be true while a condition is, from now on."""
        with self._lock:
            self._sensed[fact] = condition
            self._true.discard(fact)

    def is_true(self, fact: Fact) -> bool:
        """Whether a fact is true at present."""
        with self._lock:
            condition = self._sensed.get(fact)
            if condition is None:
                return fact in self._true
        return bool(condition())

    def present(self) -> frozenset[Fact]:
        """All that is true at present."""
        with self._lock:
            known, sensed = frozenset(self._true), list(self._sensed.items())
        return known.union(fact for fact, condition in sensed if condition())

    def _keep(self, fact: Fact, *, is_true: bool) -> None:
        if not is_true:
            self._true.discard(fact)
            return
        if len(self._true) >= MOST_FACTS and fact not in self._true:
            refuse(
                "More than {most} facts would be true at once.",
                "Say also which facts are no longer true.",
                most=MOST_FACTS,
            )
        self._true.add(fact)


FACTS = Facts()
"""The facts of this program."""


# What a program says about facts.


def fact(name: str, *values: object) -> list[object]:
    """A fact that is wanted: a list of its name and values."""
    return [name, *values]


def now_true(name: str, *values: object) -> None:
    """Make a fact true; one that a sensor tells must be so within two seconds, or FactNotSo."""
    current_task().check()
    FACTS.put(fact_of([name, *values]), is_true=True)


def no_longer_true(name: str, *values: object) -> None:
    """Make a fact untrue; one that a sensor tells must be so within two seconds, or FactNotSo."""
    current_task().check()
    FACTS.put(fact_of([name, *values]), is_true=False)


def makes_true(name: str, *values: object) -> None:
    """Make a fact true, and say that this is what a plan may call this function for."""
    now_true(name, *values)


def makes_untrue(name: str, *values: object) -> None:
    """Make a fact untrue, and say so to who plans with this function."""
    no_longer_true(name, *values)


def true_while(condition: Condition, name: str, *values: object) -> None:
    """Let a fact be true while ``condition()`` is: what a sensor tells is looked at each time."""
    FACTS.sense(fact_of([name, *values]), condition)


def is_true(name: str, *values: object) -> bool:
    """Whether a fact is true at present."""
    return FACTS.is_true(fact_of([name, *values]))


def needs(name: str, *values: object) -> None:
    """Say at the top of a function which fact it needs; raises FactNotSo if it is not true."""
    needed = fact_of([name, *values])
    if not FACTS.is_true(needed):
        raise FactNotSo(
            "“{fact}” is needed here, but is not true.",
            checklist=("Make it true before.", "Use “reach”, which finds out what to do before."),
            fact=told_fact(needed),
        )
