"""The sentence of a block: words, typed named slots, and groups that repeat.

    {robot:robot} says {text:text} with {gesture:choice(say_gestures)}
    if {condition:boolean} {do:body} [also: else if {also_condition:boolean} {also_do:body}]*

``[name: ...]*`` repeats, ``[name: ...]?`` is there once or not at all. A slot inside a group is
numbered from 1: ``also_do.1``, ``also_do.2``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from faults import Text, text_of

from .slots import KINDS, Kind, why_not_between

MOST_REPEATS = 20

_TOKEN = re.compile(
    r"\{(?P<slot>[a-z][a-z0-9_]*):(?P<kind>[a-z]+)(?:\((?P<more>[^(){}]*)\))?\}"
    r"|\[(?P<group>[a-z][a-z0-9_]*):"
    r"|\](?P<repeat>[*?])"
    r"|(?P<words>[^{}\[\]]+)"
)
_TABLE = re.compile(r"(?P<table>[a-z][a-z0-9_]*)(?:/(?P<master>[a-z][a-z0-9_]*))?")
_RANGE = re.compile(r"(?P<low>-?[0-9]+(?:\.[0-9]+)?)\.\.(?P<high>-?[0-9]+(?:\.[0-9]+)?)")


@dataclass(frozen=True, slots=True)
class Slot:
    """A named place in a sentence.

    ``table`` names the choices, ``group`` the group that the slot is in. The choices of a slot
    with a ``master`` are those of the table "table.value", by the value of the slot ``master``.
    ``low`` and ``high`` are the ends of a slider. A slot of kind parameter shows ``label``, and
    ``table`` is the type of the block that is dragged out of it.
    """

    name: str
    kind: Kind
    table: str = ""
    group: str = ""
    master: str = ""
    low: float | None = None
    high: float | None = None
    label: str = ""

    def why_not(self, value: object) -> Text | None:
        """Why the slot's field cannot hold ``value``, whatever its choices are, or None."""
        if not self.kind.typed:
            return text_of(
                "This place takes {noun}, not a value that is typed.", noun=Text(self.kind.noun)
            )
        if self.low is not None and self.high is not None:
            return why_not_between(value, self.low, self.high)
        return self.kind.why_not(value)


@dataclass(frozen=True, slots=True)
class Group:
    """A part of a sentence that may come several times."""

    name: str
    parts: tuple[str | Slot, ...]
    maximum: int


Part = str | Slot | Group


class SentenceError(ValueError):
    """A sentence that cannot be understood; its text says why."""


def parse(sentence: str) -> tuple[Part, ...]:
    """Read a sentence into words, slots and groups, or raise SentenceError."""
    parts: list[Part] = []
    inside: list[str | Slot] = []
    group = ""
    for token in tokens(sentence):
        if token["group"]:
            if group:
                raise SentenceError(f"group “{token['group']}” is inside group “{group}”")
            group, inside = token["group"], []
        elif token["repeat"]:
            if not group:
                raise SentenceError("a “]” without its “[name:”")
            parts.append(Group(group, tuple(inside), 1 if token["repeat"] == "?" else MOST_REPEATS))
            group = ""
        elif part := _word_or_slot(token, group):
            (inside if group else parts).append(part)
    if group:
        raise SentenceError(f"group “{group}” is not closed by ]* or ]?")
    return tuple(parts)


def tokens(sentence: str, pattern: re.Pattern[str] = _TOKEN) -> Iterator[re.Match[str]]:
    """Take a sentence apart; raises SentenceError where the pattern does not fit."""
    position = 0
    while position < len(sentence):
        token = pattern.match(sentence, position)
        if token is None:
            raise SentenceError(f"“{sentence[position : position + 30]}” cannot be understood")
        position = token.end()
        yield token


def _word_or_slot(token: re.Match[str], group: str) -> str | Slot:
    name, kind_name, more = token["slot"], token["kind"], token["more"] or ""
    if not name:
        return token["words"].strip()
    if kind_name not in KINDS:
        raise SentenceError(f"slot “{name}” has no kind “{kind_name}”: use {', '.join(KINDS)}")
    kind = KINDS[kind_name]
    if kind_name == "choice":
        named = _TABLE.fullmatch(more)
        if named is None:
            raise SentenceError(f"slot “{name}”: a choice names its table, choice(table)")
        return Slot(name, kind, named["table"], group, named["master"] or "")
    if kind_name == "slider":
        return _slider(name, kind, group, more)
    if more:
        raise SentenceError(f"slot “{name}”: {kind_name} has nothing in parentheses")
    return Slot(name, kind, group=group)


def _slider(name: str, kind: Kind, group: str, more: str) -> Slot:
    ends = _RANGE.fullmatch(more)
    if ends is None or float(ends["low"]) >= float(ends["high"]):
        raise SentenceError(f"slot “{name}”: a slider has its ends, slider(0..100)")
    return Slot(name, kind, group=group, low=float(ends["low"]), high=float(ends["high"]))


def slots_of(parts: tuple[Part, ...]) -> dict[str, Slot]:
    """All slots of a sentence by name, those of groups too; a name used twice is an error."""
    slots: dict[str, Slot] = {}
    for part in parts:
        inner = part.parts if isinstance(part, Group) else (part,)
        for slot in inner:
            if isinstance(slot, Slot):
                if slot.name in slots:
                    raise SentenceError(f"slot “{slot.name}” is there twice")
                slots[slot.name] = slot
    for slot in slots.values():
        if slot.master and not _is_master(slots.get(slot.master), slot):
            raise SentenceError(
                f"slot “{slot.name}” depends on “{slot.master}”, which is no choice"
            )
    return slots


def _is_master(master: Slot | None, slot: Slot) -> bool:
    """Whether a slot may decide about the choices of another: a choice, outside or beside it."""
    return master is not None and master.kind.name == "choice" and master.group in ("", slot.group)


def groups_of(parts: tuple[Part, ...]) -> dict[str, Group]:
    """The groups of a sentence by name; a name used twice is an error."""
    groups: dict[str, Group] = {}
    for part in parts:
        if isinstance(part, Group):
            if part.name in groups:
                raise SentenceError(f"group “{part.name}” is there twice")
            groups[part.name] = part
    return groups
