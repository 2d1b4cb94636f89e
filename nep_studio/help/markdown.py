"""The pages that people write: a small part of Markdown, made into HTML and into plain text.

Headings (``## Title {#anchor}``), paragraphs, lists (``-``, ``1.``, ``- [ ]``), tables, code in
fences, and inside of lines ``**bold**``, ``*slanted*``, ```code``` and ``[words](page#anchor)``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from html import escape
from itertools import groupby

_HEADING = re.compile(r"(#{1,3}) (.+?)(?: \{#([\w-]+)\})?")
_COMMENT = re.compile(r"<!--(.*?)-->")
_KEY = re.compile(r"(\w+):\s*((?:(?!\w+:).)*)")
_INLINE = re.compile(r"`([^`]+)`|\*\*([^*]+)\*\*|\*([^*\s][^*]*)\*|\[([^\]]+)\]\(([^)\s]+)\)")
_LISTS = (("ol", re.compile(r"\d+\. (.*)")), ("ul", re.compile(r"- (.*)")))
_BOX = "[ ] "


@dataclass(frozen=True)
class Heading:
    """A title inside a page: how deep it is, its words, the anchor by which links name it."""

    depth: int
    words: str
    anchor: str


@dataclass
class Document:
    """A page as it was written: what its comment says of it, its headings and its parts."""

    title: str = ""
    about: dict[str, str] = field(default_factory=dict)
    headings: list[Heading] = field(default_factory=list)
    html: str = ""
    text: str = ""
    links: list[str] = field(default_factory=list)


def read(source: str, inserts: dict[str, str] | None = None) -> Document:
    """Read a page; ``{{name}}`` on a line of its own is replaced by the HTML ``inserts[name]``."""
    document = Document()
    parts = [_part(lines, document, inserts or {}) for lines in _parts(source)]
    document.html = "\n".join(parts)
    document.text = " ".join(re.sub(r"<[^>]+>", " ", part) for part in parts)
    return document


def _parts(source: str) -> Iterator[list[str]]:
    """The source in paragraphs; code in fences is one of them, empty lines and all."""
    lines: list[str] = []
    is_code = False
    for line in source.splitlines():
        is_fence = line.startswith("```")
        if is_fence and not is_code and lines:
            yield lines
            lines = []
        if line.strip() or is_code:
            lines.append(line)
        is_end = is_fence and is_code
        is_code = is_code != is_fence
        if lines and not is_code and (is_end or not line.strip() or _HEADING.fullmatch(line)):
            yield lines
            lines = []
    if lines:
        yield lines


def _part(lines: list[str], document: Document, inserts: dict[str, str]) -> str:
    first = lines[0]
    if heading := _HEADING.fullmatch(first):
        depth, words = len(heading[1]), heading[2]
        if depth == 1:
            document.title = words
        anchor = heading[3] or f"part-{len(document.headings)}"
        document.headings.append(Heading(depth, words, anchor))
        return f'<h{depth}><a name="{anchor}"></a>{inline(words, document)}</h{depth}>'
    if comment := _COMMENT.fullmatch(first.strip()):
        document.about |= {key: value.strip() for key, value in _KEY.findall(comment[1])}
        return _part(lines[1:], document, inserts) if lines[1:] else ""
    if first.startswith("```"):
        return code_html("\n".join(lines[1:-1]))
    if first.startswith("{{"):
        return inserts.get(first.strip("{}"), "")
    if first.startswith("|"):
        return _table(lines, document)
    # Lines that begin like a list become one; the others are a paragraph
    made = []
    for kind, found in groupby(lines, _list_kind):
        told = list(found)
        if not kind:
            made.append(f"<p>{inline(' '.join(told), document)}</p>")
            continue
        items = (_item(line.split(" ", 1)[1], document) for line in told)
        made.append(f"<{kind}>{''.join(items)}</{kind}>")
    return "".join(made)


def code_html(code: str) -> str:
    """Lines of code in a box; long ones are wrapped, and they are always read from the left."""
    lines = f"<pre dir='ltr' align='left' style='white-space: pre-wrap'>{escape(code)}</pre>"
    return f'<table class="code" width="100%" cellspacing="0"><tr><td>{lines}</td></tr></table>'


def _list_kind(line: str) -> str:
    return next((kind for kind, sign in _LISTS if sign.fullmatch(line)), "")


def _item(words: str, document: Document) -> str:
    if words.startswith(_BOX):
        return f'<li class="unchecked">{inline(words.removeprefix(_BOX), document)}</li>'
    return f"<li>{inline(words, document)}</li>"


def _table(lines: list[str], document: Document) -> str:
    told = []
    for number, line in enumerate(lines):
        kind = "td" if number else "th"
        cells = (inline(cell.strip(), document) for cell in line.strip("|").split("|"))
        if number != 1:  # the line between head and body
            told.append("<tr>" + "".join(f"<{kind}>{cell}</{kind}>" for cell in cells) + "</tr>")
    return f'<table class="table" cellspacing="0">{"".join(told)}</table>'


def inline(words: str, document: Document | None = None) -> str:
    """Words inside of a line; the links in them are noted in the document."""
    made, end = [], 0
    for found in _INLINE.finditer(words):
        made += [escape(words[end : found.start()], quote=False), _marked(found, document)]
        end = found.end()
    return "".join([*made, escape(words[end:], quote=False)])


def _marked(found: re.Match[str], document: Document | None) -> str:
    code, bold, slanted, label, link = found.groups()
    if code is not None:
        return f"<code>{escape(code)}</code>"
    if bold is not None:
        return f"<b>{inline(bold, document)}</b>"
    if slanted is not None:
        return f"<i>{escape(slanted)}</i>"
    if document is not None:
        document.links.append(link)
    return f'<a href="help:{escape(link)}">{escape(label)}</a>'
