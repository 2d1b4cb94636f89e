"""Changes that keep a format's frame right, so that they reach what is behind it.

Check sums, lengths and packing are made anew: else each change would be refused at the door, and
nothing behind it tried.
"""

from __future__ import annotations

import io
import random
import re
import struct
import zipfile
import zlib
from collections.abc import Sequence

from fuzz.mutations import (
    MANY,
    NUMBERS,
    TEXTS,
    flipped,
    json_changed,
    lines_changed,
    renumbered,
)

LARGEST_MODEL = 100_000
BOMB_BYTES = 200_000_000
"""What a bomb unpacks to, from some hundred kilobytes."""

# TOML: its values are changed where they stand.

_VALUES = (
    *(b"[" * MANY + b"]" * MANY, b"{a=" * 300 + b"1" + b"}" * 300, b"9" * 5000, b"1e999", b"nan"),
    *(b"inf", b"-inf", b"true", b"[]", b"{}", b"1979-05-27T07:32:00Z", b"07:32:00", b"0xff"),
    *(b'"""\n', b"''", b'"\\ud800"', b'"\xff"', b"[1, 'a', {}]", b"a.b.c", b'"\\u0000"', b"-0"),
    *(b"18446744073709551616", b"1e400", b'["x"]', b"{x = {y = {z = 1}}}"),
)  # fmt: skip
_LINE = re.compile(rb"(?m)^([^\n=\[]+=)([^\n]*)$")


def toml_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    """A TOML text with other values, or with changed lines."""
    for _ in range(chance.choice((1, 1, 2, 3))):
        lines = list(_LINE.finditer(data))
        match chance.randrange(7):
            case 0 | 1 if lines:
                line = chance.choice(lines)
                words = repr(chance.choice((*TEXTS, *NUMBERS))).encode(errors="replace")
                value = words if chance.random() < 0.4 else chance.choice(_VALUES)
                data = data[: line.start(2)] + b" " + value + data[line.end(2) :]
            case 2:
                data += b"\n[" + b"a." * chance.choice((1, 50, MANY)) + b"b]\nc = 1\n"
            case 3 if lines:
                line = chance.choice(lines)
                data = data[: line.end()] + b"\n" + line[0] + data[line.end() :]
            case 4:
                data = renumbered(data, chance)
            case _:
                data = lines_changed(data, chance, seeds)
    return data


# CSV: cells and columns.


def csv_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    """A table with a cell, a column, its separator or its head changed; or with many lines."""
    lines = data.split(b"\n")
    match chance.randrange(8):
        case 0 | 1:
            at = chance.randrange(len(lines))
            cells = lines[at].split(b",")
            told = chance.choice((*TEXTS, *map(repr, NUMBERS)))
            cells[chance.randrange(len(cells))] = told.encode(errors="surrogatepass")
            lines[at] = b",".join(cells)
        case 2:
            column = chance.randrange(8)
            lines = [b",".join(_without(line.split(b","), column)) for line in lines]
        case 3:
            lines = [
                line.replace(b",", chance.choice((b";", b"\t", b" ", b",,"))) for line in lines
            ]
        case 4:
            lines = lines * chance.choice((2, 30))
        case 5:
            cell = repr(chance.choice(NUMBERS)).encode()
            lines = [*lines[:4], *(b",".join([cell] * line.count(b",")) for line in lines[4:])]
        case 6:
            lines[:0] = [b"# " + chance.choice(TEXTS).encode(errors="replace") + b": yes"]
        case _:
            return lines_changed(data, chance, seeds)
    return b"\n".join(lines)


def _without(cells: list[bytes], column: int) -> list[bytes]:
    return [*cells[:column], *cells[column + 1 :]]


# MCAP: records of one byte of kind, eight of length, and content; chunks hold records, packed.

MCAP_MAGIC = b"\x89MCAP0\r\n"
_RECORD = struct.Struct("<BQ")
_CHUNK = 0x06
_CHUNK_HEAD = struct.Struct("<QQQI")


def mcap_records(data: bytes) -> list[tuple[int, bytes]]:
    """The records of a file, each with its kind, as far as they are whole."""
    found, at = [], len(MCAP_MAGIC)
    while at + _RECORD.size <= len(data):
        kind, size = _RECORD.unpack_from(data, at)
        if at + _RECORD.size + size > len(data):
            break
        found.append((kind, data[at + _RECORD.size : at + _RECORD.size + size]))
        at += _RECORD.size + size
    return found


def mcap_of(records: Sequence[tuple[int, bytes]]) -> bytes:
    """A file of these records."""
    parts = (_RECORD.pack(kind & 0xFF, len(body)) + body for kind, body in records)
    return MCAP_MAGIC + b"".join(parts) + MCAP_MAGIC


