"""The pages of the help in the window as pages of the site: how-tos, blocks, nodes."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from html import escape

from nep_core.wire.messages import BY_TOPIC
from nep_studio import paths
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.language import Language
from nep_studio.blocks.text import sentence
from nep_studio.help.texts import (
    BLOCK,
    CATEGORY,
    HOME,
    HOW_TO,
    NODE,
    category_texts,
    examples,
    page_texts,
    split,
)
from nep_studio.ui.canvas.fields.editors import slot_name
from nep_studio.ui.plugins.help.repository import (
    CHOOSE,
    DRAG,
    EXAMPLE,
    PICTURE,
    Book,
    sample_clip,
    text_of,
)
from nep_studio.ui.words import tr

from .contents import DOCS
from .page import FIRST, HERE, Page, for_browsers, plain, word
from .pictures import Pictures
from .reference_pages import MESSAGES_PATH as MESSAGES

PROBLEMS = "problems"

_PICTURE = re.compile(rf'<img src="{PICTURE}([^"]+)">')
_CHOICE = re.compile(rf'<p><a href="{CHOOSE}[^"]+">[^<]*</a></p>')
"""What only the window can do."""
_EXAMPLE = re.compile(rf'<a href="{DRAG}[^"]+"><img src="{EXAMPLE}([^"]+)"></a>')
_WORDS = re.compile(r"<!--.*?\bwords: (.*?) -->")
_QUOTED = re.compile(r"`([^`<>]+)`")
_NAME = re.compile(r'<a name="([^"]+)"></a>')
_TOPIC = re.compile(r"(?<=[ \u3001\uff1a])/(\w+)(?=[,\u3001<])")
_FIRST_SENTENCE = re.compile(r"<p>(.*?[.。])(?:\s|</p>|<|(?<=。))", re.S)


class HelpPages:
    """The help in one language; ``english`` are the blocks in English."""

    def __init__(self, book: Book, english: Language, code: str, pictures: Pictures) -> None:
        self._book, self._english, self._code, self._pictures = book, english, code, pictures
        self._language = book.language
        self._examples: dict[str, str] = {}

    def all(self) -> Iterator[Page]:
        """Every page, in the order of the contents."""
        how_to, blocks, nodes = self._book.contents()
        titles = [(content.page, content.title) for content in how_to.inside]
        yield self._list("how-to/index.html", how_to.title, "all_how_tos", titles)
        for content in how_to.inside:
            yield self._how_to(content.page)
        titles = [(content.page, content.title) for content in blocks.inside]
        yield self._list("blocks/index.html", blocks.title, "all_blocks", titles)
        for content in blocks.inside:
            yield self._category(content.page.removeprefix(CATEGORY), content.title)
        titles = [(content.page, content.title) for content in nodes.inside]
        yield self._list("nodes/index.html", nodes.title, "all_nodes", titles)
        for content in nodes.inside:
            yield self._node(content.page)

    def address(self, name: str) -> str:
        """Where a page of the help is on the site."""
        page, anchor = split(self._book.resolve(name))
        return HERE + self._path(page, anchor)

    def _path(self, page: str, anchor: str = "") -> str:
        if page.startswith(BLOCK):
            block = page.removeprefix(BLOCK)
            category = self._language.definitions[block].category.id
            return f"blocks/{category}.html#{_inside(block, anchor)}"
        place = f"#{anchor}" if anchor else ""
        if page.startswith(CATEGORY):
            return f"blocks/{page.removeprefix(CATEGORY)}.html{place}"
        if page.startswith(NODE):
            return f"nodes/{page.removeprefix(NODE).replace('/', '-')}.html{place}"
        if page == HOME:
            return FIRST
        return f"{how_to_path(page.removeprefix(HOW_TO))}{place}"

    def _how_to(self, name: str) -> Page:
        page = self._book.page(name)
        path = self._path(name)
        group = PROBLEMS if name == HOW_TO + PROBLEMS else "how-to"
        html = for_browsers(_CHOICE.sub("", page.html), self.address)
        body = _EXAMPLE.sub(lambda found: self._example(found[1]), html)
        made = Page(path, page.title, body, group, self._code, _about(body))
        written = page_texts(self._code)[name.removeprefix(HOW_TO)]
        words = _WORDS.search(written)
        return replace(made, words={made.parts[0].anchor: words[1] if words else ""})

    def _node(self, name: str) -> Page:
        page = self._book.page(name)
        html = _TOPIC.sub(_topic_link, _titled(page.html, "top"))
        html = _QUOTED.sub(r"<code>\1</code>", html)  # as texts of manifests have commands
        body = for_browsers(html, self.address)
        return Page(self._path(name), page.title, body, "nodes", self._code, _about(body))

    def _category(self, category: str, title: str) -> Page:
        about = category_texts(self._code).get(category, "")
        blocks = [
            each for each in self._language.definitions.values() if each.category.id == category
        ]
        parts = [f'<h1 id="top">{escape(title)}</h1><p>{escape(about)}</p>']
        parts += [self._block(each) for each in blocks]
        words = {each.id: f"{each.in_words} {text_of(each.id).words}" for each in blocks}
        path = self._path(CATEGORY + category)
        return Page(path, title, "\n".join(parts), "blocks", self._code, about, words)

    def _block(self, definition: Definition) -> str:
        """The page of a block as a part of the page of its category."""
        block, language = definition.id, self._language
        html = self._book.page(BLOCK + block).html
        drag = tr("Drag it onto the page, or use the buttons below.")
        html = html.replace(f'<p class="hint">{escape(drag)}</p>', "")
        html = html.replace("<h2>", "<h3>").replace("</h2>", "</h3>")
        html = html.replace("<h1>", f'<h2 id="{block}">').replace("</h1>", "</h2>")
        html = _NAME.sub(lambda found: f'<a name="{_inside(block, found[1])}"></a>', html)
        robots = robots_html(self._code, language, definition, self._english.definitions[block])
        see = f"<h3>{escape(tr('See also'))}</h3>"
        html = for_browsers(html.replace(see, robots + see), self.address)
        clip = sample_clip(language, definition)
        title = self._book.titles[BLOCK + block]
        html = _PICTURE.sub(lambda _: self._pictures.of(clip.project, language, title), html)
        return _EXAMPLE.sub(lambda found: self._example(found[1]), html)

    def _example(self, name: str) -> str:
        """The picture of an example; some blocks share one."""
        if name not in self._examples:
            self._examples[name] = self._drawn_example(name)
        return self._examples[name]

    def _drawn_example(self, name: str) -> str:
        clip = examples()[name].clip(self._language, self._code)
        project, language = clip.project, self._language.of(clip.project)
        chains = (stack.body for stacks in project.pages.values() for stack in stacks)
        said = "; ".join(sentence(project, language, block) for chain in chains for block in chain)
        return self._pictures.of(project, self._language, f"{tr('Example')}: {said}")

    def _list(self, path: str, title: str, about: str, pages: list[tuple[str, str]]) -> Page:
        told = word(self._code, about)
        items = "".join(
            f'<li><a href="{HERE}{self._path(page)}">{escape(name)}</a>: '
            f"{escape(self._told(page))}</li>"
            for page, name in pages
        )
        body = (
            f'<h1 id="top">{escape(title)}</h1><p>{escape(told)}</p><ul class="list">{items}</ul>'
        )
        return Page(path, title, body, path.partition("/")[0], self._code, told)

    def _told(self, page: str) -> str:
        if page.startswith(CATEGORY):
            return category_texts(self._code).get(page.removeprefix(CATEGORY), "")
        return _about(self._book.page(page).html)


def _topic_link(found: re.Match[str]) -> str:
    """A topic in the list of those that a node hears and says, with a link to its message."""
    known = f"/{found[1]}" in BY_TOPIC
    return f'<a href="{HERE}{MESSAGES}#{found[1]}">/{found[1]}</a>' if known else found[0]


def how_to_path(name: str) -> str:
    """Where a how-to page is."""
    return f"{PROBLEMS}.html" if name == PROBLEMS else f"how-to/{name}.html"


def _inside(block: str, anchor: str) -> str:
    """The anchor of a place in the part about a block."""
    return f"{block}--{anchor}" if anchor else block


def _titled(html: str, anchor: str) -> str:
    return html.replace("<h1>", f'<h1 id="{anchor}">', 1)


def _about(html: str) -> str:
    """The first sentence of a page."""
    found = _FIRST_SENTENCE.search(html)
    return plain(found[1]) if found else ""


TRIED = DOCS / "robot_blocks.md"
"""What tools/robot_pages.py blocks found out about each block, on both robots."""

_ROW = re.compile(r"\| (.+) \| (.+) \| (yes|\*\*no\*\*) \| (yes|\*\*no\*\*) \|")
OURS = "nao"


@cache
def tried() -> dict[str, tuple[str, bool, bool]]:
    """By the English sentence of a block: what was looked at, and whether it was right on each."""
    rows = (_ROW.fullmatch(line) for line in TRIED.read_text(encoding="utf-8").splitlines())
    return {row[1]: (row[2], row[3] == "yes", row[4] == "yes") for row in rows if row}


@cache
def others() -> dict[str, dict[str, dict[str, object]]]:
    """The choices of the other robots that we ship, by their titles."""
    files = sorted((paths.resources() / "robots").glob("*/robot.toml"))
    told = [tomllib.loads(file.read_text("utf-8")) for file in files if file.parent.name != OURS]
    return {each["title"]: each["choices"] for each in told}


def robots_html(code: str, language: Language, definition: Definition, english: Definition) -> str:
    """What is said of robots in the part about a block."""
    heading = f"<h3>{escape(word(code, 'robots'))}</h3>"
    found = tried().get(english.in_words.replace("|", "\\|"))
    if found is None:
        return f"{heading}<p>{escape(word(code, 'any_robot'))}</p>"
    look, on_screen, on_real = found
    lines = [
        _line(code, "screen", on_screen, look if code == "en" else ""),
        _line(code, "real", on_real),
        *(escape(line) for line in _fewer(code, language, definition)),
    ]
    return f'{heading}<ul class="robots">{"".join(f"<li>{line}</li>" for line in lines)}</ul>'


def _line(code: str, robot: str, works: bool, look: str = "") -> str:
    sign = '<span aria-hidden="true">✓</span> ' if works else ""
    tail = f" (tried by a test: {escape(look)})" if look else ""
    answer = word(code, "yes" if works else "no")
    return f"{sign}{escape(word(code, robot))}: {escape(answer)}{tail}"


def _fewer(code: str, language: Language, definition: Definition) -> Iterator[str]:
    for title, choices in others().items():
        for slot in definition.slots.values():
            known = language.choices.get(slot.table, {})
            some = [name for name in choices.get(slot.table, {}) if name in known]
            if some and len(some) < len(known):
                values = {"robot": title, "some": len(some), "all": len(known)}
                yield word(code, "fewer", **values, slot=tr(slot_name(slot)))
