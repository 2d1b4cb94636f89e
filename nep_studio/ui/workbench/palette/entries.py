"""What the palette lists: drawers with blocks, buttons, and snippets, one below the other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import Literal

from msgspec.structs import replace as replaced

from nep_studio.blocks.definitions import Category, Definition
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddProcedure
from nep_studio.blocks.edits.placing import CreateBlocks
from nep_studio.blocks.edits.project import AddVariable
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import Clip, copy, copy_of, python_of
from nep_studio.blocks.operations.packing import definitions_in
from nep_studio.blocks.packs import Pack
from nep_studio.blocks.places import NewStack
from nep_studio.blocks.procedures import CALL, definitions_of, procedure_of
from nep_studio.blocks.program import ALL_ROBOTS, Block, Project
from nep_studio.blocks.slots import FieldValue
from nep_studio.blocks.text import sentence
from nep_studio.help.texts import BlockText, block_texts
from nep_studio.ui.theme.icons import category_icon_name
from nep_studio.ui.words import language_code, tr
from nep_studio.ui.workbench.snippets import Snippet

from .levels import LEVELS, Level, first_by_heading, is_within, level_of, offer

# One sample of every block that the palette offers, in a small project of its own.

READ_VARIABLE = "variable.get"


class Stock:
    """The samples, made from an editor's language, with its variables and own blocks.

    Own blocks of ``packs`` that the project has no copy of are samples, too: ``kept`` are their
    packs by own block. Ids of samples are those of blocks in ``project``, which whatever draws a
    project can draw.
    """

    def __init__(self, editor: Editor, packs: Iterable[Pack] = ()) -> None:
        self.language = editor.language
        self.project = Project("Palette")
        for number, variable in enumerate(editor.project.variables):
            AddVariable(variable.id, variable.name, number).apply(self.project)
        for number, procedure in enumerate(editor.project.procedures.values()):
            AddProcedure(procedure, number).apply(self.project)
        self.project.extra = editor.project.extra
        self._own = list(self.project.procedures)
        self.kept: dict[str, Pack] = {}
        for number, pack in enumerate(packs):
            self._take_in(editor.project, pack, number)
        self._ids: dict[tuple[object, ...], str] = {}

    def sample(self, block_type: str, **fields: FieldValue) -> str:
        """The id of the sample of a type; slots for a variable hold the first one there is."""
        key = (block_type, *fields.items())
        if key not in self._ids:
            self._ids[key] = self._new(self.language.definitions[block_type], fields)
        return self._ids[key]

    def offered(self, category: str) -> Iterable[str]:
        """The samples of a category, in the order of the palette."""
        variables = self.project.variables
        if category == "my":
            yield from self._calls(self._own)
        if category == "variable":
            for variable in variables:
                yield self.sample(READ_VARIABLE, variable=variable.id)
        for definition in self.language.definitions.values():
            is_own = definition.id.startswith("my.") and definition.id.count(".") > 1
            is_here = definition.category.id == category and not is_own
            if is_here and definition.id != READ_VARIABLE:
                yield self.sample(definition.id)
        if category == "my":
            yield from self._calls(self.kept)

    def shown(self, category: str, level: Level) -> Iterable[str]:
        """The samples of a drawer at a level; at the first one it has blocks of several."""
        if level == "first":
            if category == "my":
                return list(self._calls((*self._own, *self.kept)))
            first = first_by_heading(self.project, self.language).get(category, [])
            return [self.sample(block_type) for block_type in first]
        samples = self.offered(category)
        is_all = level == "all"
        return [one for one in samples if is_all or not offer().is_rare(self.definition(one))]

    def clip(self, sample: str) -> Clip:
        """A sample as blocks to be put into a program, for a robot that is there now."""
        clip = copy(self.project, self.language, [sample])
        for block in clip.project.blocks.values():
            self._choose_robot(block)
        return self._with_definitions(clip, sample)

    def pack_of(self, sample: str) -> Pack | None:
        """The pack of the library that a sample is from, or None for one of the project."""
        return self.kept.get(procedure_of(self.project.blocks[sample].type))

    def words(self, sample: str) -> str:
        """What a sample says."""
        return sentence(self.project, self.language, sample)

    def definition(self, sample: str) -> Definition:
        """The definition of a sample."""
        return self.language.definitions[self.project.blocks[sample].type]

    def _calls(self, procedures: Iterable[str]) -> Iterator[str]:
        yield from (self.sample(CALL + procedure) for procedure in procedures)

    def _take_in(self, project: Project, pack: Pack, number: int) -> None:
        """Offer the blocks of a pack that a project has no copy of."""
        new = [
            replaced(procedure, id=f"kept{number}_{procedure.id}")
            for procedure in pack.offered
            if copy_of(project, procedure) is None
        ]
        for procedure in new:
            AddProcedure(procedure, len(self.project.procedures)).apply(self.project)
            self.kept[procedure.id] = pack
        made = definitions_of(new, self.language.words, self.language.code)
        definitions = {**self.language.definitions, **made}
        self.language = replace(self.language, definitions=definitions)

    def _with_definitions(self, clip: Clip, sample: str) -> Clip:
        """What a block of the library needs comes along with it."""
        own = procedure_of(self.project.blocks[sample].type)
        pack, origin = self.kept.get(own), None
        if pack is not None:
            origin = self.project.procedures[own].origin
        if pack is None or origin is None:
            return clip
        return replace(clip, along=definitions_in(pack, self.language, [origin.block]))

    def _new(self, definition: Definition, fields: dict[str, FieldValue]) -> str:
        block = definition.new_block(self.project.new_id("b"))
        first = next((variable.id for variable in self.project.variables), "")
        for key, slot in definition.keys(block.groups):
            if slot.kind.name == "variable" and first:
                block.fields[key] = first
        self._choose_robot(block)
        block.fields.update(fields)
        stacks = self.project.pages[definition.page]
        place = NewStack(definition.page, self.project.new_id("s"), 0.0, 0.0, len(stacks))
        CreateBlocks((block.id,), (block,), place).apply(self.project)
        return block.id

    def _choose_robot(self, block: Block) -> None:
        """Let the first robot of the project do it, where the usual one takes no part."""
        robots, definition = self.language.robots, self.language.definitions[block.type]
        for key, slot in definition.keys(block.groups) if robots else ():
            if slot.kind.name == "robot" and block.fields.get(key) not in (*robots, ALL_ROBOTS):
                block.fields[key] = next(iter(robots))


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
    ``action`` what a button does, ``note`` what stands below a block.
    """

    kind: EntryKind
    drawer: Drawer
    text: str
    sample: str = ""
    action: str = ""
    snippet: Snippet | None = None
    note: str = ""

    @property
    def is_choosable(self) -> bool:
        """Whether the keyboard stops at it."""
        return self.kind in ("block", "button", "snippet")


