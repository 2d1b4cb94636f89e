"""Changes of inputs that fit any format, and the values that programs stumble over."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Callable, Sequence
from copy import deepcopy
from typing import Any

Mutate = Callable[[bytes, random.Random, Sequence[bytes]], bytes]
"""Changes an input by chance; the kept inputs are there to take parts from."""

MANY = 1200
"""Deeper than any parser that calls itself can go."""
DIGITS = 5000
"""More than Python makes a number of."""

BYTES = (
    *(b"\0", b"\xff", b"\xfe\xff", b"\x80", b"\xc3\x28", b"\xed\xa0\x80", b"\xef\xbb\xbf", b"\r"),
    *(b"\n", b"\x1b[31m", b"\x7f", b"\x00" * 8, b"\xff" * 8, b"\xff\xff\xff\x7f"),
    *(b"9" * DIGITS, b"-" * 300, b"[" * MANY, b'{"a":' * MANY, b"(" * 300, b"NaN", b"Infinity"),
    *(b"1e999", b"-1e-999", b"0x10", "\uff11".encode(), "\u2028".encode(), b'"', b"'", b"\\"),
)  # fmt: skip
TEXTS = (
    *("", " ", "\0", "\x1b[2J", "a" * 3000, "\u202eevil", "\ud800", "\udfff\ud800", "\ufeff"),
    *("\ufb01", "\uff11", "é" * 70, "\u2028", "../../x", "/", "{0}", "{a.b}", "%s", "__import__"),
    *("None", "class", "true", "nan", "inf", "-0", "1" * DIGITS, "1e400", "0x1f", "名前", "🤖"),
    *("\r\n", "\t", "a\nimport os", '"', "'''", "\\", "#", "$", "\U0010ffff", "a b", "NaN"),
)  # fmt: skip
NUMBERS: tuple[Any, ...] = (
    *(0, -0.0, 1, -1, 2, 0.1, 255, 256, 65535, 65536, 2**31 - 1, 2**31, 2**32, -(2**31) - 1),
    *(2**53 + 1, 2**63 - 1, 2**63, 2**64 - 1, 2**64, -(2**63) - 1, 10**30, 10**400, 1e308, -1e308),
    *(5e-324, 1e-300, 1e15, 1e16, 3.4e39, float("nan"), float("inf"), float("-inf")),
)  # fmt: skip


def nested(depth: int, value: Any = 0, key: str = "") -> Any:
    """A value within so many lists, or objects with a key."""
    for _ in range(depth):
        value = {key: value} if key else [value]
    return value


def odd_value(chance: random.Random) -> Any:
    """A value of JSON that hardly anybody expects."""
    match chance.randrange(12):
        case 0 | 1 | 2:
            return chance.choice(TEXTS)
        case 3 | 4 | 5:
            return chance.choice(NUMBERS)
        case 6:
            return chance.choice((None, True, False))
        case 7:
            return nested(chance.choice((2, 30, 120, 400)), 0, chance.choice(("", "a", "x")))
        case 8:
            return [odd_value(chance) for _ in range(chance.choice((0, 1, 3, 7)))]
        case 9:
            return {chance.choice(TEXTS): odd_value(chance) for _ in range(chance.randrange(4))}
        case 10:
            return [0] * chance.choice((1000, 5000))
    return chance.choice(("", [], {}, 0))


# Changes of bytes.


def flipped(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    """Bytes with a few changes that know nothing of what they mean."""
    changed = bytearray(data)
    for _ in range(chance.choice((1, 1, 1, 2, 3, 6))):
        at = chance.randrange(len(changed) + 1)
        match chance.randrange(10):
            case 0 if changed:
                changed[min(at, len(changed) - 1)] ^= 1 << chance.randrange(8)
            case 1 if changed:
                changed[min(at, len(changed) - 1)] = chance.randrange(256)
            case 2:
                changed[at:at] = chance.choice(BYTES)
            case 3:
                token = chance.choice(BYTES)
                changed[at : at + len(token)] = token
            case 4:
                del changed[at : at + chance.choice((1, 2, 4, 16, 100))]
            case 5:
                del changed[at:]
            case 6:
                part = changed[at : at + chance.choice((1, 8, 40, 200))]
                changed[at:at] = part * chance.choice((1, 2, 20))
            case 7:
                other = chance.choice(seeds)
                begin = chance.randrange(len(other) + 1)
                changed[at:at] = other[begin : begin + chance.choice((4, 30, 300))]
            case 8:
                size = chance.choice((1, 2, 4, 8))
                number = chance.choice((0, 1, 2 ** (8 * size) - 1, 2 ** (8 * size - 1), 1000))
                order: Any = chance.choice(("little", "big"))
                changed[at : at + size] = min(number, 2 ** (8 * size) - 1).to_bytes(size, order)
            case _:
                other = chance.choice(seeds)
                changed[at:] = other[chance.randrange(len(other) + 1) :]
    return bytes(changed)


_NUMBER = re.compile(rb"-?\d+(?:\.\d+)?")


def renumbered(data: bytes, chance: random.Random) -> bytes:
    """One of the numbers in a text is another."""
    places = list(_NUMBER.finditer(data))
    if not places:
        return data
    place = chance.choice(places)
    number = repr(chance.choice(NUMBERS)) if chance.random() < 0.9 else "1" * DIGITS
    return data[: place.start()] + number.encode() + data[place.end() :]


# Changes of values: JSON, and what can be written as it.


def changed_value(value: Any, chance: random.Random) -> Any:
    """A value of JSON with one place changed; what is given may change with it."""
    places = list(_places(value))
    if not places:
        return odd_value(chance)
    inside, key = chance.choice(places)
    match chance.randrange(8):
        case 0:
            del inside[key]
        case 1:
            other, where = chance.choice(places)
            inside[key] = deepcopy(other[where])  # else one could come to hold itself
        case 2 if isinstance(inside, dict):
            inside[chance.choice(TEXTS)] = inside.pop(key)
        case 2 if isinstance(inside, list):
            inside[key:key] = [inside[key]] * chance.choice((1, 3, 300))
        case 3:
            inside[key] = chance.choice(([inside[key]], {"a": inside[key]}, str(inside[key])[:200]))
        case 4 if isinstance(inside[key], str):
            text = inside[key]
            at = chance.randrange(len(text) + 1)
            inside[key] = text[:at] + chance.choice(TEXTS) + text[at:]
        case 5 if isinstance(inside[key], int | float):
            inside[key] = chance.choice(NUMBERS)
        case _:
            inside[key] = odd_value(chance)
    return value


def _places(value: Any, deepest: int = 12) -> list[tuple[Any, Any]]:
    found: list[tuple[Any, Any]] = []
    layer = [value]
    for _ in range(deepest):
        inner = []
        for one in layer:
            keys = (
                one if isinstance(one, dict) else range(len(one)) if isinstance(one, list) else ()
            )
            found += [(one, key) for key in keys]
            inner += [one[key] for key in keys]
        layer = inner
    return found


def as_json(value: Any) -> bytes:
    """A value as JSON, with all that JSON does not have: NaN, halves of letters, large numbers."""
    return _NUMERAL.sub(_long, json.dumps(value)).encode()


_NUMERAL = re.compile(r'"(1{5000})"')


def _long(found: re.Match[str]) -> str:
    return found[1]  # a number of so many digits, not the text


def json_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    """A JSON text with a few places changed; one that is none, as bytes."""
    try:
        value = json.loads(data)
    except (ValueError, RecursionError):
        return flipped(data, chance, seeds)
    try:
        for _ in range(chance.choice((1, 1, 1, 2, 4))):
            value = changed_value(value, chance)
        text = as_json(value)
    except RecursionError:  # deep things within each other
        return b"[" * MANY + data
    return flipped(text, chance, seeds) if chance.random() < 0.05 else text


def lines_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    """Lines with some left out, twice, elsewhere, from another text, or changed inside."""
    lines = data.split(b"\n")
    for _ in range(chance.choice((1, 1, 2, 3))):
        at = chance.randrange(len(lines))
        match chance.randrange(8):
            case 0 if len(lines) > 1:
                del lines[at]
            case 1:
                lines[at:at] = [lines[at]] * chance.choice((1, 2, 40))
            case 2:
                other = chance.choice(seeds).split(b"\n")
                lines[at:at] = other[chance.randrange(len(other)) :][:3]
            case 3:
                to = chance.randrange(len(lines))
                lines[at], lines[to] = lines[to], lines[at]
            case 4:
                lines[at] = flipped(lines[at], chance, seeds)
            case 5:
                lines[at] = renumbered(lines[at], chance)
            case 6:
                lines[at] = json_changed(lines[at], chance, seeds)
            case _:
                words = re.split(rb"(\W+)", lines[at])
                words[chance.randrange(len(words))] = chance.choice(TEXTS).encode(
                    errors="surrogatepass"
                )
                lines[at] = b"".join(words)
    return b"\n".join(lines)
