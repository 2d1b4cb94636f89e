"""What blocks there are: definitions read from TOML files, one file a category.

[category]                      # id, title, colour, order, page ("behaviour" when absent)
[choices.again]                 # tables of choices: value = "label"
[blocks.say]                    # the block "<category id>.say"
sentence = "{robot:robot} says {text:text} with {gesture:choice(say_gestures)}"
shape = "statement"             # hat | statement | c | cap | reporter | boolean
result = "number"               # of a reporter: number | text | list | colour | any
help = "blocks/say"
defaults = { text = "Hello" }   # what a new block holds
minimum = { part = 2 }          # how often a group is there at least
flags = ["takes_time"]          # see FLAGS
call = { ... }                  # see below; or
generator = "repeat"            # a function in generate/, by name
translations = { de = "{robot} sagt {text} mit {gesture}" }    # see language.py
"""

from __future__ import annotations

import keyword
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

from .program import Block, split_slot
from .sentence import Group, Part, Slot
from .slots import FieldValue

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

    @property
    def page(self) -> str:
        """The page on which the block belongs."""
        return self.category.page

    @property
    def told(self) -> str:
        """The block in words, for messages: its sentence with … for each slot."""
        words = [part if isinstance(part, str) else "…" for part in self.parts]
        return " ".join(word for word in words if word).replace(" ,", ",")

    @property
    def is_value(self) -> bool:
        """Whether the block is plugged into inputs rather than put in chains."""
        return self.shape in ("reporter", "boolean")

    @property
    def is_last(self) -> bool:
        """Whether nothing may follow the block in its chain."""
        return self.shape == "cap" or "last" in self.flags

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

    def new_block(self, block_id: str) -> Block:
        """A block of this type with its default values."""
        groups = dict(self.minimum)
        fields = {
            key: self.defaults[slot.name]
            for key, slot in self.keys(groups)
            if slot.name in self.defaults
        }
        return Block(block_id, self.id, fields, groups=groups)

    def value(self, block: Block, key: str) -> FieldValue | None:
        """What the field of a slot holds, or its default, or None when it has neither."""
        value = block.fields.get(key)
        return self.defaults.get(split_slot(key)[0]) if value is None else value