def recent_drawer() -> Drawer:
    """The drawer with what was used last."""
    return Drawer(RECENT, tr("Recently used"), "history")


def drawers_of(
    editor: Editor,
    kind: str,
    level: Level,
    *,
    has_recent: bool,
    has_snippets: bool,
    has_library: bool = False,
) -> list[Drawer]:
    """The drawers for a kind of page: what was used last, the categories, the snippets.

    First blocks are shown without what was used last: each block is there once.
    """
    known = {category.id: category for category in editor.language.categories}
    snippets = Drawer(SNIPPETS, tr("My snippets"), "star")
    if level == "first":
        first = list(first_by_heading(editor.project, editor.language))
        own = ["my"] if editor.project.procedures or has_library else []
        drawers = [_drawer(known[one]) for one in dict.fromkeys([*first, *own])]
        return [*drawers, snippets] if has_snippets else drawers
    drawers = [recent_drawer()] if has_recent else []
    rare = offer().rare_categories if level == "more" else ()
    shown = (one for one in known.values() if one.page == kind and one.id not in rare)
    return [*drawers, *map(_drawer, shown), snippets]


def _drawer(category: Category) -> Drawer:
    icon = category_icon_name(category.colour)
    return Drawer(category.id, category.title, icon, category.colour)


def entries_of(
    stock: Stock,
    drawers: Iterable[Drawer],
    level: Level,
    recent: Sequence[str],
    snippets: Sequence[Snippet],
) -> list[Entry]:
    """The whole list: for each drawer its title and what is in it; empty categories are left out.

    ``recent`` are types of blocks.
    """
    entries: list[Entry] = []
    for drawer in drawers:
        inside = list(_inside(stock, drawer, level, recent, snippets))
        if inside:
            entries += [Entry("heading", drawer, drawer.title), *inside]
    return entries


