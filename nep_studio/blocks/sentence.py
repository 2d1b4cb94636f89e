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

from .slots import KINDS, Kind

MOST_REPEATS = 20

_TOKEN = re.compile(
    r"\{(?P<slot>[a-z][a-z0-9_]*):(?P<kind>[a-z]+)(?:\((?P<table>[a-z][a-z0-9_]*)\))?\}"
    r"|\[(?P<group>[a-z][a-z0-9_]*):"
    r"|\](?P<repeat>[*?])"
    r"|(?P<words>[^{}\[\]]+)"
)


@dataclass(frozen=True, slots=True)
class Slot:
    """A named place in a sentence; ``table`` names the choices, ``group`` the group it is in."""

    name: str
    kind: Kind
    table: str = ""
    group: str = ""


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
    for token in _tokens(sentence):
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


def _tokens(sentence: str) -> Iterator[re.Match[str]]:
    position = 0
    while position < len(sentence):
        token = _TOKEN.match(sentence, position)
        if token is None:
            raise SentenceError(f"“{sentence[position : position + 30]}” cannot be understood")
        position = token.end()
        yield token


def _word_or_slot(token: re.Match[str], group: str) -> str | Slot:
    name, kind_name, table = token["slot"], token["kind"], token["table"] or ""
    if not name:
        return token["words"].strip()
    if kind_name not in KINDS:
        raise SentenceError(f"slot “{name}” has no kind “{kind_name}”: use {', '.join(KINDS)}")
    if (kind_name == "choice") != bool(table):
        raise SentenceError(f"slot “{name}”: a choice names its table, choice(table), others none")
    return Slot(name, KINDS[kind_name], table, group)


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
    return slots


def groups_of(parts: tuple[Part, ...]) -> dict[str, Group]:
    """The groups of a sentence by name; a name used twice is an error."""
    groups: dict[str, Group] = {}
    for part in parts:
        if isinstance(part, Group):
            if part.name in groups:
                raise SentenceError(f"group “{part.name}” is there twice")
            groups[part.name] = part
    return groups
