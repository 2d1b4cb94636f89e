"""A program as plain data: pages of stacks of blocks, flat, each with an id that stays.

A block is in exactly one place: in the chain of a stack, in the chain of another block's body, or
plugged into another block's input. ``Project.parents`` says where. Slots inside a repeated group
are numbered from 1: ``also_do.2``. Only edits.py changes a project.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import msgspec

from .slots import FieldValue

PAGES = ("behaviour", "robots", "nodes")

FARTHEST = 1e6
"""How far from the page's corner a stack can lie, in canvas units."""

ROBOT_BLOCK = "robots.robot"
"""The block of the Robots page that says which robot takes part."""
LANGUAGE = "language"
"""The key of a project's file for the language in which its program tells values."""
LANGUAGES = ("en", "de", "es", "fr", "it", "ja")
ALL_ROBOTS = "*"
"""The value of a robot field that means every robot of the Robots page."""


ON_ERROR = "on_error"
"""Under which key of the file a project keeps that an error of one rule shall "end" them all."""

FIRST_BLOCKS = "first_blocks"
"""Under which key of the file a project keeps the types of its first blocks: a list of texts."""
MOST_FIRST = 60


class Block(msgspec.Struct, omit_defaults=True):
    """One block.

    ``fields`` are values chosen or typed by slot, ``inputs`` plugged blocks by slot, ``bodies``
    chains of blocks by slot (never an empty one), ``groups`` how often each group of the sentence
    is there; a comment of size 0 is as large as it needs to be; ``extra`` are keys of the file
    that this version does not know: never changed, saved as they were.
    """

    id: str
    type: str
    fields: dict[str, FieldValue] = {}
    inputs: dict[str, str] = {}
    bodies: dict[str, list[str]] = {}
    groups: dict[str, int] = {}
    disabled: bool = False
    collapsed: bool = False
    comment: str = ""
    comment_width: float = 0
    comment_height: float = 0
    extra: dict[str, Any] = {}

    def children(self) -> Iterator[str]:
        """The blocks that are directly inside this one, inputs first."""
        yield from self.inputs.values()
        for chain in self.bodies.values():
            yield from chain

    def copy(self) -> Block:
        """A block of the same content that can be changed apart from this one."""
        return msgspec.structs.replace(
            self,
            fields={slot: _own(value) for slot, value in self.fields.items()},
            inputs=dict(self.inputs),
            bodies={slot: list(chain) for slot, chain in self.bodies.items() if chain},
            groups=dict(self.groups),
        )


class Stack(msgspec.Struct):
    """A chain of blocks at a place on a page, in canvas units from the page's corner."""

    id: str
    x: float
    y: float
    body: list[str]


SCOPE_PROGRAM, SCOPE_KEPT = "program", "kept"
"""Scopes of variables that belong to the whole program, and to all its runs."""


class Variable(msgspec.Struct, omit_defaults=True):
    """A value with a name; blocks name it by its id.

    ``scope`` says where it is known: usually (an empty text, or one that this version does not
    know) by itself wherever it is always set first, else in the whole program.
    """

    id: str
    name: str
    scope: str = ""


class Parameter(msgspec.Struct, frozen=True):
    """A value that a call of an own block brings; its kind is one of PARAMETER_KINDS."""

    id: str
    name: str
    kind: str = "any"


class Origin(msgspec.Struct, frozen=True, omit_defaults=True):
    """Which block of which pack an own block is a copy of; ``title`` is the pack's."""

    pack: str
    block: str
    version: int = 1
    title: str = ""


class Procedure(msgspec.Struct, frozen=True):
    """An own block: the words and parameters of its sentence, and whether it gives a value.

    ``help`` says what it does; ``sentences`` are its sentence in other languages by their codes,
    with the ids of its parameters in braces; ``extra`` are keys of the file that this version does
    not know, saved as they were.
    """

    id: str
    parts: tuple[str | Parameter, ...]
    gives_value: bool = False
    help: str = ""
    sentences: dict[str, str] = {}
    origin: Origin | None = None
    extra: dict[str, Any] = {}


class Note(msgspec.Struct, frozen=True):
    """A note on a page, in canvas units from the page's corner."""

    id: str
    page: str
    x: float
    y: float
    width: float
    height: float
    text: str = ""


class Parent(NamedTuple):
    """Where a block is: in a stack (``slot`` is empty) or in a slot of another block."""

    owner: str
    slot: str = ""


@dataclass(slots=True)
class Changes:
    """What a step changed: whole stacks, and in them the blocks (or stacks) changed themselves.

    ``notes`` are the ids of notes. ``whole`` says that something of the project as a whole
    changed: its name, variables, own blocks, pages. ``kept`` are the keys of what is kept beside
    the program.
    """

    stacks: set[str] = field(default_factory=set)
    owners: set[str] = field(default_factory=set)
    notes: set[str] = field(default_factory=set)
    whole: bool = False
    kept: set[str] = field(default_factory=set)

    def __bool__(self) -> bool:
        return bool(self.stacks or self.owners or self.notes or self.whole)

    def add(self, later: Changes) -> None:
        """Take in what a later step changed."""
        self.stacks |= later.stacks
        self.owners |= later.owners
        self.notes |= later.notes
        self.whole |= later.whole
        self.kept |= later.kept


