"""What the palette lists: drawers with blocks, buttons, and snippets, one below the other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from nep_studio.blocks.editor import Editor
from nep_studio.ui.snippets import Snippet
from nep_studio.ui.theme import category_icon_name
from nep_studio.ui.words import tr

from .stock import Stock

RECENT, SNIPPETS = "recent", "snippets"
MAKE_BLOCK, NEW_VARIABLE, KEEP_SNIPPET, IMPORT_SNIPPET = "block", "variable", "keep", "import"

EntryKind = Literal["heading", "block", "button", "snippet", "words"]


@dataclass(frozen=True, slots=True)
class Drawer:
    """A part of the palette; ``colour`` names the colours of its blocks, if it has its own."""

    id: str
    title: str
    icon: str
    colour: str = ""


@dataclass(frozen=True, slots=True)
class Entry:
    """One thing in the list.

    ``text`` is its label, and what a screen reader says; ``sample`` the block of the stock;
    ``action`` what a button does.
    """

    kind: EntryKind
    drawer: Drawer
    text: str
    sample: str = ""
    action: str = ""
    snippet: Snippet | None = None

    @property
    def is_choosable(self) -> bool:
        """Whether the keyboard stops at it."""
        return self.kind in ("block", "button", "snippet")


def recent_drawer() -> Drawer:
    """The drawer with what was used last."""
    return Drawer(RECENT, tr("Recently used"), "history")


def drawers_of(editor: Editor, kind: str, *, has_recent: bool) -> list[Drawer]:
    """The drawers for a kind of page: what was used last, the categories, the snippets."""
    drawers = [recent_drawer()] if has_recent else []
    for category in editor.language.categories:
        if category.page == kind:
            icon = category_icon_name(category.colour, category.id)
            drawers.append(Drawer(category.id, category.title, icon, category.colour))
    return [*drawers, Drawer(SNIPPETS, tr("My snippets"), "star")]


def entries_of(
    stock: Stock, drawers: Iterable[Drawer], recent: Sequence[str], snippets: Sequence[Snippet]
) -> list[Entry]:
    """The whole list: for each drawer its title and what is in it; empty categories are left out.

    ``recent`` are types of blocks.
    """
    entries: list[Entry] = []
    for drawer in drawers:
        inside = list(_inside(stock, drawer, recent, snippets))
        if inside:
            entries += [Entry("heading", drawer, drawer.title), *inside]
    return entries


def found_entries(stock: Stock, samples: Iterable[str], typed: str) -> list[Entry]:
    """The list of a search: what was found, or that there is nothing."""
    drawer = Drawer("found", tr("Found"), "search")
    found = [_block(stock, drawer, sample) for sample in samples]
    if found:
        return found
    words = tr("No block says “{typed}”. Try another word.", typed=typed)
    return [Entry("words", drawer, words)]


def _inside(
    stock: Stock, drawer: Drawer, recent: Sequence[str], snippets: Sequence[Snippet]
) -> Iterator[Entry]:
    if drawer.id == RECENT:
        for block_type in recent:
            yield _block(stock, drawer, stock.sample(block_type))
        return
    if drawer.id == SNIPPETS:
        yield from _snippets(drawer, snippets)
        return
    if drawer.id == "my":
        yield Entry("button", drawer, tr("Make a block…"), action=MAKE_BLOCK)
    if drawer.id == "variable":
        yield Entry("button", drawer, tr("New variable…"), action=NEW_VARIABLE)
    for sample in stock.offered(drawer.id):
        yield _block(stock, drawer, sample)


def _snippets(drawer: Drawer, snippets: Sequence[Snippet]) -> Iterator[Entry]:
    if not snippets:
        words = tr(
            "Keep blocks here to use them in any project: select some, then press the button below."
        )
        yield Entry("words", drawer, words)
    for snippet in snippets:
        yield Entry("snippet", drawer, snippet.name, snippet=snippet)
    yield Entry("button", drawer, tr("Keep the selection…"), action=KEEP_SNIPPET)
    yield Entry("button", drawer, tr("Import a snippet…"), action=IMPORT_SNIPPET)


def _block(stock: Stock, drawer: Drawer, sample: str) -> Entry:
    return Entry("block", drawer, stock.words(sample), sample=sample)
