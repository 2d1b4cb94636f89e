"""Makes Python values of the bytes of NAOqi messages; for every type a function that reads it."""

from __future__ import annotations

import keyword
import struct
from collections import namedtuple
from collections.abc import Callable
from functools import lru_cache
from typing import Any, Protocol

from .errors import BadFrame
from .types import DEEPEST, Type, parse_type

NUMBERS = {
    "b": "?",
    "c": "b",
    "C": "B",
    "w": "h",
    "W": "H",
    "i": "i",
    "I": "I",
    "f": "f",
    "l": "q",
    "L": "Q",
    "d": "d",
}
COUNT = struct.Struct("<I")
MOST_NAMES = 64
"""Structures with more parts than this are tuples without names."""
VALUES_PER_BYTE = 8
"""How many values a byte may stand for at most: types of empty structures could make endless."""


class ObjectSource(Protocol):
    """Makes usable objects of references that arrive."""

    def take_object(self, meta: Any, service: int, thing: int) -> Any:
        """Return an object that calls the one which a message refers to."""


class Reader:
    """The bytes of a message, and how far they have been read."""

    __slots__ = ("at", "data", "depth", "source")

    def __init__(self, data: bytes, source: ObjectSource | None = None) -> None:
        self.data = data
        self.at = 0
        self.depth = 0
        self.source = source

    def count(self) -> int:
        """Read the number of what follows."""
        (value,) = COUNT.unpack_from(self.data, self.at)
        self.at += 4
        return int(value)

    def raw(self) -> bytes:
        """Read bytes that follow their number."""
        start = self.at + 4
        end = start + self.count()
        if end > len(self.data):
            raise BadFrame("A message ends within a text.")
        self.at = end
        return self.data[start:end]


Read = Callable[[Reader], Any]


def decode(type_text: str, data: bytes, source: ObjectSource | None = None) -> Any:
    """Return the value of this type that the bytes hold. Raises BadFrame."""
    return read_value(reader_of(type_text), Reader(data, source))


def read_value(read: Read, reader: Reader) -> Any:
    """Read one value. Raises BadFrame, whatever the bytes are."""
    try:
        return read(reader)
    except struct.error as problem:
        raise BadFrame("A message ends within a value.") from problem
    except RecursionError as problem:
        raise BadFrame("A message holds values within values without end.") from problem
    except TypeError as problem:  # a map whose keys are lists
        raise BadFrame("A message holds a map with keys that cannot be keys.") from problem


@lru_cache(maxsize=1024)
def reader_of(type_text: str) -> Read:
    """Return the function that reads values of a type. Raises BadFrame."""
    return _reader_of(parse_type(type_text))


def _reader_of(kind: Type) -> Read:
    letter = kind.letter
    if letter in NUMBERS:
        return _number(NUMBERS[letter])
    if letter in "[#":
        return _list(kind.parts[0])
    if letter in "{~":
        return _map(*(kind.parts if letter == "{" else (Type("s"), kind.parts[0])))
    if letter == "(":
        return _structure(kind)
    if letter == "+":
        return _optional(_reader_of(kind.parts[0]))
    if letter in PLAIN_READERS:
        return PLAIN_READERS[letter]
    raise BadFrame(f"Values of the type “{kind}” cannot be read.")


def _number(code: str) -> Read:
    packed = struct.Struct("<" + code)
    size, unpack_from = packed.size, packed.unpack_from

    def read(reader: Reader) -> Any:
        (value,) = unpack_from(reader.data, reader.at)
        reader.at += size
        return value

    return read


def _text(reader: Reader) -> str:
    return reader.raw().decode("utf-8", "replace")


def _nothing(reader: Reader) -> None:
    return None


def _dynamic(reader: Reader) -> Any:
    text = reader.raw().decode("latin-1")
    if reader.depth > DEEPEST:
        raise BadFrame("A message holds values within values without end.")
    reader.depth += 1
    value = reader_of(text)(reader) if text else None
    reader.depth -= 1
    return value


def _object(reader: Reader) -> Any:
    from .metaobject import META_OBJECT, MetaObject

    meta = MetaObject.from_wire(reader_of(META_OBJECT)(reader))
    service, thing = reader.count(), reader.count()
    if reader.source is None:
        raise BadFrame("A message holds an object where none can be.")
    return reader.source.take_object(meta, service, thing)


PLAIN_READERS: dict[str, Read] = {
    "s": _text,
    "m": _dynamic,
    "r": Reader.raw,
    "v": _nothing,
    "_": _nothing,
    "o": _object,
}


def _checked_count(reader: Reader, smallest: int, weight: int) -> int:
    """Read how many elements follow; refuse more than the bytes that are left can hold."""
    count = reader.count()
    left = len(reader.data) - reader.at
    if count and (
        not smallest or count * smallest > left or count * weight > VALUES_PER_BYTE * left
    ):
        raise BadFrame(f"A message announces {count} values and ends before.")
    return count


def _list(element: Type) -> Read:
    smallest, weight = element.smallest, element.weight
    if element.letter in NUMBERS:
        return _numbers(NUMBERS[element.letter], smallest)
    read_element = _reader_of(element)

    def read(reader: Reader) -> list[Any]:
        return [read_element(reader) for _ in range(_checked_count(reader, smallest, weight))]

    return read


def _numbers(code: str, size: int) -> Read:
    """Many numbers are read at once: robots send their joints so, fifty times a second."""

    def read(reader: Reader) -> list[Any]:
        count = _checked_count(reader, size, 1)
        values = struct.unpack_from(f"<{count}{code}", reader.data, reader.at)
        reader.at += count * size
        return list(values)

    return read


def _map(key: Type, value: Type) -> Read:
    smallest, weight = key.smallest + value.smallest, key.weight + value.weight
    read_key, read_value = _reader_of(key), _reader_of(value)

    def read(reader: Reader) -> dict[Any, Any]:
        count = _checked_count(reader, smallest, weight)
        return {read_key(reader): read_value(reader) for _ in range(count)}

    return read


def _structure(kind: Type) -> Read:
    reads = [_reader_of(part) for part in kind.parts]
    is_named = len(kind.names) == len(reads) + 1 <= MOST_NAMES and "".join(kind.names).isascii()
    make = _named(kind.names) if is_named else None

    def read(reader: Reader) -> tuple[Any, ...]:
        return tuple([read_part(reader) for read_part in reads])

    def read_named(reader: Reader) -> tuple[Any, ...]:
        assert make is not None
        return make([read_part(reader) for read_part in reads])

    return read_named if make else read


def _named(names: tuple[str, ...]) -> Callable[[list[Any]], tuple[Any, ...]]:
    """Return what makes a tuple with names, also of names that Python does not allow."""
    is_name = names[0].isidentifier() and not keyword.iskeyword(names[0])
    name = names[0] if is_name else "Structure"
    make_class: Callable[..., Any] = namedtuple  # mypy wants names that it can read
    make: Callable[[list[Any]], tuple[Any, ...]] = make_class(name, names[1:], rename=True)._make
    return make


def _optional(read_part: Read) -> Read:
    is_there = _number("?")

    def read(reader: Reader) -> Any:
        return read_part(reader) if is_there(reader) else None

    return read