class Project:
    """A program: its name, its variables, its own blocks, its notes, and pages of stacks.

    The order of ``pages`` is theirs on the screen; ``page_titles`` has the titles that people
    gave; ``extra`` are keys of the file that this version does not know, saved as they were.
    """

    def __init__(self, name: str = "Untitled") -> None:
        self.name = name
        self.variables: list[Variable] = []
        self.procedures: dict[str, Procedure] = {}
        self.procedure_revision = 0
        """How often the own blocks have changed; never goes back, not even by undo."""
        self.notes: dict[str, Note] = {}
        self.pages: dict[str, list[Stack]] = {page: [] for page in PAGES}
        self.page_titles: dict[str, str] = {}
        self.blocks: dict[str, Block] = {}
        self.stacks: dict[str, Stack] = {}
        self.parents: dict[str, Parent] = {}
        self.revisions: dict[str, int] = {}
        """How often each stack has changed; never goes back, not even by undo."""
        self.changes = Changes()
        """What has changed since History told its listeners last."""
        self.extra: dict[str, Any] = {}
        self.extra_revision = 0
        """How often ``extra`` has changed; never goes back, not even by undo."""
        self._last_id = 0

    @property
    def ends_on_error(self) -> bool:
        """Whether an error of one rule ends the whole program; usually the others go on."""
        return self.extra.get(ON_ERROR) == "end"

    @property
    def spoken_language(self) -> str:
        """The code of the language in which the program tells values; English when not known."""
        code = self.extra.get(LANGUAGE)
        return code if isinstance(code, str) and code in LANGUAGES else LANGUAGES[0]

    @property
    def first_blocks(self) -> tuple[str, ...]:
        """The types of blocks that the project wants to be offered first; empty: the usual ones.

        They may be of blocks that there are not, as a stranger may have written them.
        """
        kept = self.extra.get(FIRST_BLOCKS)
        types = kept[:MOST_FIRST] if isinstance(kept, list) else []
        return tuple(dict.fromkeys(one for one in types if isinstance(one, str)))

    def new_id(self, prefix: str) -> str:
        """An id that nothing in this project has had: prefix and number."""
        self._last_id += 1
        return f"{prefix}{self._last_id}"

    def id_seen(self, some_id: str) -> None:
        """Remember that an id is used, so that new_id never gives it again."""
        digits = some_id.lstrip("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_-")
        if digits.isascii() and digits.isdecimal() and len(digits) < 16:
            self._last_id = max(self._last_id, int(digits))

    def stack_of(self, some_id: str) -> Stack:
        """The stack in which a block is, however deep; a stack is in itself."""
        owner = some_id
        while owner in self.parents:
            owner = self.parents[owner].owner
        return self.stacks[owner]

    def kind_of_page(self, page: str) -> str:
        """What belongs on a page: behaviour, robots or nodes; added pages are for behaviour."""
        return page if page in PAGES else "behaviour"

    def page_of(self, some_id: str) -> str:
        """The name of the page on which a block or a stack is."""
        stack = self.stack_of(some_id)
        return next(page for page, stacks in self.pages.items() if stack in stacks)

    def chain_of(self, parent: Parent) -> list[str] | None:
        """The chain of blocks at a place (the list itself), or None when it is an input."""
        if not parent.slot:
            return self.stacks[parent.owner].body
        return self.blocks[parent.owner].bodies.get(parent.slot)

    def within(self, roots: Sequence[str], *, enabled: bool = False) -> Iterator[Block]:
        """The blocks of a chain and all that is inside them, each before what it contains.

        With ``enabled``, disabled blocks are left out with all that is inside them.
        """
        blocks, waiting = self.blocks, list(reversed(roots))
        while waiting:
            block = blocks[waiting.pop()]
            if enabled and block.disabled:
                continue
            yield block
            for chain in reversed(block.bodies.values()):
                waiting += reversed(chain)
            if block.inputs:
                waiting += reversed(block.inputs.values())

    def plugged(self, block: Block, key: str) -> Block | None:
        """The block plugged into a slot, or None; a disabled one does not count."""
        block_id = block.inputs.get(key)
        plugged = self.blocks[block_id] if block_id else None
        return None if plugged is None or plugged.disabled else plugged

    def variable(self, variable_id: str) -> Variable | None:
        """The variable with this id, or None."""
        return next((v for v in self.variables if v.id == variable_id), None)

    def touch(self, stack_id: str, owner: str = "") -> None:
        """Say that a stack has changed, in the block ``owner`` or in its own chain."""
        self.revisions[stack_id] = self.revisions.get(stack_id, 0) + 1
        self.changes.stacks.add(stack_id)
        self.changes.owners.add(owner or stack_id)

    def touch_procedures(self) -> None:
        """Say that the own blocks have changed."""
        self.procedure_revision += 1
        self.changes.whole = True


LONGEST_NUMBER = 9
"""Digits of a number in an id or a slot's key; Python refuses to read thousands of them."""


def split_slot(key: str) -> tuple[str, int]:
    """Take ``also_do.2`` apart into its name and number; the number is 0 outside groups."""
    if "." not in key:
        return key, 0
    name, dot, number = key.partition(".")
    is_number = dot and number.isdecimal() and len(number) <= LONGEST_NUMBER
    return (name, int(number)) if is_number else (key, 0)


def _own(value: FieldValue) -> FieldValue:
    return dict(value) if isinstance(value, dict) else value
