"""What blocks there are: their sentences, and definitions read from TOML files.

A sentence is words, typed named slots, and groups that repeat:

    {robot:robot} says {text:text} with {gesture:choice(say_gestures)}
    if {condition:boolean} {do:body} [also: else if {also_condition:boolean} {also_do:body}]*

``[name: ...]*`` repeats, ``[name: ...]?`` is there once or not at all. A slot inside a group is
numbered from 1: ``also_do.1``, ``also_do.2``.
"""

from __future__ import annotations

import keyword
import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

from faults import Text, text_of

from .program import Block, split_slot
from .slots import KINDS, FieldValue, Kind, why_not_between

PYTHON_KINDS = frozenset(("lines", "line"))
"""The kinds of fields that hold Python, in the blocks whose values are code."""

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
    ``table`` is the type of the block that is dragged out of it. ``closed`` is why no block fits
    where its kind takes some: a key of ``closed.REASONS``, or an empty text.
    """

    name: str
    kind: Kind
    table: str = ""
    group: str = ""
    master: str = ""
    low: float | None = None
    high: float | None = None
    label: str = ""
    closed: str = ""

    @property
    def fits(self) -> frozenset[str]:
        """The result types of blocks that may be plugged in."""
        return frozenset() if self.closed else self.kind.fits

    @property
    def pluggable(self) -> bool:
        """Whether a reporter block may be put into the slot."""
        return bool(self.fits)

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

    @property
    def unfolds(self) -> bool:
        """Whether it is words and fields that a block has once or not at all."""
        typed = (isinstance(part, str) or part.kind.typed for part in self.parts)
        return self.maximum == 1 and all(typed)

    @property
    def in_words(self) -> str:
        """What it says, with … for each slot but those of blocks below; empty for slots alone."""
        said = [part for part in self.parts if isinstance(part, str) and part.strip(" ,、")]
        if not said:
            return ""
        shown = [
            part if isinstance(part, str) else "…"
            for part in self.parts
            if isinstance(part, str) or part.kind.name != "body"
        ]
        return " ".join(word for word in shown if word).strip(" ,、")


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
        ends = _RANGE.fullmatch(more)
        if ends is None or float(ends["low"]) >= float(ends["high"]):
            raise SentenceError(f"slot “{name}”: a slider has its ends, slider(0..100)")
        return Slot(name, kind, group=group, low=float(ends["low"]), high=float(ends["high"]))
    if more:
        raise SentenceError(f"slot “{name}”: {kind_name} has nothing in parentheses")
    return Slot(name, kind, group=group)


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


# Definitions are read from TOML files, one file a category.
#
# [category]                      # id, title, colour, order, page ("behaviour" when absent)
# [choices.again]                 # tables of choices: value = "label"
# [blocks.say]                    # the block "<category id>.say"
# sentence = "{robot:robot} says {text:text} with {gesture:choice(say_gestures)}"
# shape = "statement"             # hat | statement | c | cap | reporter | boolean
# result = "number"               # of a reporter: number | text | list | colour | any
# help = "blocks/say"
# defaults = { text = "Hello" }   # what a new block holds
# minimum = { part = 2 }          # how often a group is there at least
# flags = ["takes_time"]          # see FLAGS
# call = { ... }                  # see below; or
# generator = "repeat"            # a function in generate/, by name
# translations = { de = "{robot} sagt {text} mit {gesture}" }    # see language.py

# The call that a block stands for, when it is one call of the robot API.
#
#     call = { on = "robot", method = "say", arguments = ["text"], keywords = { gesture = "face" } }
#     call = { function = "wait", arguments = ["seconds"] }
#
#     call = { on = "robot", method = "leds", arguments = ["group"], constants = { seconds = 1 } }
#
# ``arguments`` and ``keywords`` name slots. A keyword whose slot holds its default is left out
# when it is listed in ``optional``. ``constants`` are keywords that are the same in every such
# call: texts, numbers, true and false. Functions are those of nep_core; no other module can be
# reached.


class CallError(ValueError):
    """A call that cannot be made; its text says why."""


Constant = str | int | float | bool
_CALL_KEYS = frozenset(
    ("method", "on", "function", "arguments", "keywords", "optional", "constants")
)


@dataclass(frozen=True, slots=True)
class Call:
    """A function of nep_core, or a method of the robot in slot ``on``, with slots as arguments."""

    name: str
    on: str = ""
    arguments: tuple[str, ...] = ()
    keywords: Mapping[str, str] = field(default_factory=dict)
    optional: frozenset[str] = frozenset()
    constants: Mapping[str, Constant] = field(default_factory=dict)


def read_call(data: object, slots: Collection[str]) -> Call:
    """Check a call read from TOML against the slots of its block, or raise CallError."""
    if not isinstance(data, dict):
        raise CallError("call must be a table")
    unknown = set(data) - _CALL_KEYS
    if unknown:
        raise CallError(f"call has no key “{min(unknown)}”")
    if ("method" in data) == ("function" in data) or ("method" in data) != ("on" in data):
        raise CallError("call needs either a function, or a method and the slot it is called on")
    call = Call(
        _identifier(data.get("method", data.get("function"))),
        str(data.get("on", "")),
        tuple(_slot_names(data.get("arguments", []), slots)),
        _keywords(data.get("keywords", {}), slots),
        frozenset(_slot_names(data.get("optional", []), slots)),
        _constants(data.get("constants", {})),
    )
    if call.on and call.on not in slots:
        raise CallError(f"call is on slot “{call.on}”, which the sentence does not have")
    if not call.optional <= set(call.keywords.values()):
        raise CallError("optional slots must be among the keywords")
    if twice := call.constants.keys() & call.keywords.keys():
        raise CallError(f"“{min(twice)}” is a keyword and a constant")
    return call


def _keywords(data: object, slots: Collection[str]) -> dict[str, str]:
    if not isinstance(data, dict):
        raise CallError("keywords must be a table")
    _slot_names(list(data.values()), slots)
    return {_identifier(name): slot for name, slot in data.items()}


def _constants(data: object) -> dict[str, Constant]:
    if not isinstance(data, dict):
        raise CallError("constants must be a table")
    for name, value in data.items():
        if not isinstance(value, str | int | float | bool):
            raise CallError(f"the constant “{name}” must be a text, a number, true or false")
    return {_identifier(name): value for name, value in data.items()}


def _slot_names(data: object, slots: Collection[str]) -> list[str]:
    if not isinstance(data, list):
        raise CallError("arguments and optional must be lists of slots")
    for name in data:
        if name not in slots:
            raise CallError(f"call uses slot “{name}”, which the sentence does not have")
    return data


def _identifier(name: object) -> str:
    """Names from a file reach the code as they are, so that they must be plain public names."""
    plain = isinstance(name, str) and name.isascii() and name.isidentifier()
    if not plain or str(name).startswith("_") or keyword.iskeyword(str(name)):
        raise CallError(f"{name!a} is not the name of a function")
    return str(name)


Shape = Literal["hat", "statement", "c", "cap", "reporter", "boolean"]

FLAGS = {
    "takes_time": "the program waits at this block for a while",
    "loop": "its body is repeated",
    "needs_pause": "its body is repeated without end, so that it must take time",
    "silent": "it makes a comment, no code",
    "in_loop": "it belongs inside a loop",
    "apart": "its bodies are functions of their own",
    "guards": "its bodies are tried: Python counts two loops for it, of those in each other",
    "grows": "its body is made of parts of a behaviour tree",
    "of_tree": "it is a part of a behaviour tree",
    "takes_ports": "its body says what goes into a behaviour tree, and out of it",
    "of_ports": "it says what goes into a behaviour tree, or out of it",
    "in_step": "it belongs inside a step of a behaviour tree",
    "in_each_robot": "it belongs inside what is done for each robot",
    "last": "nothing after this block is ever reached",
    "stands": "the robot must stand",
    "stands_up": "the robot stands from then on",
    "rests": "the robot rests from then on, and cannot move",
    "needs_real_robot": "the robot on the screen cannot do it",
    "posture": "the choice in slot `posture` is the robot's posture from then on",
}


@dataclass(frozen=True, slots=True)
class Category:
    """A drawer of the palette; ``colour`` is a name of the theme's colour table."""

    id: str
    title: str
    colour: str
    order: int
    page: str