def mcap_chunk(
    inside: bytes, packing: bytes = b"", claimed: int | None = None
) -> tuple[int, bytes]:
    """A chunk that holds records as bytes; it may claim to unpack to another size."""
    packed = inside
    if packing == b"zstd":
        import zstandard

        packed = zstandard.compress(inside)
    elif packing == b"lz4":
        import lz4.frame

        packed = lz4.frame.compress(inside)
    size = len(inside) if claimed is None else claimed
    head = _CHUNK_HEAD.pack(0, 2**63, size % 2**64, zlib.crc32(inside))
    body = head + struct.pack("<I", len(packing)) + packing
    return _CHUNK, body + struct.pack("<Q", len(packed)) + packed


def mcap_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    """A recording with changed records, some of them packed in a chunk, or packed as a bomb."""
    records = mcap_records(data)
    if not records or chance.random() < 0.1:
        return flipped(data, chance, seeds)
    if chance.random() < 0.004:  # slow to make
        zeros = bytes(BOMB_BYTES // chance.choice((1, 4, 60)))
        claimed = chance.choice((None, 1000, 2**40))
        records[1:1] = [mcap_chunk(zeros, chance.choice((b"zstd", b"lz4")), claimed)]
        return mcap_of(records)
    for _ in range(chance.choice((1, 1, 2, 4))):
        at = chance.randrange(len(records))
        kind, body = records[at]
        match chance.randrange(7):
            case 0:
                records[at] = chance.choice((*range(16), 255)), body
            case 1:
                del records[at]
            case 2:
                records[at:at] = [chance.choice(records)]
            case 3:
                others = mcap_records(chance.choice(seeds)) or records
                records[at] = chance.choice(others)
            case _:
                records[at] = kind, flipped(body, chance, seeds)
        if not records:
            break
    if chance.random() < 0.5 and len(records) > 2:
        inside = mcap_of(records[1:-1])[len(MCAP_MAGIC) : -len(MCAP_MAGIC)]
        if chance.random() < 0.3:
            inside = flipped(inside, chance, seeds)
        claimed = chance.choice((None, None, 0, 10, 2**31, 2**63, 2**64 - 1))
        packing = chance.choice((b"", b"zstd", b"lz4", b"gz"))
        records = [records[0], mcap_chunk(inside, packing, claimed), records[-1]]
    return mcap_of(records)


# A gesture model: a ZIP archive of NumPy arrays, one of which is JSON.


def model_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    """A model with another array, other words, other members, or one that is a bomb."""
    if len(data) > LARGEST_MODEL:  # a bomb
        return flipped(data, chance, seeds)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = [(one.filename, archive.read(one)) for one in archive.infolist()]
    except Exception:  # a kept input that is no archive; that is what it was kept for
        return flipped(data, chance, seeds)
    if not members or chance.random() < 0.1:
        return flipped(data, chance, seeds)
    for _ in range(chance.choice((1, 1, 2, 3))):
        at = chance.randrange(len(members))
        name, content = members[at]
        match chance.randrange(8):
            case 0:
                del members[at]
            case 1:
                members[at] = chance.choice(members)[0], content
            case 2:
                members[at] = chance.choice((*TEXTS, "0.mean.npy"))[:300] or "x", content
            case 3:
                head = content.find(b"\n") + 1
                members[at] = name, _head_changed(content[:head], chance) + content[head:]
            case 4 if chance.random() < 0.02:
                members[at] = name, content + bytes(BOMB_BYTES // 5)
            case _ if name.startswith("about"):
                head = content.find(b"\n") + 1
                text = json_changed(content[head:], chance, [content[head:]])
                members[at] = name, _npy(text)
            case _:
                head = content.find(b"\n") + 1
                members[at] = name, content[:head] + flipped(content[head:], chance, seeds)
        if not members:
            break
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", chance.choice((0, 8))) as archive:
        for name, content in members:
            info = zipfile.ZipInfo(_sendable(name))
            archive.writestr(info, content, chance.choice((0, 8)))
    return file.getvalue()


def _sendable(name: str) -> str:
    return name.encode(errors="replace").decode()


_HEAD_NUMBER = re.compile(rb"\d+")


def _head_changed(head: bytes, chance: random.Random) -> bytes:
    """The head of an array with another shape or kind, as long as it was."""
    if chance.random() < 0.5:
        kinds = (b"<f8", b"<f4", b"<i8", b"|u1", b"<c16", b"|O", b"<U9", b"|V8", b"<m8")
        changed = re.sub(rb"'[<|>=]\w+'", b"'" + chance.choice(kinds) + b"'", head)
    else:
        shapes = (b"()", b"(0,)", b"(-1,)", b"(2,3)", b"(99999999999999999999,)", b"(1,)*9", b"[1]")
        changed = re.sub(rb"\([\d, ]*\)", chance.choice(shapes), head)
    return changed[: len(head) - 1].ljust(len(head) - 1) + b"\n" if len(head) > 1 else head


def _npy(content: bytes) -> bytes:
    import numpy as np

    file = io.BytesIO()
    np.save(file, np.frombuffer(content, np.uint8))
    return file.getvalue()


# PNG: chunks with their check sums; a project packed in one of them.

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_KEY = b"nep-studio-project\0"


def png_chunk(kind: bytes, body: bytes) -> bytes:
    """A chunk with its length and check sum."""
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    """A picture whose project, or what holds it, is changed; others as bytes."""
    begin = data.find(_KEY)
    if not data.startswith(_SIGNATURE) or begin < 8 or chance.random() < 0.2:
        return flipped(data, chance, seeds)
    (size,) = struct.unpack_from(">I", data, begin - 8)
    body = data[begin : begin + size]
    head, packed = body[: len(_KEY) + 4], body[len(_KEY) + 4 :]
    text = _unpacked(packed)
    match chance.randrange(6):
        case 0:
            head = flipped(head, chance, seeds)
        case 1:
            packed = flipped(packed, chance, seeds)
        case 2 if chance.random() < 0.05:
            packed = zlib.compress(bytes(BOMB_BYTES // chance.choice((1, 6))), 9)
        case 3:
            head, packed = _KEY + b"\0\0\0\0", json_changed(text, chance, [text])
        case _:
            packed = zlib.compress(json_changed(text, chance, [text]))
    chunk = png_chunk(b"iTXt", head + packed)
    if chance.random() < 0.1:
        chunk *= 2
    return data[: begin - 8] + chunk + data[begin + size + 4 :]


def _unpacked(packed: bytes) -> bytes:
    try:
        return zlib.decompressobj().decompress(packed, 1_000_000)
    except zlib.error:
        return b"{}"


# Python, as pupils write it.

_PIECES = (
    *("x = 5", "l = []", "while True:\n    pass", "if x = 0:", "for i in range(3):\n    print(i)"),
    *("import math", "def f(a, b=2, *c, **d):\n    return a", "class A:\n    pass", "return"),
    *("global x", "nonlocal y", "lambda: 0", "async def g():\n    await h()", "del x", "x: int"),
    *("x += 1", "x, y = 1, 2", "[a for a in b if c]", "f'{x!r:>{y}}'", "assert False", "raise X"),
    *("try:\n    pass\nexcept* E:\n    pass", "with a as b:\n    pass", "match x:\n    case _:"),
    *("@behavior.when_started\ndef r():\n    pass", "wait(1)", "robot.say('a')", "9 ** 9 ** 9"),
    *("x = " + "(" * 150 + ")" * 150, "x = " + "-" * 400 + "1", "1" * 5000, "not " * 200 + "x"),
    *("a" + ".b" * 300, "'" + "a" * 3000 + "'", "\t x", "  y = 1", "\\", "#", '"""', "x = 1;y = 2"),
    *("if " + " and ".join("abc" * 60) + ":\n    pass", "\uff58 = \uff11", "\f", "\0"),
    *("together(left, right)", "score = 0", "# comment", "else:", "elif x:", "pass", "break"),
)  # fmt: skip


def python_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    """A program with lines that somebody added, moved, indented or cut."""
    lines = data.decode(errors="replace").split("\n")
    for _ in range(chance.choice((1, 1, 2, 4))):
        at = chance.randrange(len(lines) + 1)
        here = lines[min(at, len(lines) - 1)] if lines else ""
        margin = here[: len(here) - len(here.lstrip())]
        match chance.randrange(9):
            case 0 | 1 | 2:
                piece = chance.choice(_PIECES).split("\n")
                lines[at:at] = [margin + line for line in piece]
            case 3:
                del lines[at : at + chance.choice((1, 1, 3))]
            case 4 if lines:
                lines[at:at] = [chance.choice(lines)]
            case 5 if at < len(lines):
                lines[at] = chance.choice(("    ", "  ", "\t", "")) + here.lstrip()
            case 6 if at < len(lines):
                words = re.split(r"(\W)", here)
                words[chance.randrange(len(words))] = chance.choice(
                    (*TEXTS, *_PIECES, "(", ")", ":")
                )
                lines[at] = "".join(words)
            case 7:
                other = chance.choice(seeds).decode(errors="replace").split("\n")
                begin = chance.randrange(len(other))
                lines[at:at] = other[begin : begin + 4]
            case _ if at < len(lines):
                name = chance.choice(("x", "robot", "wait", "behavior", "score", "left"))
                lines[at] = re.sub(r"\b[a-z_]+\b", name, here, count=1)
        if not lines:
            lines = [""]
    return "\n".join(lines).encode(errors="surrogatepass")
