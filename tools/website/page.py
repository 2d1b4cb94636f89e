"""A page of the site, before it has its frame: what it says, where it lies, what is found in it.

In a body, ``@/blocks/robot.html#robot.say`` leads to a place of the site, ``@/images/a.png`` is a
picture. They become relative addresses when the page gets its frame.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from html import unescape
from pathlib import Path

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


LinkOf = Callable[[str], str]
"""Gives the address of a page of the help by its name, such as "block/robot.say#slot-text"."""

_CODE = re.compile(
    r'<table class="code"[^>]*><tr><td><pre[^>]*>(.*?)</pre></td></tr></table>', re.S
)
_TIP = re.compile(r'<table class="tip"[^>]*><tr><td>(.*?)</td></tr></table>', re.S)
_TABLE = re.compile(r"<table[^>]*>(.*?)</table>", re.S)
_PLACE = re.compile(r'<(h[1-3]|td)><a name="([^"]+)"></a>')
_LINK = re.compile(r'<a href="help:([^"]+)">')
_OUTSIDE = re.compile(r'<a href="(https?://[^"]+)">')
_TICKED = re.compile(r'<li class="unchecked">(.*?)</li>', re.S)
_LONE_BREAK = re.compile(r"<br>")


def for_browsers(html: str, link_of: LinkOf) -> str:
    """The same page, well formed, with headings that can be linked to and boxes to tick."""
    html = _CODE.sub(r'<pre tabindex="0"><code>\1</code></pre>', html)
    html = _TIP.sub(r'<p class="tip">\1</p>', html)
    html = _TABLE.sub(lambda found: scrolling_table(found[1]), html)
    html = _PLACE.sub(r'<\1 id="\2">', html)
    html = _LINK.sub(lambda found: f'<a href="{link_of(found[1])}">', html)
    html = _OUTSIDE.sub(r'<a class="outside" href="\1">', html)
    html = _TICKED.sub(lambda found: box_to_tick(found[1]), html)
    return _LONE_BREAK.sub("<br/>", html)


def scrolling_table(rows: str) -> str:
    """A table that scrolls by itself where the screen is narrow, also by the keyboard."""
    rows = rows.replace("<th>", '<th scope="col">')
    return f'<div class="scroll" tabindex="0"><table>{rows}</table></div>'


def box_to_tick(words: str) -> str:
    """A line of a checklist: it can be ticked, and nothing remembers it."""
    return f'<li class="check"><label><input type="checkbox"/> <span>{words}</span></label></li>'


def slug(words: str) -> str:
    """The anchor of a heading, as GitHub makes it."""
    kept = "".join(letter for letter in words.lower() if letter.isalnum() or letter in " -_")
    return kept.replace(" ", "-")


@cache
def _tables() -> dict[str, dict[str, str]]:
    return tomllib.loads(Path(__file__).with_name("words.toml").read_text(encoding="utf-8"))


def word(language: str, name: str, /, **values: object) -> str:
    """A word of the frame, with ``{name}`` filled in from the values."""
    return _tables()[language][name].format_map(values)
