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
call = { ... }                  # see definition_call.py; or
generator = "repeat"            # a function in generate/, by name
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

from .definition_call import Call
from .program import Block, split_slot
from .sentence import Group, Part, Slot
from .values import FieldValue

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
