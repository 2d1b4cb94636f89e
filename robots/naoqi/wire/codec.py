"""NAOqi messages as bytes and as Python values; for every type a function each way."""

from __future__ import annotations

import keyword
import struct
from collections import namedtuple
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any, Protocol

from .errors import BadFrame, WrongArguments
from .types import DEEPEST, WHOLE, Type, is_object, parse_type, type_text_of

# Makes Python values of the bytes of NAOqi messages; for every type a function that reads it.

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
        return _read_number(NUMBERS[letter])
    if letter in "[#":
        element = kind.parts[0]
        smallest, weight = element.smallest, element.weight
        if element.letter in NUMBERS:
            return _read_numbers(NUMBERS[element.letter], smallest)
        read_element = _reader_of(element)

        def read(reader: Reader) -> list[Any]:
            return [read_element(reader) for _ in range(_checked_count(reader, smallest, weight))]

        return read
    if letter in "{~":
        return _read_map(*(kind.parts if letter == "{" else (Type("s"), kind.parts[0])))
    if letter == "(":
        return _read_structure(kind)
    if letter == "+":
        return _read_optional(_reader_of(kind.parts[0]))
    if letter in PLAIN_READERS:
        return PLAIN_READERS[letter]
    raise BadFrame("Values of the type “{kind}” cannot be read.", kind=kind)


def _read_number(code: str) -> Read:
    packed = struct.Struct("<" + code)
    size, unpack_from = packed.size, packed.unpack_from

    def read(reader: Reader) -> Any:
        (value,) = unpack_from(reader.data, reader.at)
        reader.at += size
        return value

    return read


def _read_text(reader: Reader) -> str:
    return reader.raw().decode("utf-8", "replace")


def _read_nothing(reader: Reader) -> None:
    return None


def _read_dynamic(reader: Reader) -> Any:
    text = reader.raw().decode("latin-1")
    if reader.depth > DEEPEST:
        raise BadFrame("A message holds values within values without end.")
    reader.depth += 1
    value = reader_of(text)(reader) if text else None
    reader.depth -= 1
    return value


def _read_object(reader: Reader) -> Any:
    from .metaobject import META_OBJECT, MetaObject

    meta = MetaObject.from_wire(reader_of(META_OBJECT)(reader))
    service, thing = reader.count(), reader.count()
    if reader.source is None:
        raise BadFrame("A message holds an object where none can be.")
    return reader.source.take_object(meta, service, thing)


PLAIN_READERS: dict[str, Read] = {
    "s": _read_text,
    "m": _read_dynamic,
    "r": Reader.raw,
    "v": _read_nothing,
    "_": _read_nothing,
    "o": _read_object,
}


def _checked_count(reader: Reader, smallest: int, weight: int) -> int:
    """Read how many elements follow; refuse more than the bytes that are left can hold."""
    count = reader.count()
    left = len(reader.data) - reader.at
    if count and (
        not smallest or count * smallest > left or count * weight > VALUES_PER_BYTE * left
    ):
        raise BadFrame("A message announces {count} values and ends before.", count=count)
    return count


def _read_numbers(code: str, size: int) -> Read:
    """Many numbers are read at once: robots send their joints so, fifty times a second."""

    def read(reader: Reader) -> list[Any]:
        count = _checked_count(reader, size, 1)
        values = struct.unpack_from(f"<{count}{code}", reader.data, reader.at)
        reader.at += count * size
        return list(values)

    return read


def _read_map(key: Type, value: Type) -> Read:
    smallest, weight = key.smallest + value.smallest, key.weight + value.weight
    read_key, read_value = _reader_of(key), _reader_of(value)

    def read(reader: Reader) -> dict[Any, Any]:
        count = _checked_count(reader, smallest, weight)
        return {read_key(reader): read_value(reader) for _ in range(count)}

    return read


def _read_structure(kind: Type) -> Read:
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


def _read_optional(read_part: Read) -> Read:
    is_there = _read_number("?")

    def read(reader: Reader) -> Any:
        return read_part(reader) if is_there(reader) else None

    return read


class ObjectHost(Protocol):
    """Makes objects reachable for the other side of a connection."""

    def give_object(self, value: Any) -> tuple[bytes, int, int]:
        """Return the encoded description of an object, its service and its number."""


Write = Callable[[bytearray, Any, ObjectHost | None], None]


def encode(type_text: str, value: Any, host: ObjectHost | None = None) -> bytes:
    """Return the bytes of a value as this type. Raises WrongArguments when it is not of it."""
    out = bytearray()
    try:
        writer_of(type_text)(out, value, host)
    except (struct.error, TypeError, ValueError, OverflowError, RecursionError) as problem:
        text = repr(value) if not isinstance(problem, RecursionError) else "This"
        raise WrongArguments(
            "{text} is not a value for this: {problem}.", text=text[:200], problem=problem
        ) from problem
    return bytes(out)


