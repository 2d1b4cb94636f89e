"""Reads type signatures of NAOqi, such as ``(s[f]{sm})<Pose,name,angles,more>``, into trees."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

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
        raise BadFrame("“{text}” is not a type.", text=text[:80])
    return found


def take_type(text: str) -> tuple[Type, str]:
    """Return the type at the start of a text, and what follows it. Raises BadFrame."""
    if len(text) > LONGEST_TEXT:
        raise BadFrame("A type of {count} letters is too long.", count=len(text))
    found, end = _type_at(text, 0, 0)
    return found, text[end:]


def _type_at(text: str, start: int, depth: int) -> tuple[Type, int]:
    letter = text[start : start + 1]
    if not letter or depth > DEEPEST:
        raise BadFrame("“{text}” is not a type.", text=text[:80])
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
        raise BadFrame("“{text}” is not a type.", text=text[:80])
    if len(parts) != {"[": 1, "{": 2}.get(letter, len(parts)):
        raise BadFrame("“{text}” is not a type.", text=text[:80])
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
    raise BadFrame("“{text}” is not a type.", text=text[:80])


# Says which NAOqi type a Python value has, and how well it fits a type that is asked for.

WHOLE = "cCwWiIlL"
FLOATING = "fd"
NUMERIC = "b" + WHOLE + FLOATING
SCALARS = {bool: "b", float: "d", str: "s", bytes: "r", bytearray: "r", type(None): "v"}
MARK = "naoqi_marks"
"""The attribute that marked methods, signals and properties have."""
MOST_ALIKE = 1000
"""Lists longer than this are not searched for one type that all elements share."""


def is_object(value: Any) -> bool:
    """Whether a value goes by reference: it has methods or signals of NAOqi."""
    kind: Any = type(value)
    return is_object_class(kind)


@lru_cache(maxsize=1024)
def is_object_class(kind: Hashable) -> bool:
    """Whether a class has methods, signals or properties that are marked for NAOqi."""
    members = [member for base in getattr(kind, "__mro__", ()) for member in vars(base).values()]
    return any(hasattr(member, MARK) for member in members)


def type_text_of(value: Any) -> str:
    """Return the type that a dynamic value is sent as. Raises TypeError."""
    kind = type(value)
    if kind in SCALARS:
        return SCALARS[kind]
    if kind is int:
        return _whole(value)
    if kind is list:
        return f"[{_shared(value)}]"
    if isinstance(value, Mapping):
        return f"{{{_shared(list(value))}{_shared(list(value.values()))}}}" if value else "{sm}"
    if isinstance(value, tuple):
        return f"({''.join(map(type_text_of, value))})"
    # Subclasses of the usual types, numpy's values, objects
    if is_object(value):
        return "o"
    if hasattr(value, "tolist"):
        return type_text_of(value.tolist())
    for usual, text in SCALARS.items():
        if isinstance(value, usual):
            return text
    if isinstance(value, int):
        return _whole(value)
    if isinstance(value, list):
        return type_text_of(list(value))
    raise TypeError(f"NAOqi has no type for {type(value).__name__}")


def _whole(value: int) -> str:
    if -(2**31) <= value < 2**31:
        return "i"
    return "l" if value < 2**63 else "L"


def _shared(values: list[Any]) -> str:
    """Return the type that all elements have, “m” when they differ."""
    kinds = set(map(type, values))
    if len(kinds) != 1:
        return "m"
    (kind,) = kinds
    if kind in SCALARS and kind is not type(None):
        return SCALARS[kind]
    if kind is int:
        whole = set(map(_whole, (min(values), max(values))))
        return whole.pop() if len(whole) == 1 else ("m" if "L" in whole else "l")
    if len(values) > MOST_ALIKE:
        return "m"
    texts = set(map(type_text_of, values))
    return texts.pop() if len(texts) == 1 and kind is list else "m"


def fit(value: Any, wanted: Type) -> float:
    """Return how well a value fits a type: 1 as it is, 0 not at all."""
    letter = wanted.letter
    if letter in "mX":
        return 0.9
    if letter == "+":
        return 1.0 if value is None else fit(value, wanted.parts[0])
    if letter in NUMERIC:
        if isinstance(value, bool):
            return 1.0 if letter == "b" else 0.92
        if not isinstance(value, int | float):
            return 0.0
        if letter == "b":
            return 0.91
        if isinstance(value, int):
            return 1.0 if letter in WHOLE else 0.95
        return 1.0 if letter in FLOATING else 0.93
    if letter in "[#":
        return _fit_all(value, wanted.parts[0]) if isinstance(value, list | tuple) else 0.0
    if letter in "{~":
        if not isinstance(value, Mapping):
            return 0.0
        key, part = wanted.parts if wanted.letter == "{" else (Type("s"), wanted.parts[0])
        return min(_fit_all(value, key), _fit_all(value.values(), part))
    if letter == "(":
        return _fit_structure(value, wanted)
    usual = {"s": str, "r": bytes | bytearray | memoryview, "v": type(None)}.get(letter)
    return float(is_object(value) if usual is None else isinstance(value, usual))


def _fit_all(values: Any, wanted: Type) -> float:
    return min((fit(value, wanted) for value in values), default=0.99)


def _fit_structure(value: Any, wanted: Type) -> float:
    if not isinstance(value, list | tuple) or len(value) != len(wanted.parts):
        return 0.0
    fits = [fit(one, part) for one, part in zip(value, wanted.parts, strict=True)]
    if not all(fits):
        return 0.0
    return sum(fits) / len(fits) if fits else 1.0
