"""Reads type signatures of NAOqi, such as ``(s[f]{sm})<Pose,name,angles,more>``, into trees."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from .errors import BadFrame

PLAIN = "vbcCwWiIlLfdsmroX_"
WRAPPED = {"[": "]", "{": "}", "(": ")"}
PREFIXES = "#~+"  # variadic, named and optional arguments: one type follows
LONGEST_TEXT = 16384
DEEPEST = 32
SIZES = {"b": 1, "c": 1, "C": 1, "w": 2, "W": 2, "i": 4, "I": 4, "f": 4, "d": 8, "l": 8, "L": 8}
SIZES |= {"s": 4, "m": 4, "r": 4, "o": 24, "[": 4, "{": 4, "#": 4, "~": 4, "+": 1}


@dataclass(frozen=True)
class Type:
    """One type: its letter, what it is made of, and the names that a structure's parts have.

    ``smallest`` is the fewest bytes that a value takes, ``weight`` how many values it makes.
    """

    letter: str
    parts: tuple[Type, ...] = ()
    names: tuple[str, ...] = ()

    @property
    def smallest(self) -> int:
        """The fewest bytes that a value of this type takes on the wire."""
        if self.letter == "(":
            return sum(part.smallest for part in self.parts)
        return SIZES.get(self.letter, 0)

    @property
    def weight(self) -> int:
        """How many values are made to hold one value of this type."""
        return 1 + sum(part.weight for part in self.parts)

    def __str__(self) -> str:
        inner = "".join(map(str, self.parts))
        text = f"{self.letter}{inner}{WRAPPED.get(self.letter, '')}"
        return f"{text}<{','.join(self.names)}>" if self.names else text


@lru_cache(maxsize=1024)
def parse_type(text: str) -> Type:
    """Return the type that a signature says. Raises BadFrame."""
    found, rest = take_type(text)
    if rest:
        raise BadFrame(f"“{text[:80]}” is not a type.")
    return found


def take_type(text: str) -> tuple[Type, str]:
    """Return the type at the start of a text, and what follows it. Raises BadFrame."""
    if len(text) > LONGEST_TEXT:
        raise BadFrame(f"A type of {len(text)} letters is too long.")
    found, end = _type_at(text, 0, 0)
    return found, text[end:]


def _type_at(text: str, start: int, depth: int) -> tuple[Type, int]:
    letter = text[start : start + 1]
    if not letter or depth > DEEPEST:
        raise BadFrame(f"“{text[:80]}” is not a type.")
    parts: list[Type] = []
    end = start + 1
    if letter in WRAPPED:
        while text[end : end + 1] != WRAPPED[letter]:
            part, end = _type_at(text, end, depth + 1)
            parts.append(part)
        end += 1
    elif letter in PREFIXES:
        part, end = _type_at(text, end, depth + 1)
        parts.append(part)
    elif letter not in PLAIN:
        raise BadFrame(f"“{text[:80]}” is not a type.")
    if len(parts) != {"[": 1, "{": 2}.get(letter, len(parts)):
        raise BadFrame(f"“{text[:80]}” is not a type.")
    names, end = _names_at(text, end)
    return Type(letter, tuple(parts), names), end


def _names_at(text: str, start: int) -> tuple[tuple[str, ...], int]:
    """Return the annotation ``<Name,part,part>`` at this place, if there is one."""
    if text[start : start + 1] != "<":
        return (), start
    depth = 0
    for place in range(start, len(text)):
        depth += (text[place] == "<") - (text[place] == ">")
        if depth == 0:
            return tuple(text[start + 1 : place].split(",")), place + 1
    raise BadFrame(f"“{text[:80]}” is not a type.")
