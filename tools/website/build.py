"""Makes the whole site: reads all sources, gives every page its frame, writes the files."""

from __future__ import annotations

import posixpath
import re
import shutil
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from html import escape
from pathlib import Path

from nep_studio import paths
from nep_studio.blocks.language import Language
from nep_studio.help.texts import help_folder
from nep_studio.run.installation import studio_language
from nep_studio.ui.plugins.help.repository import Book, Rows, manifests, node_title
from nep_studio.ui.theme.icons import APPLICATION_ICON, icon_path
from nep_studio.ui.words import use_language

from .contents import DOCS, GROUPS, HOW_TO, MADE_OF, ROOT, START, group_of, sources
from .frame import ENGLISH, GUIDES_INDEX, Site, folder, index_files, script_of
from .help_pages import HelpPages, how_to_path
from .page import FIRST, HERE, Page, word
from .pictures import Pictures, colours_css
from .reference_pages import benchmark_rows, commands_page, messages_page
from .written import page_of

FONTS = (
    "AtkinsonHyperlegibleNext-Regular.ttf",
    "AtkinsonHyperlegibleNext-SemiBold.ttf",
    "AtkinsonHyperlegibleMono-Regular.ttf",
    "NotoSansJPNEP-Regular.ttf",
)
ICON = "nep-studio.svg"
SCRIPTS = ("style.css", "search.js", "frame.js")
_IMAGE = re.compile(rf'(?:src|srcset)="{HERE}images/([^"]+)"')
ShortcutsOf = Callable[[str], Rows]
"""Gives what keys do in the window, in a language."""


class WrongLinks(ValueError):
    """Links that lead nowhere, one a line."""


@dataclass(frozen=True)
class Built:
    """What was made: how many pages, how many bytes in all."""

    pages: int
    size: int


def build(target: Path, languages: Iterable[str], shortcuts_of: ShortcutsOf) -> Built:
    """Make the site in a folder, which is emptied first; raises WrongLinks, WrongPage."""
    pictures = Pictures()
    pages: list[Page] = written_pages()
    guides = [page for page in pages if page.group == START]
    groups: dict[str, dict[str, str]] = {}
    english = studio_language()
    for code in dict.fromkeys((ENGLISH, *languages)):
        use_language(code)
        rows = list(shortcuts_of(code))
        book = Book(studio_language(code), partial(list, rows))
        found = list(HelpPages(book, english, code, pictures).all())
        groups[code] = _groups(book, code)
        if code != ENGLISH:
            pages.append(_first_page(code, found, groups[code], guides))
        pages += found
        if code == ENGLISH:
            pages += [_messages(book.language), commands_page()]
    use_language(ENGLISH)
    return _write(target, pages, groups, pictures)


def written_pages() -> list[Page]:
    """The pages that people write in Markdown, in English."""
    files, inserts = sources(), {"benchmarks": benchmark_rows()}
    known = files | MADE_OF

    def page(source: Path, path: str) -> Page:
        def address(link: str) -> str:
            return _address(source, link, known)

        return page_of(source, path, group_of(path), address, inserts)

    return [page(source, path) for source, path in files.items()]


def _address(source: Path, link: str, known: dict[Path, str]) -> str:
    """The address on the site of what a file links to, so that links also work among the files.

    Empty for files of the project that are not on the site, such as programs.
    """
    if link.startswith("#"):
        return link
    path, _, anchor = link.partition("#")
    file = (source.parent / path).resolve()
    place = f"#{anchor}" if anchor else ""
    if file in known:
        return f"{HERE}{known[file]}{place}"
    if file.parent == help_folder() / ENGLISH and file.exists():
        return f"{HERE}{how_to_path(file.stem)}{place}"
    if file.exists() and file.is_relative_to(ROOT):
        return ""
    return f"{HERE}{path}"


def _groups(book: Book, code: str) -> dict[str, str]:
    how_to, blocks, nodes = book.contents()
    titles = {"how-to": how_to.title, "blocks": blocks.title, "nodes": nodes.title}
    return GROUPS | titles | ({START: word(code, "contents")} if code != ENGLISH else {})


def _messages(language: Language) -> Page:
    nodes = manifests()
    titles = language.choices.get("nodes", {})
    return messages_page(nodes, {name: node_title(each, titles) for name, each in nodes.items()})


def _first_page(
    code: str, pages: Iterable[Page], groups: dict[str, str], english: Iterable[Page]
) -> Page:
    """The page on which a language other than English begins."""
    title = word(code, "documentation")
    parts = [f'<h1 id="top">{escape(title)}</h1><p>{escape(word(code, "intro"))}</p>']
    listed: dict[str, list[Page]] = {}
    for page in pages:
        if posixpath.basename(page.path) != FIRST:
            listed.setdefault(page.group, []).append(page)
    problems = listed.pop("problems", [])
    listed[HOW_TO] += problems
    for group, inside in listed.items():
        form = "" if group == HOW_TO else ' class="columns"'
        items = "".join(_item(page, with_about=group == HOW_TO) for page in inside)
        parts.append(f'<h2 id="{group}">{escape(groups[group])}</h2><ul{form}>{items}</ul>')
    heading = escape(word(code, "only_english"))
    items = "".join(_item(page, with_about=True) for page in english if page.path != FIRST)
    parts.append(f'<h2 id="english">{heading}</h2><ul lang="{ENGLISH}">{items}</ul>')
    return Page(FIRST, title, "\n".join(parts), START, code, word(code, "intro"))


def _item(page: Page, *, with_about: bool) -> str:
    told = f": {escape(page.about)}" if with_about and page.about else ""
    return f'<li><a href="{HERE}{page.path}">{escape(page.title)}</a>{told}</li>'


def _searched(pages: list[Page], languages: Iterable[str]) -> dict[str, str]:
    """The scripts with what can be found: of each language, and what is only there in English."""
    other = {page.path for page in pages if page.language != ENGLISH}
    scripts = {GUIDES_INDEX: script_of(page for page in pages if page.path not in other)}
    for code in languages:
        own = (page for page in pages if page.language == code and page.path in other)
        scripts[index_files(code)[0]] = script_of(own)
    return scripts


def _write(
    target: Path, pages: list[Page], groups: dict[str, dict[str, str]], pictures: Pictures
) -> Built:
    images = {name: DOCS / "images" / name for page in pages for name in _IMAGE.findall(page.body)}
    images[ICON] = icon_path(APPLICATION_ICON)
    site = Site(pages, groups, [f"images/{name}" for name in images])
    made = {folder(page.language) + page.path: site.framed(page) for page in pages}
    if site.wrong_links:
        raise WrongLinks("\n".join(sorted(set(site.wrong_links))))
    made |= _searched(pages, groups)
    here = Path(__file__).parent
    made["colours.css"] = colours_css() + pictures.style()
    made |= {name: (here / name).read_text(encoding="utf-8") for name in SCRIPTS}
    if target.exists():
        shutil.rmtree(target)
    for name, text in made.items():
        path = target / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")
    copies = {f"images/{name}": path for name, path in images.items()}
    fonts = paths.resources() / "fonts"
    licences = [path.name for path in fonts.glob("LICENSE-*.txt")]
    copies |= {f"fonts/{name}": fonts / name for name in (*FONTS, *licences)}
    for name, path in copies.items():
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, target / name)
    size = sum(file.stat().st_size for file in target.rglob("*") if file.is_file())
    return Built(len(pages), size)