@lru_cache(maxsize=1024)
def writer_of(type_text: str) -> Write:
    """Return the function that writes values of a type. Raises BadFrame."""
    return _writer_of(parse_type(type_text))


def _writer_of(kind: Type) -> Write:
    letter = kind.letter
    if letter in NUMBERS:
        pack = struct.Struct("<" + NUMBERS[letter]).pack
        is_whole = letter in WHOLE

        def write(out: bytearray, value: Any, host: ObjectHost | None) -> None:
            if is_whole and isinstance(value, float):
                value = int(value)
            out += pack(value)

        def write_truth(out: bytearray, value: Any, host: ObjectHost | None) -> None:
            if not isinstance(value, bool | int | float):
                raise TypeError("neither true nor false")
            out.append(bool(value))

        return write_truth if letter == "b" else write
    if letter in "[#":
        return _write_list(kind.parts[0])
    if letter in "{~":
        return _write_map(*(kind.parts if letter == "{" else (Type("s"), kind.parts[0])))
    if letter == "(":
        return _write_structure(kind)
    if letter == "+":
        return _write_optional(_writer_of(kind.parts[0]))
    if letter in PLAIN_WRITERS:
        return PLAIN_WRITERS[letter]
    raise WrongArguments("Values of the type “{kind}” cannot be sent.", kind=kind)


def _write_text(out: bytearray, value: Any, host: ObjectHost | None) -> None:
    if not isinstance(value, str):
        raise TypeError("not a text")
    data = value.encode("utf-8", "replace")
    out += COUNT.pack(len(data))
    out += data


def _raw(out: bytearray, value: Any, host: ObjectHost | None) -> None:
    data = bytes(memoryview(value))
    out += COUNT.pack(len(data))
    out += data


def _write_nothing(out: bytearray, value: Any, host: ObjectHost | None) -> None:
    """Nothing is written for nothing."""


def _write_dynamic(out: bytearray, value: Any, host: ObjectHost | None) -> None:
    text = type_text_of(value)
    out += COUNT.pack(len(text))
    out += text.encode("latin-1")
    writer_of(text)(out, value.tolist() if hasattr(value, "tolist") else value, host)


def _write_object(out: bytearray, value: Any, host: ObjectHost | None) -> None:
    if host is None or not is_object(value):
        raise TypeError("not an object that can be sent")
    description, service, number = host.give_object(value)
    out += description
    out += COUNT.pack(service) + COUNT.pack(number)


PLAIN_WRITERS: dict[str, Write] = {
    "s": _write_text,
    "m": _write_dynamic,
    "r": _raw,
    "v": _write_nothing,
    "_": _write_nothing,
    "o": _write_object,
}


def _write_list(element: Type) -> Write:
    if element.letter in "iIlLfd":
        return _write_numbers(element.letter)
    write_element = _writer_of(element)

    def write(out: bytearray, value: Any, host: ObjectHost | None) -> None:
        values = _values_of(value)
        out += COUNT.pack(len(values))
        for one in values:
            write_element(out, one, host)

    return write


def _write_numbers(letter: str) -> Write:
    code, is_whole = NUMBERS[letter], letter in WHOLE

    def write(out: bytearray, value: Any, host: ObjectHost | None) -> None:
        values = _values_of(value)
        if is_whole:
            values = [int(one) if isinstance(one, float) else one for one in values]
        out += struct.pack(f"<I{len(values)}{code}", len(values), *values)

    return write


def _values_of(value: Any) -> list[Any] | tuple[Any, ...]:
    if isinstance(value, list | tuple):
        return value
    if isinstance(value, str | bytes | Mapping) or not hasattr(value, "__iter__"):
        raise TypeError("not a list")
    return list(value)


def _write_map(key: Type, value: Type) -> Write:
    write_key, write_part = _writer_of(key), _writer_of(value)

    def write(out: bytearray, value: Any, host: ObjectHost | None) -> None:
        if not isinstance(value, Mapping):
            raise TypeError("not a map")
        out += COUNT.pack(len(value))
        for one, part in value.items():
            write_key(out, one, host)
            write_part(out, part, host)

    return write


def _write_structure(kind: Type) -> Write:
    writes = [_writer_of(part) for part in kind.parts]
    count, names = len(writes), kind.names[1:]

    def write(out: bytearray, value: Any, host: ObjectHost | None) -> None:
        if isinstance(value, Mapping) and names:
            value = [value.get(name) for name in names]
        if not isinstance(value, list | tuple) or len(value) != count:
            raise TypeError(f"not {count} values")
        for write_part, part in zip(writes, value, strict=True):
            write_part(out, part, host)

    return write


def _write_optional(write_part: Write) -> Write:
    def write(out: bytearray, value: Any, host: ObjectHost | None) -> None:
        out.append(value is not None)
        if value is not None:
            write_part(out, value, host)

    return write
