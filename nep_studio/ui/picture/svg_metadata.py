"""A program inside an SVG file: in a metadata element, found without parsing the XML."""

from __future__ import annotations

import base64
import binascii

OPENING = b'<metadata id="nep-studio-project">'
NAME = b'id="nep-studio-project"'
CLOSING = b"</"
LARGEST_TEXT = 90_000_000


def with_program(svg: bytes, program: bytes) -> bytes:
    """An SVG file with a program in it, at the end of its drawing.

    As base64: a program may have letters that XML cannot hold.
    """
    end = svg.rfind(b"</svg>")
    if end < 0:
        raise ValueError("this is no SVG file")
    return svg[:end] + OPENING + base64.b64encode(program) + b"</metadata>\n" + svg[end:]


def program_in(svg: bytes) -> bytes | None:
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
