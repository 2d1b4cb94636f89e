"""HTML of the help in the window, which is made for Qt, as HTML for browsers."""

from __future__ import annotations

import re
from collections.abc import Callable

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
