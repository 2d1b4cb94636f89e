"""What the search of the site looks through: a line for each part of a page, as a script."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator

from .page import Page

LONGEST_TEXT = 1500
"""So many letters of a part are searched: what matters is said at its beginning."""

Entry = tuple[str, str, str, str, str]
"""Address in the folder of the language, title of the page, of the part, other words, text."""


def entries_of(pages: Iterable[Page]) -> Iterator[Entry]:
    """What can be found in pages of one language."""
    for page in pages:
        for part in page.parts:
            address = page.path if part.depth == 1 else f"{page.path}#{part.anchor}"
            words = page.words.get(part.anchor, "")
            yield address, page.title, part.title, words, part.text[:LONGEST_TEXT]


def script_of(pages: Iterable[Page]) -> str:
    """The entries as a script: a page that is opened as a file may not read data otherwise."""
    lines = (json.dumps(entry, ensure_ascii=False) for entry in entries_of(pages))
    return "const NEP_PAGES = [\n" + ",\n".join(lines) + "\n];\n"