def found_entries(stock: Stock, samples: Iterable[str], typed: str, level: Level) -> list[Entry]:
    """The list of a search: what was found, or that there is nothing.

    What is not shown at this level says where it is from.
    """
    drawer = Drawer("found", tr("Found"), "search")
    found = [replace(_block(stock, drawer, s), note=_from(stock, s, level)) for s in samples]
    if found:
        return found
    words = tr("No block says “{typed}”. Try another word.", typed=typed)
    return [Entry("words", drawer, words)]


def _from(stock: Stock, sample: str, level: Level) -> str:
    definition = stock.definition(sample)
    at = level_of(stock.project, stock.language, definition.id)
    if definition.page != "behaviour" or is_within(at, level):
        return ""
    return tr("In “{level}”: {title}", level=tr(LEVELS[at]), title=definition.category.title)


def _inside(
    stock: Stock,
    drawer: Drawer,
    level: Level,
    recent: Sequence[str],
    snippets: Sequence[Snippet],
) -> Iterator[Entry]:
    if drawer.id == RECENT:
        for block_type in recent:
            yield _block(stock, drawer, stock.sample(block_type))
        return
    if drawer.id == SNIPPETS:
        yield from _snippets(drawer, level, snippets)
        return
    if drawer.id == "my" and level != "first":
        yield Entry("button", drawer, tr("Make a block…"), action=MAKE_BLOCK)
    if drawer.id == "variable" and level != "first":
        yield Entry("button", drawer, tr("New variable…"), action=NEW_VARIABLE)
    is_kept = False
    for sample in stock.shown(drawer.id, level):
        if not is_kept and stock.pack_of(sample) is not None:
            is_kept = True
            yield Entry("words", drawer, tr("From my library:"))
        yield _block(stock, drawer, sample)


def _snippets(drawer: Drawer, level: Level, snippets: Sequence[Snippet]) -> Iterator[Entry]:
    if not snippets:
        words = tr(
            "Keep blocks here to use them in any project: select some, then press the button below."
        )
        yield Entry("words", drawer, words)
    for snippet in snippets:
        yield Entry("snippet", drawer, snippet.name, snippet=snippet)
    if level == "first":
        return
    yield Entry("button", drawer, tr("Keep the selection…"), action=KEEP_SNIPPET)
    yield Entry("button", drawer, tr("Import a snippet…"), action=IMPORT_SNIPPET)


def _block(stock: Stock, drawer: Drawer, sample: str) -> Entry:
    return Entry("block", drawer, stock.words(sample), sample=sample)


# What a block of the palette does, in a few lines: its sentence, its help, its Python.

LONGEST_CODE = 400


def tip(stock: Stock, sample: str) -> str:
    """The tool tip of a sample, as rich text."""
    parts = [f"<b>{escape(stock.words(sample))}</b>"]
    parts += [f"<p>{escape(text)}</p>" for text in does(stock.definition(sample)) if text]
    code = python(stock.project, stock.language, sample)
    if code:
        parts.append(f"<p>{escape(tr('In Python:'))}</p><pre>{escape(code)}</pre>")
    return "".join(parts)


def python(project: Project, language: Language, block: str) -> str:
    """The Python of a block; empty when it makes none by itself."""
    try:
        code = python_of(project, language, [block]).strip()
    except BlocksError:
        return ""
    return code if len(code) <= LONGEST_CODE else code[:LONGEST_CODE].rstrip() + " …"


def does(definition: Definition) -> list[str]:
    """What the blocks of a definition do, in sentences; some may be empty."""
    told = [definition.about or block_texts(language_code()).get(definition.id, BlockText()).about]
    if "takes_time" in definition.flags:
        told.append(tr("The program waits here until it is done."))
    if "needs_real_robot" in definition.flags:
        told.append(tr("Needs a real robot: the one on the screen cannot do it."))
    return told
