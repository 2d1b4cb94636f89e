"""Open a picture of a program as the program that is inside it."""

from __future__ import annotations

import logging
from pathlib import Path

from . import png_chunk, svg_metadata

log = logging.getLogger(__name__)

LARGEST_FILE = 256_000_000
PICTURE_ENDINGS = (".png", ".svg")
_FIRST_BYTES = 4096


def project_bytes_from(path: Path) -> bytes | None:
    """The text of the project inside a PNG or SVG file; None when there is none.

    What kind of file it is is read from its content. Nothing in the file is run, decoded as a
    picture or fetched; the project itself is checked by whoever reads it.
    """
    try:
        if path.stat().st_size > LARGEST_FILE:
            return None
        data = path.read_bytes()
    except OSError as error:
        log.info("The picture %s cannot be read: %s", path, error)
        return None
    if data.startswith(png_chunk.SIGNATURE):
        return png_chunk.program_in(data)
    return svg_metadata.program_in(data) if b"<svg" in data[:_FIRST_BYTES] else None
