"""Names under which a project keeps what was made for it: its motions and its gestures."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Container

KEPT_NAME = re.compile(r"[a-z][a-z0-9_]{0,39}")
DEVICES = frozenset(
    ("con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(1, 10)))
)
"""No file can be called so on Windows, and much of what is kept becomes a file of its name."""


def free_kept_name(title: str, kind: str, taken: Container[str]) -> str:
    """A name for something with this title, which none of the others has.

    ``kind`` (one word) begins the names of titles that have no letter to begin with.
    """
    bare = unicodedata.normalize("NFKD", title.casefold().replace("ß", "ss"))
    letters = "".join(c for c in bare if not unicodedata.combining(c))
    name = re.sub(r"[^a-z0-9]+", "_", letters).strip("_")[:32].strip("_")
    name = name if name[:1].isalpha() else f"{kind}_{name}"[:32].rstrip("_")
    number, found = 2, name
    while found in taken or found in DEVICES:
        found, number = f"{name}_{number}", number + 1
    return found
