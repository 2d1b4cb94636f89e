"""What the search of the site looks through: a line for each part of a page, as a script."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator

from .frame import folder
from .page import Page

LONGEST_TEXT = 1500
"""So many letters of a part are searched: what matters is said at its beginning."""

JOINED = 'var NEP_PAGES = (typeof NEP_PAGES === "undefined" ? [] : NEP_PAGES).concat('
"""So two of these scripts on one page add up."""

Entry = tuple[str, str, str, str, str]
"""Address from the root of the site, title of the page, of the part, other words, text."""


def entries_of(pages: Iterable[Page]) -> Iterator[Entry]:
    """What can be found in pages."""
    for page in pages:
        for part in page.parts:
            path = folder(page.language) + page.path
            address = path if part.depth == 1 else f"{path}#{part.anchor}"
            words = page.words.get(part.anchor, "")
            yield address, page.title, part.title, words, part.text[:LONGEST_TEXT]


def script_of(pages: Iterable[Page]) -> str:
    """The entries as a script: a page that is opened as a file may not read data otherwise."""
    lines = (json.dumps(entry, ensure_ascii=False) for entry in entries_of(pages))
    listed = ",\n".join(lines)
    return f"{JOINED}[\n{listed}\n]);\n"
