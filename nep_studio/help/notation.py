"""Small programs written down line by line, as the examples of the help are.

    event.started
    robot.say text="Hello"
    control.if condition=(sensing.human_state_is state=touched_head)
      robot.say text="That tickles"
     otherwise_do.1:
      robot.play animation=nod

A line is a block with the values of its slots; what is indented more is inside it, in its first
mouth or in the one that a line ``mouth:`` names. A value in brackets is a block. Quoted texts are
for people and can be translated, bare words cannot. ``own p1 value "double" a1:x:number`` defines
an own block, which the lines below use as ``my.define.p1``, ``my.call.p1``, ``my.parameter.p1.a1``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from nep_studio.blocks.program import Parameter, Procedure

_TOKEN = re.compile(r'\s*("(?:[^"\\]|\\.)*"|[()=]|[^\s()="]+)')
_NUMBER = re.compile(r"-?\d+(\.\d+)?")


class NotationError(ValueError):
    """A line of an example that cannot be read; its text says which."""


class Quoted(str):
    """A text for people."""


Value = "str | int | float | bool | Sketch"


@dataclass
class Sketch:
    """A block as it was written down: its type, its values by slot, what is in its mouths."""

    type: str
    values: dict[str, str | int | float | bool | Sketch] = field(default_factory=dict)
    bodies: dict[str, list[Sketch]] = field(default_factory=dict)

    def types(self) -> Iterator[str]:
        """The type of this block and of all that are in it."""
        yield self.type
        for value in self.values.values():
            if isinstance(value, Sketch):
                yield from value.types()
        for body in self.bodies.values():
            for inner in body:
                yield from inner.types()


@dataclass
class Written:
    """A program as it was written down: its own blocks, and its stacks in their order."""

    procedures: list[Procedure] = field(default_factory=list)
    stacks: list[list[Sketch]] = field(default_factory=list)


FIRST_MOUTH = ""
"""Stands for the first mouth of a block, whatever it is called."""


def read(text: str) -> Written:
    """Read a program; stacks have an empty line between them. Raises NotationError."""
    written = Written()
    chain: list[Sketch] = []
    open_: list[tuple[int, list[Sketch]]] = []
    for line in text.splitlines():
        depth, said = len(line) - len(line.lstrip()), line.strip()
        if not said:
            chain, open_ = [], []
        elif said.startswith("own "):
            written.procedures.append(_procedure(_tokens(said)))
        else:
            if not open_:
                open_ = [(depth, chain)]
                written.stacks.append(chain)
            _take(said, depth, open_)
    return written


def _take(said: str, depth: int, open_: list[tuple[int, list[Sketch]]]) -> None:
    """Put a line where its indentation says."""
    while len(open_) > 1 and depth < open_[-1][0]:
        open_.pop()
    place, chain = open_[-1]
    if said.endswith(":"):
        open_.append((depth + 1, chain[-1].bodies.setdefault(said[:-1], [])))
        return
    if depth > place and chain and not _is_named(chain):
        inside = chain[-1].bodies.setdefault(FIRST_MOUTH, [])
        open_.append((depth, inside))
        chain = inside
    elif depth > place and chain:
        raise NotationError(f"“{said}” is indented, but in no mouth")
    chain.append(_sketch(said))


def _is_named(chain: list[Sketch]) -> bool:
    return FIRST_MOUTH in chain[-1].bodies


def _sketch(said: str) -> Sketch:
    tokens = _tokens(said)
    made = _block(tokens)
    if tokens:
        raise NotationError(f"“{said}”: what is {tokens[0]}?")
    return made


def _block(tokens: list[str]) -> Sketch:
    made = Sketch(tokens.pop(0))
    while tokens and tokens[0] != ")":
        name = tokens.pop(0)
        if len(tokens) < 2 or tokens.pop(0) != "=":
            raise NotationError(f"{made.type}: {name} has no value")
        made.values[name] = _value(tokens)
    return made


def _value(tokens: list[str]) -> str | int | float | bool | Sketch:
    token = tokens.pop(0)
    if token == "(":
        inner = _block(tokens)
        if not tokens or tokens.pop(0) != ")":
            raise NotationError(f"{inner.type} is not closed by )")
        return inner
    if token.startswith('"'):
        return Quoted(json.loads(token))
    if token in ("true", "false"):
        return token == "true"
    if _NUMBER.fullmatch(token):
        return float(token) if "." in token else int(token)
    return token


def _procedure(tokens: list[str]) -> Procedure:
    """``own p1 value "double" a1:x:number``: id, whether it gives a value, words, parameters."""
    _own, name, *rest = tokens
    gives_value = rest[:1] == ["value"]
    parts: list[str | Parameter] = []
    for token in rest[gives_value:]:
        if token.startswith('"'):
            parts.append(json.loads(token))
        else:
            parts.append(Parameter(*token.split(":")))
    return Procedure(name, tuple(parts), gives_value)


def _tokens(said: str) -> list[str]:
    found = _TOKEN.findall(said)
    if "".join(found).replace(" ", "") != re.sub(r"\s", "", said):
        raise NotationError(f"“{said}” cannot be read")
    return found
