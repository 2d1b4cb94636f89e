"""The pieces of which the Python of a statement block is made, in order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from ..program import Block
from .expressions import Expressions


@dataclass(frozen=True, slots=True)
class Body:
    """The chain of blocks in a slot; CPython limits how deep those of a ``loop`` are nested."""

    slot: str
    loop: bool = False


@dataclass(frozen=True, slots=True)
class Function:
    """A function without arguments whose body is the chain of blocks in a slot."""

    name: str
    slot: str


@dataclass(frozen=True, slots=True)
class Assignment:
    """A line that assigns to a variable of the whole program."""

    variable: str
    line: str


@dataclass(frozen=True, slots=True)
class Leave:
    """A line that leaves a loop or its round."""

    line: str


@dataclass(frozen=True, slots=True)
class GiveBack:
    """A line that gives the value of an own block."""

    line: str


@dataclass(frozen=True, slots=True)
class Written:
    """Lines that a person wrote, with the program's variables to which they assign.

    ``inside_texts`` are the lines, from 1, that begin inside a text: no margin goes before them.
    """

    lines: tuple[str, ...]
    inside_texts: frozenset[int]
    assigned: frozenset[str]


@dataclass(frozen=True, slots=True)
class Gap:
    """An empty line, to keep apart what does not belong together."""


Piece = str | Body | Function | Assignment | Leave | GiveBack | Written | Gap
StatementGenerator = Callable[[Expressions, Block], Sequence[Piece]]


def comment_lines(text: str) -> Iterator[str]:
    """A text as comments of Python; control characters could end a comment."""
    for line in text.splitlines():
        visible = "".join(c if c.isprintable() else " " for c in line).strip()
        if visible:
            yield f"# {visible}"