@dataclass(frozen=True, slots=True)
class Definition:
    """What every block of one type has in common."""

    id: str
    category: Category
    shape: Shape
    parts: tuple[Part, ...]
    slots: Mapping[str, Slot]
    groups: Mapping[str, Group]
    minimum: Mapping[str, int]
    defaults: Mapping[str, FieldValue]
    result: str = ""
    help: str = ""
    flags: frozenset[str] = frozenset()
    call: Call | None = None
    generator: str = ""
    translations: Mapping[str, str] = field(default_factory=dict)
    said: Mapping[str, str] = field(default_factory=dict)
    """Texts of ``defaults``, in the language of the person, by slot: a new block has these."""
    about: str = ""
    """What the block does in the words of who made it: of an own block."""
    kinds: frozenset[str] = field(init=False)
    """The names of the kinds of its slots."""
    page: str = field(init=False)
    """The page on which the block belongs."""
    is_value: bool = field(init=False)
    """Whether the block is plugged into inputs rather than put in chains."""
    is_last: bool = field(init=False)
    """Whether nothing may follow the block in its chain."""
    holds_python: bool = field(init=False)
    """Whether what stands in its fields of several letters is run as Python."""

    def __post_init__(self) -> None:
        # asked for at every edit, and the same for ever
        kinds = frozenset(slot.kind.name for slot in self.slots.values())
        object.__setattr__(self, "kinds", kinds)
        object.__setattr__(self, "page", self.category.page)
        object.__setattr__(self, "is_value", self.shape in ("reporter", "boolean"))
        is_code = self.category.id == "code" or self.generator.startswith("code_")
        object.__setattr__(self, "holds_python", is_code and not PYTHON_KINDS.isdisjoint(kinds))
        object.__setattr__(self, "is_last", self.shape == "cap" or "last" in self.flags)

    @property
    def in_words(self) -> str:
        """The block in words, for messages: its sentence with … for each slot that it has new."""
        shown = [p for p in self.parts if not (isinstance(p, Group) and p.unfolds)]
        words = [part if isinstance(part, str) else "…" for part in shown]
        return " ".join(word for word in words if word).replace(" ,", ",")

    def slot(self, key: str, groups: Mapping[str, int]) -> Slot | None:
        """The slot with this key in a block with so many groups, or None."""
        plain = self.slots.get(key)
        if plain is not None:  # most keys have no number
            return None if plain.group else plain
        name, number = split_slot(key)
        slot = self.slots.get(name)
        if slot is None:
            return None
        if not slot.group:
            return slot if number == 0 else None
        return slot if 1 <= number <= groups.get(slot.group, 0) else None

    def keys(self, groups: Mapping[str, int]) -> Iterator[tuple[str, Slot]]:
        """The slot keys of a block with so many groups, in the order of the sentence."""
        for part in self.parts:
            if isinstance(part, Slot):
                yield part.name, part
            elif isinstance(part, Group):
                inner = [slot for slot in part.parts if isinstance(slot, Slot)]
                for number in range(1, groups.get(part.name, 0) + 1):
                    yield from ((f"{slot.name}.{number}", slot) for slot in inner)

    def group_slots(self, group: str) -> tuple[str, ...]:
        """The names of the slots in a group."""
        return tuple(slot.name for slot in self.slots.values() if slot.group == group)

    def new_block(self, block_id: str, more: Mapping[str, int] | None = None) -> Block:
        """A block of this type with its default values; ``more`` says how often groups are there.

        A group that it does not name is there as often as it must be.
        """
        groups = {**self.minimum, **(more or {})}
        fields = {
            key: value
            for key, slot in self.keys(groups)
            if (value := self.beginning(slot.name)) is not None
        }
        return Block(block_id, self.id, fields, groups=groups)

    def beginning(self, slot: str) -> FieldValue | None:
        """What the field of a slot holds in a new block, or None."""
        return self.said.get(slot, self.defaults.get(slot))

    def robots_in(self, block: Block) -> Iterator[str]:
        """The robots that the fields of a block name, also where another block is plugged in."""
        for key, slot in self.keys(block.groups) if "robot" in self.kinds else ():
            if slot.kind.name == "robot":
                yield str(self.value(block, key))

    def value(self, block: Block, key: str) -> FieldValue | None:
        """What the field of a slot holds, or its default, or None when it has neither."""
        value = block.fields.get(key)
        return self.defaults.get(split_slot(key)[0]) if value is None else value
