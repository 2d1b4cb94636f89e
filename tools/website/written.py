"""Pages that people write in Markdown, in docs and beside it."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import Any

from markdown_it import MarkdownIt
from markdown_it.renderer import RendererHTML
from markdown_it.token import Token
from PySide6.QtGui import QImageReader

from .page import HERE, Page, box_to_tick, plain, slug

ABOUT = re.compile(r"<!-- about: (.*?) -->")
WORDS = re.compile(r"<!-- words: (.*?) -->", re.S)
"""Other words by which a page is searched, also of other languages where it has no translation."""
_COMMENT = re.compile(r"<!--.*?-->", re.S)
_BOX = "[ ] "
WIDE = 900
"""A picture of so many pixels leads to itself: on its own it is seen as large as it is."""
LinkOf = Callable[[str], str]
"""Gives the address for a link as a file has it; an empty one for what is not on the site."""


class WrongPage(ValueError):
    """A page that says something which the site cannot show; its text says which and where."""


def page_of(
    source: Path, path: str, group: str, link_of: LinkOf, inserts: Mapping[str, str]
) -> Page:
    """Read a page; ``link_of`` gives the address for a link as the file writes it.

    ``{{name}}`` is replaced by the Markdown ``inserts[name]``.
    """
    text = source.read_text(encoding="utf-8")
    for name, insert in inserts.items():
        text = text.replace(f"{{{{{name}}}}}", insert)
    parser = MarkdownIt("commonmark", {"xhtmlOut": True}, renderer_cls=_Renderer).enable("table")
    body = parser.render(text, {"source": source, "link_of": link_of, "links": []})
    title = re.search(r"<h1[^>]*>(.*?)</h1>", body)
    if title is None:
        raise WrongPage(f"{source} has no title.")
    about = ABOUT.search(text)
    page = Page(path, plain(title[1]), body, group, about=about[1] if about else "")
    words = WORDS.search(text)
    return replace(page, words={page.parts[0].anchor: words[1] if words else ""})


class _Renderer(RendererHTML):
    """Headings with anchors, tables that scroll, pictures in the theme of the reader."""

    def heading_open(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        words = "".join(
            child.content
            for child in tokens[at + 1].children or ()
            if child.type in ("text", "code_inline")
        )
        taken = env.setdefault("anchors", {})
        anchor = slug(words)
        taken[anchor] = taken.get(anchor, -1) + 1
        anchor += f"-{taken[anchor]}" if taken[anchor] else ""
        return f'<{tokens[at].tag} id="{anchor}">'

    def link_open(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        address = str(tokens[at].attrs["href"])
        if address.startswith(("https://", "http://")):
            env["links"].append(True)
            return f'<a class="outside" href="{escape(address)}">'
        found = env["link_of"](address)
        env["links"].append(bool(found))
        return f'<a href="{escape(found)}">' if found else '<span class="file">'

    def link_close(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        return "</a>" if env["links"].pop() else "</span>"

    def image(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        address = str(tokens[at].attrs["src"])
        path = (env["source"].parent / address).resolve()
        size = QImageReader(str(path)).size()
        if not tokens[at].content:
            raise WrongPage(f"{env['source']}: {address} has no words for who cannot see it.")
        if not size.isValid():
            raise WrongPage(f"{env['source']}: {address} is no picture.")
        form = f'width="{size.width()}" height="{size.height()}" loading="lazy"'
        words = escape(plain(tokens[at].content))
        shown = f'<img src="{HERE}images/{path.name}" alt="{words}" {form}/>'
        dark = path.with_name(path.name.replace("-light.", "-dark."))
        if dark != path and dark.is_file():
            source = f'srcset="{HERE}images/{dark.name}" media="(prefers-color-scheme: dark)"'
            shown = f"<picture><source {source}/>{shown}</picture>"
        if size.width() < WIDE or env["links"][-1:] == [True]:
            return shown
        return f'<a class="picture" href="{HERE}images/{path.name}">{shown}</a>'

    def table_open(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        return '<div class="scroll" tabindex="0"><table>'

    def table_close(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        return "</table></div>"

    def th_open(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        return '<th scope="col">'

    def td_open(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        return "<td>"

    def fence(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        return f'<pre tabindex="0"><code>{escape(tokens[at].content)}</code></pre>\n'

    def code_block(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        return self.fence(tokens, at, options, env)

    def html_block(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        if rest := _COMMENT.sub("", tokens[at].content).strip():
            raise WrongPage(f"{env['source']} has HTML, which the site does not take: {rest}")
        return ""

    def html_inline(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        return self.html_block(tokens, at, options, env)

    def render(self, tokens: Sequence[Token], options: Any, env: Any) -> str:
        html = super().render(tokens, options, env)
        ticked = re.compile(rf"<li>{re.escape(_BOX)}(.*?)</li>", re.S)
        return ticked.sub(lambda found: box_to_tick(found[1].strip()), html)
