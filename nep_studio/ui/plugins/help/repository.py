"""All pages of the help, in the language in use: their contents, each page, what is searched."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from html import escape

from nep_core.processes.manifest import Manifest
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.language import Language
from nep_studio.blocks.typing_in.vocabulary import vocabulary
from nep_studio.help import markdown
from nep_studio.help.index import Findable, Index
from nep_studio.help.texts import (
    BLOCK,
    CATEGORY,
    HOME,
    HOW_TO,
    NODE,
    Example,
    category_texts,
    error_anchor,
    error_texts,
    example_of,
    page_texts,
    split,
)
from nep_studio.ui.theme.icons import category_icon_name
from nep_studio.ui.words import language_code, tr

from .pages import (
    PICTURE,
    block_html,
    link,
    manifests,
    node_html,
    node_title,
    sample_words,
    text_of,
)

Rows = Iterable[tuple[str, str]]

HOW_TO_RANK = 1.5
"""How much more a page counts that people have written than one about a part."""


@dataclass(frozen=True)
class Content:
    """A line of the table of contents, with those under it."""

    page: str
    title: str
    icon: str
    inside: tuple[Content, ...] = ()


@dataclass(frozen=True)
class Page:
    """A page that can be shown; some have an example that can be put into a program."""

    name: str
    title: str
    html: str
    example: Example | None = field(default=None, compare=False)


class Book:
    """The help in one language. ``shortcuts`` gives what keys do, for the page about them."""

    def __init__(self, language: Language, shortcuts: Callable[[], Rows] = lambda: ()) -> None:
        self.language = language
        self._shortcuts = shortcuts
        self._manifests = manifests()

    # What there is

    @cached_property
    def titles(self) -> dict[str, str]:
        """The title of each page by its name, in the order of the contents."""
        titles = {HOME: tr("Help")}
        titles |= {HOW_TO + name: document.title for name, document in self._written.items()}
        for category in self.language.categories:
            titles[CATEGORY + category.id] = category.title
        for definition in self.language.definitions.values():
            titles[BLOCK + definition.id] = sample_words(self.language, definition)
        nodes = self.language.choices.get("nodes", {})
        for name, manifest in self._manifests.items():
            titles[NODE + name] = node_title(manifest, nodes)
        return titles

    def contents(self) -> tuple[Content, ...]:
        """The table of contents."""
        return (
            Content(HOME, tr("How to"), "book-open", tuple(self._how_tos())),
            Content(HOME, tr("Blocks"), "blocks", tuple(self._categories())),
            Content(HOME, tr("Nodes"), "network", tuple(self._nodes())),
        )

    def resolve(self, name: str) -> str:
        """The page and place that a name means, also one of a manifest; the first page else."""
        page, anchor = split(name)
        for candidate in (page, f"{HOW_TO}{page}", *self._by_old_name(page)):
            if candidate in self.titles:
                return f"{candidate}#{anchor}" if anchor else candidate
        return HOME

    def page(self, name: str) -> Page:
        """A page, made when it is asked for; the first page for a name that there is not."""
        name = split(self.resolve(name))[0]
        kind, rest = self._kind(name)
        example = None
        if kind == BLOCK:
            definition = self.language.definitions[rest]
            html, example = block_html(self.language, definition, self.titles), example_of(rest)
        elif kind == CATEGORY:
            html = self._category_html(rest)
        elif kind == NODE:
            html = node_html(self._manifests[rest], self.titles[name])
        elif kind == HOW_TO:
            html = self._how_to_html(rest)
        else:
            html = self._home_html()
        return Page(name, self.titles[name], html, example)

    # What is searched

    def new_index(self) -> Index:
        """An index without pages, which knows other words for the words of blocks."""
        return Index(vocabulary(self.language).meanings)

    def findables(self) -> Iterator[Findable]:
        """What is to be taken into the index, one page at a time."""
        for name, document in self._written.items():
            heads = " ".join(heading.words for heading in document.headings)
            words = f"{document.about.get('words', '')} {heads}"
            if name == "problems":
                words += " ".join(tr(title) for title in error_texts(language_code()))
            yield Findable(HOW_TO + name, document.title, words, document.text, HOW_TO_RANK)
        for definition in self.language.definitions.values():
            yield self._findable(definition)
        for category in self.language.categories:
            about = category_texts(language_code()).get(category.id, "")
            yield Findable(CATEGORY + category.id, category.title, text=about, rank=0.9)
        for name, manifest in self._manifests.items():
            words = " ".join((manifest.name, *manifest.parameters, *manifest.says))
            text = f"{manifest.description} {node_html(manifest, '')}"
            yield Findable(NODE + name, self.titles[NODE + name], words, text, 0.9)

    def _findable(self, definition: Definition) -> Findable:
        told = text_of(definition.id)
        choices = [
            " ".join(self.language.choices.get(slot.table, {}).values())
            for slot in definition.slots.values()
            if slot.table
        ]
        words = (
            f"{definition.in_words} {told.words} {definition.call.name if definition.call else ''}"
        )
        text = " ".join((told.about, told.tip, *told.slots.values(), *choices))
        title = self.titles[BLOCK + definition.id]
        return Findable(BLOCK + definition.id, title, words, text)

    # How it is put together

    @cached_property
    def _written(self) -> dict[str, markdown.Document]:
        """What people have written, in its order."""
        read = {name: markdown.read(text) for name, text in page_texts(language_code()).items()}
        order = sorted(read.items(), key=lambda item: int(item[1].about.get("order", "99")))
        return dict(order)

    def _how_tos(self) -> Iterator[Content]:
        for name, document in self._written.items():
            icon = document.about.get("icon", "file-text")
            yield Content(HOW_TO + name, document.title, icon)

    def _categories(self) -> Iterator[Content]:
        for category in self.language.categories:
            inside = tuple(
                Content(BLOCK + definition.id, self.titles[BLOCK + definition.id], "")
                for definition in self._blocks_of(category.id)
            )
            icon = category_icon_name(category.colour, category.id)
            yield Content(CATEGORY + category.id, category.title, icon, inside)

    def _nodes(self) -> Iterator[Content]:
        for name, manifest in self._manifests.items():
            yield Content(NODE + name, self.titles[NODE + name], _icon(manifest))

    def _blocks_of(self, category: str) -> Iterator[Definition]:
        definitions = self.language.definitions.values()
        return (each for each in definitions if each.category.id == category)

    def _by_old_name(self, page: str) -> Iterator[str]:
        """Pages as definitions and manifests name them: "nodes/nao", "blocks/robot_say"."""
        kind, _, rest = page.partition("/")
        if kind == "nodes":
            yield from (NODE + name for name, m in self._manifests.items() if m.help == page)
        elif kind == "blocks" and rest:
            named = self.language.definitions.values()
            yield from (BLOCK + each.id for each in named if each.help == page)

    def _kind(self, name: str) -> tuple[str, str]:
        for kind in (BLOCK, CATEGORY, NODE, HOW_TO):
            if name.startswith(kind):
                return kind, name.removeprefix(kind)
        return HOME, ""

    def _home_html(self) -> str:
        parts = [f"<h1>{escape(tr('Help'))}</h1>"]
        words = tr("Press F1 on anything to come to what is said about it.")
        parts.append(f"<p>{escape(words)}</p>")
        for content in self.contents():
            items = "".join(f"<li>{link(each.page, each.title)}</li>" for each in content.inside)
            parts.append(f"<h2>{escape(content.title)}</h2><ul>{items}</ul>")
        return "".join(parts)

    def _category_html(self, category: str) -> str:
        about = category_texts(language_code()).get(category, "")
        parts = [f"<h1>{escape(self.titles[CATEGORY + category])}</h1>", f"<p>{escape(about)}</p>"]
        for definition in self._blocks_of(category):
            page = BLOCK + definition.id
            picture = f'<a href="help:{page}"><img src="{PICTURE}{definition.id}"></a>'
            words = markdown.inline(text_of(definition.id).about)
            parts.append(f"<p>{picture}<br>{words} {link(page, tr('More'))}</p>")
        if category == "my":
            parts.append(
                f"<p>{link(HOW_TO + 'own-blocks', self.titles[HOW_TO + 'own-blocks'])}</p>"
            )
        return "".join(parts)

    def _how_to_html(self, name: str) -> str:
        inserts = {"shortcuts": _table(self._shortcuts()), "errors": _errors_html()}
        return markdown.read(page_texts(language_code())[name], inserts).html


def _icon(manifest: Manifest) -> str:
    return manifest.icon


def _table(rows: Rows) -> str:
    told = "".join(f"<tr><td>{escape(k)}</td><td>{escape(w)}</td></tr>" for w, k in rows)
    heads = f"<tr><th>{escape(tr('Keys'))}</th><th>{escape(tr('What it does'))}</th></tr>"
    return f'<table class="table" width="100%" cellspacing="0">{heads}{told}</table>'


def _errors_html() -> str:
    """Every message, what it means, and what to try."""
    parts = []
    for title, told in error_texts(language_code()).items():
        steps = "".join(
            f'<li class="unchecked">{markdown.inline(step)}</li>' for step in told.get("try", ())
        )
        words = markdown.inline(told.get("about", ""))
        anchor = error_anchor(title)
        parts.append(
            f'<h3><a name="{anchor}"></a>{escape(tr(title))}</h3><p>{words}</p><ul>{steps}</ul>'
        )
    return "".join(parts)
