"""Makes the bytes of NAOqi messages of Python values; for every type a function that writes it."""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any, Protocol

from .decoding import COUNT, NUMBERS
from .errors import WrongArguments
from .inference import WHOLE, is_object, type_text_of
from .types import Type, parse_type


class ObjectHost(Protocol):
    """Makes objects reachable for the other side of a connection."""

    def give_object(self, value: Any) -> tuple[bytes, int, int]:
        """Return the encoded description of an object, its service and its number."""


Write = Callable[[bytearray, Any, ObjectHost | None], None]


def encode(type_text: str, value: Any, host: ObjectHost | None = None) -> bytes:
    """Return the bytes of a value as this type. Raises WrongArguments when it is not of it."""
    out = bytearray()
    write_value(writer_of(type_text), out, value, host)
    return bytes(out)


def write_value(write: Write, out: bytearray, value: Any, host: ObjectHost | None) -> None:
    """Write one value. Raises WrongArguments, whatever the value is."""
    try:
        write(out, value, host)
    except (struct.error, TypeError, ValueError, OverflowError, RecursionError) as problem:
        text = repr(value) if not isinstance(problem, RecursionError) else "This"
        raise WrongArguments(f"{text[:200]} is not a value for this: {problem}.") from problem


@lru_cache(maxsize=1024)
def writer_of(type_text: str) -> Write:
    """Return the function that writes values of a type. Raises BadFrame."""
    return _writer_of(parse_type(type_text))


def _writer_of(kind: Type) -> Write:
    letter = kind.letter
    if letter in NUMBERS:
        return _number(letter)
    if letter in "[#":
        return _list(kind.parts[0])
    if letter in "{~":
        return _map(*(kind.parts if letter == "{" else (Type("s"), kind.parts[0])))
    if letter == "(":
        return _structure(kind)
    if letter == "+":
        return _optional(_writer_of(kind.parts[0]))
    if letter in PLAIN_WRITERS:
        return PLAIN_WRITERS[letter]
    raise WrongArguments(f"Values of the type “{kind}” cannot be sent.")


def _number(letter: str) -> Write:
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


def _text(out: bytearray, value: Any, host: ObjectHost | None) -> None:
    if not isinstance(value, str):
        raise TypeError("not a text")
    data = value.encode("utf-8", "replace")
    out += COUNT.pack(len(data))
    out += data


def _raw(out: bytearray, value: Any, host: ObjectHost | None) -> None:
    data = bytes(memoryview(value))
    out += COUNT.pack(len(data))
    out += data


def _nothing(out: bytearray, value: Any, host: ObjectHost | None) -> None:
    """Nothing is written for nothing."""


def _dynamic(out: bytearray, value: Any, host: ObjectHost | None) -> None:
    text = type_text_of(value)
    out += COUNT.pack(len(text))
    out += text.encode("latin-1")
    writer_of(text)(out, value.tolist() if hasattr(value, "tolist") else value, host)


def _object(out: bytearray, value: Any, host: ObjectHost | None) -> None:
    if host is None or not is_object(value):
        raise TypeError("not an object that can be sent")
    description, service, number = host.give_object(value)
    out += description
    out += COUNT.pack(service) + COUNT.pack(number)


PLAIN_WRITERS: dict[str, Write] = {
    "s": _text,
    "m": _dynamic,
    "r": _raw,
    "v": _nothing,
    "_": _nothing,
    "o": _object,
}


def _list(element: Type) -> Write:
    if element.letter in "iIlLfd":
        return _numbers(element.letter)
    write_element = _writer_of(element)

    def write(out: bytearray, value: Any, host: ObjectHost | None) -> None:
        values = _values_of(value)
        out += COUNT.pack(len(values))
        for one in values:
            write_element(out, one, host)

    return write


def _numbers(letter: str) -> Write:
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


def _map(key: Type, value: Type) -> Write:
    write_key, write_part = _writer_of(key), _writer_of(value)

    def write(out: bytearray, value: Any, host: ObjectHost | None) -> None:
        if not isinstance(value, Mapping):
            raise TypeError("not a map")
        out += COUNT.pack(len(value))
        for one, part in value.items():
            write_key(out, one, host)
            write_part(out, part, host)

    return write


def _structure(kind: Type) -> Write:
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


def _optional(write_part: Write) -> Write:
    def write(out: bytearray, value: Any, host: ObjectHost | None) -> None:
        out.append(value is not None)
        if value is not None:
            write_part(out, value, host)

    return write
