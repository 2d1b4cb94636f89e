"""Picture files: a program in a PNG or SVG file, and words of an SVG file that keep their width.

In a PNG file a program is an iTXt chunk with its text, found without decoding the picture.
"""

from __future__ import annotations

import base64
import binascii
import html
import logging
import re
import struct
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path

from faults.files import content

log = logging.getLogger(__name__)


SIGNATURE = b"\x89PNG\r\n\x1a\n"
KEY = b"nep-studio-project"
LARGEST_PROJECT = 64_000_000
"""More bytes than any program has; what is larger is a file made to do harm."""
_MOST_UNPACKED, _MOST_PACKED = 2_000_000, 50
"""A program is unpacked to 2 MB, or to 50 times what it takes in the picture: blocks pack by 15."""


def png_with_program(png: bytes, program: bytes) -> bytes:
    """A PNG file with a program in it, right behind its header."""
    end = _end_of_header(png)
    if end == 0:
        raise ValueError("this is no PNG file")
    text = zlib.compress(program, 9)
    body = KEY + b"\0" + b"\x01\x00" + b"\0" + b"\0" + text  # packed, no language, no other key
    return png[:end] + _chunk(b"iTXt", body) + png[end:]


def program_in_png(png: bytes) -> bytes | None:
    """The program in a PNG file; None when there is none, or it is damaged."""
    for kind, body in _chunks(png):
        if kind == b"iTXt" and body.startswith(KEY + b"\0"):
            return _text_of(body[len(KEY) + 1 :])
    return None


def _text_of(rest: bytes) -> bytes | None:
    if len(rest) < 2:
        return None
    is_packed, method = rest[0], rest[1]
    parts = rest[2:].split(b"\0", 2)  # language, key in that language, text
    if len(parts) < 3 or method != 0 or is_packed > 1:
        return None
    if not is_packed:
        return parts[2] if len(parts[2]) <= LARGEST_PROJECT else None
    unpacking = zlib.decompressobj()
    room = min(LARGEST_PROJECT, max(_MOST_UNPACKED, _MOST_PACKED * len(parts[2])))
    try:
        text = unpacking.decompress(parts[2], room)
    except zlib.error:
        return None
    return text if unpacking.eof and not unpacking.unconsumed_tail else None


def _chunks(png: bytes) -> Iterator[tuple[bytes, bytes]]:
    """The chunks whose check sums are right, up to the first that is cut."""
    if not png.startswith(SIGNATURE):
        return
    at = len(SIGNATURE)
    while at + 12 <= len(png):
        (length,) = struct.unpack_from(">I", png, at)
        end = at + 12 + length
        if end > len(png):
            return
        kind, body = png[at + 4 : at + 8], png[at + 8 : at + 8 + length]
        (check,) = struct.unpack_from(">I", png, end - 4)
        if zlib.crc32(kind + body) == check:
            yield kind, body
        at = end


def _end_of_header(png: bytes) -> int:
    """Where the first chunk, IHDR, ends; 0 when the file has none."""
    first = len(SIGNATURE)
    if not png.startswith(SIGNATURE) or png[first + 4 : first + 8] != b"IHDR":
        return 0
    (length,) = struct.unpack_from(">I", png, first)
    return first + 12 + int(length)


def _chunk(kind: bytes, body: bytes) -> bytes:
    check = zlib.crc32(kind + body)
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", check)


# A program inside an SVG file: in a metadata element, found without parsing the XML.

OPENING = b'<metadata id="nep-studio-project">'
NAME = b'id="nep-studio-project"'
CLOSING = b"</"
LARGEST_TEXT = 90_000_000


def svg_with_program(svg: bytes, program: bytes) -> bytes:
    """An SVG file with a program in it, at the end of its drawing.

    As base64: a program may have letters that XML cannot hold.
    """
    end = svg.rfind(b"</svg>")
    if end < 0:
        raise ValueError("this is no SVG file")
    return svg[:end] + OPENING + base64.b64encode(program) + b"</metadata>\n" + svg[end:]


def program_in_svg(svg: bytes) -> bytes | None:
    """The program in an SVG file; None when there is none, or it is damaged.

    No XML parser reads the file, so that nothing in it can be expanded or fetched.
    """
    name = svg.find(NAME)
    begin = svg.find(b">", name) + 1
    end = svg.find(CLOSING, begin)
    if name < 0 or begin == 0 or end < 0 or end - begin > LARGEST_TEXT:
        return None
    text = b"".join(svg[begin:end].split())
    try:
        return base64.b64decode(text, validate=True) or None
    except binascii.Error:
        return None


# Open a picture of a program as the program that is inside it.

LARGEST_FILE = 256_000_000
_FIRST_BYTES = 4096


def project_bytes_from(path: Path) -> bytes | None:
    """The text of the project inside a PNG or SVG file; None when there is none.

    What kind of file it is is read from its content. Nothing in the file is run, decoded as a
    picture or fetched; the project itself is checked by whoever reads it.
    """
    try:
        data = content(path, LARGEST_FILE)
    except OSError as error:
        log.info("The picture %s cannot be read: %s", path, error)
        return None
    if data.startswith(SIGNATURE):
        return program_in_png(data)
    return program_in_svg(data) if b"<svg" in data[:_FIRST_BYTES] else None


# Words of an SVG file that stay inside what is drawn around them, whatever fonts a computer has.

_TEXT = re.compile(r'(<text [^>]*font-weight="(\d+)"[^>]*?)\s*>([^<]*)</text>')
_FAMILY = re.compile(r'font-family="([^"]*)"')


def fitted(svg: bytes, width_of: Callable[[str, int], float | None]) -> bytes:
    """An SVG file with the width of each of its words, and with a usual font after ours.

    ``width_of`` gives the width of words in a weight of the font; None leaves them as they are.
    """

    def with_width(match: re.Match[str]) -> str:
        opening, weight, said = match.groups()
        width = width_of(html.unescape(said), int(weight)) if said.strip() else None
        if width is None:
            return match.group(0)
        return f'{opening} textLength="{width:g}" lengthAdjust="spacingAndGlyphs">{said}</text>'

    text = _FAMILY.sub(r'font-family="\1,sans-serif"', svg.decode())
    return _TEXT.sub(with_width, text).encode()
