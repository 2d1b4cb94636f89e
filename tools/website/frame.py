"""Puts a page into its frame: contents, search, languages, and addresses that are relative."""

from __future__ import annotations

import json
import posixpath
import re
from collections.abc import Iterable, Iterator, Mapping
from html import escape
from itertools import groupby
from pathlib import Path
from string import Template

from nep_studio import __version__
from nep_studio.ui.words import available_languages

from .page import FIRST, HERE, Page, word

TEMPLATE = Template(Path(__file__).with_name("page.html").read_text(encoding="utf-8"))
ENGLISH = "en"
IMAGES = "images/"
GUIDES_INDEX = "search-guides.js"
"""What can be found in the pages that are only there in English."""

FEWEST_PARTS = 3
"""A page with fewer parts needs no list of them."""

_ADDRESS = re.compile(rf'(href|src|srcset)="{HERE}([^"#]*)(#[^"]*)?"')


class Site:
    """All pages, and the titles of the groups of the contents in each language."""

    def __init__(
        self, pages: Iterable[Page], groups: Mapping[str, Mapping[str, str]], files: Iterable[str]
    ) -> None:
        self.pages = {(page.language, page.path): page for page in pages}
        self._groups, self._files = groups, set(files)
        self._order = {language: self._ordered(language) for language in groups}
        self.wrong_links: list[str] = []

    def _ordered(self, language: str) -> list[Page]:
        """The pages of a language as the contents list them."""
        here = [page for (own, _), page in self.pages.items() if own == language]
        order = list(self._groups[language])
        return sorted(here, key=lambda page: order.index(page.group))

    def framed(self, page: Page) -> str:
        """The whole file of a page."""
        language, home = page.language, self._way(page, "")
        values = {
            "language": language,
            "kind": "home" if page.path == FIRST else "page",
            "title": escape(_title(page)),
            "about": escape(page.about or page.title),
            "home": home,
            "folder": folder(language),
            "first": self._way(page, f"{folder(language)}{FIRST}"),
            "index": " ".join(self._way(page, name) for name in index_files(language)),
            "navigation": self._navigation(page),
            "where": self._where(page),
            "body": self._with_parts(page),
            "around": self._around(page),
            "languages": self._languages(page),
            "version": escape(word(language, "version", version=__version__)),
        }
        named = ("skip", "contents", "search", "found", "none", "english")
        values |= {name: escape(word(language, name)) for name in named}
        html = TEMPLATE.substitute(values)
        return _ADDRESS.sub(lambda found: self._resolved(page, found), html)

    def _resolved(self, page: Page, found: re.Match[str]) -> str:
        kind, path, anchor = found[1], found[2], found[3] or ""
        if kind != "href" or path.startswith(IMAGES):
            if path not in self._files:
                self.wrong_links.append(f"{page.language}/{page.path} shows {path}")
            return f'{kind}="{self._way(page, path)}"'
        target = self._target(page.language, path or FIRST)
        if target is None:
            self.wrong_links.append(f"{page.language}/{page.path} leads to {path}")
            return 'href="#"'
        return f'href="{self._way(page, folder(target.language) + target.path)}{anchor}"'

    def _target(self, language: str, path: str) -> Page | None:
        return self.pages.get((language, path)) or self.pages.get((ENGLISH, path))

    def _way(self, page: Page, path: str) -> str:
        """A path from the root of the site as seen from a page."""
        here = posixpath.dirname(folder(page.language) + page.path)
        way = posixpath.relpath(path or ".", here or ".")
        return way + "/" * (not path or path.endswith("/"))

    def _navigation(self, page: Page) -> str:
        own = "".join(self._groups_html(page, self._order[page.language], page.language))
        if page.language == ENGLISH:
            return f"<ul>{own}</ul>"
        has = {each.path for each in self._order[page.language]}
        rest = [each for each in self._order[ENGLISH] if each.path not in has]
        return f"<ul>{own}{''.join(self._groups_html(page, rest, page.language))}</ul>"

    def _groups_html(self, page: Page, pages: list[Page], language: str) -> Iterator[str]:
        """The groups of the contents; one that has a single page is a link to it."""
        for group, alike in groupby(pages, lambda each: each.group):
            inside = list(alike)
            tongue = inside[0].language
            mark = f' <span class="tongue">({escape(word(language, "english"))})</span>'
            mark = mark if tongue != language else ""
            if len(inside) == 1:
                yield f"<li>{self._link(page, inside[0], mark)}</li>"
                continue
            is_open = ' open="open"' if page in inside or group == "start" else ""
            title = escape(self._groups[tongue][group])
            items = "".join(f"<li>{self._link(page, each)}</li>" for each in inside)
            inside_html = f"<summary>{title}{mark}</summary><ul>{items}</ul>"
            yield f"<li><details{is_open}>{inside_html}</details></li>"

    def _link(self, page: Page, to: Page, mark: str = "") -> str:
        way = self._way(page, folder(to.language) + to.path)
        current = ' aria-current="page"' if to is page else ""
        tongue = f' lang="{to.language}" hreflang="{to.language}"' * (to.language != page.language)
        return f'<a href="{way}"{current}{tongue}>{escape(self._called(to))}{mark}</a>'

    def _called(self, page: Page) -> str:
        """What a page is called in lists: the group says already what it is an overview of."""
        is_list = posixpath.basename(page.path) == FIRST != page.path
        return word(page.language, "overview") if is_list else page.title

    def _where(self, page: Page) -> str:
        """The way from the first page to this one: what cannot be seen where a screen is small."""
        if page.path == FIRST:
            return ""
        first = self._way(page, folder(page.language) + FIRST)
        steps = [f'<a href="{first}">NEP Studio</a>']
        above = next(
            (
                f"{page.group}{end}"
                for end in (f"/{FIRST}", ".html")
                if (page.language, f"{page.group}{end}") in self.pages
            ),
            page.path,
        )
        if above != page.path:
            way = self._way(page, folder(page.language) + above)
            title = escape(self._groups[page.language][page.group])
            steps.append(f'<a href="{way}">{title}</a>')
        return f'<p class="where">{" / ".join(steps)}</p>'

    def _with_parts(self, page: Page) -> str:
        """The body, with a list of its parts below its beginning."""
        parts = [part for part in page.parts if part.depth == 2]
        if len(parts) < FEWEST_PARTS or page.path == FIRST:
            return page.body
        title = escape(word(page.language, "here"))
        items = "".join(
            f'<li><a href="#{part.anchor}">{escape(part.title)}</a></li>' for part in parts
        )
        listed = f'<nav class="here" aria-label="{title}"><p>{title}</p><ul>{items}</ul></nav>\n'
        at = page.body.index("<h2 ")
        return page.body[:at] + listed + page.body[at:]

    def _around(self, page: Page) -> str:
        """Links to the pages before and after it in its group."""
        group = [each for each in self._order[page.language] if each.group == page.group]
        at = group.index(page)
        links = []
        for name, near in (("previous", group[at - 1 : at]), ("next", group[at + 1 : at + 2])):
            for each in near:
                links.append(
                    f"<span>{escape(word(page.language, name))}: {self._link(page, each)}</span>"
                )
        return f'<div class="around">{"".join(links)}</div>' if links else ""

    def _languages(self, page: Page) -> str:
        """The same page in the other languages; where one does not have it, its first page."""
        links = []
        for code, name in available_languages().items():
            to = self.pages.get((code, page.path)) or self.pages.get((code, FIRST))
            if to is not None and code != page.language:
                way = self._way(page, folder(code) + to.path)
                links.append(f'<li><a href="{way}" lang="{code}" hreflang="{code}">{name}</a></li>')
        if not links:
            return ""
        title = escape(word(page.language, "languages"))
        own = f"<summary>{available_languages()[page.language]}</summary>"
        listed = f"<details>{own}<ul>{''.join(links)}</ul></details>"
        return f'<nav class="languages" aria-label="{title}">{listed}</nav>'


def folder(language: str) -> str:
    """Where the pages of a language lie: the English ones at the root."""
    return "" if language == ENGLISH else f"{language}/"


def index_files(language: str) -> tuple[str, str]:
    """The files with what is searched in a language: its own, and what is only in English."""
    return f"search-{language}.js", GUIDES_INDEX


def _title(page: Page) -> str:
    return page.title if page.path == FIRST else f"{page.title} · NEP Studio"


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
