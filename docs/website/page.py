"""A page of the site, before it has its frame: what it says, where it lies, what is found in it.

In a body, ``@/blocks/robot.html#robot.say`` leads to a place of the site, ``@/images/a.png`` is a
picture. They become relative addresses when the page gets its frame.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from html import unescape

FIRST = "index.html"
HERE = "@/"
_HEADING = re.compile(r'<h([1-3]) id="([^"]+)"[^>]*>(.*?)</h\1>', re.S)
_INSIDE = re.compile(r"</?(?:code|strong|em|a|b|i|span)(?: [^>]*)?>")
_TAG = re.compile(r"<svg.*?</svg>|<[^>]+>", re.S)
_SPACE = re.compile(r"\s+")


@dataclass(frozen=True)
class Part:
    """A heading with its text up to the next one: what a search leads to."""

    depth: int
    anchor: str
    title: str
    text: str


@dataclass(frozen=True)
class Page:
    """A page in one language. ``path`` is that of its English version.

    ``about`` is a sentence for lists of pages; ``words`` are other words by which its parts are
    searched, by anchor; ``group`` is where it stands in the contents.
    """

    path: str
    title: str
    body: str
    group: str
    language: str = "en"
    about: str = ""
    words: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """The headings that have an anchor, each with the text below it."""
        found = list(_HEADING.finditer(self.body))
        ends = [each.start() for each in found[1:]] + [len(self.body)] * bool(found)
        return tuple(
            Part(int(each[1]), each[2], plain(each[3]), plain(self.body[each.end() : end]))
            for each, end in zip(found, ends, strict=True)
        )


def plain(html: str) -> str:
    """The text of some HTML, without pictures."""
    return _SPACE.sub(" ", unescape(_TAG.sub(" ", _INSIDE.sub("", html)))).strip()
