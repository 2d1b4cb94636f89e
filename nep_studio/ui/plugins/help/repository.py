"""All pages of the help, in the language in use: their contents, each page, what is searched."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from html import escape

from nep_core.errors import ManifestError
from nep_core.places import node_folders
from nep_core.processes.manifest import Manifest, NodeCatalog, Parameter, read_manifest
from nep_studio.blocks.definitions import Definition, Slot
from nep_studio.blocks.edits.project import AddVariable
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.generate.program import generate_launch
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import Clip, clip_of, python_of
from nep_studio.blocks.program import Block, Project
from nep_studio.blocks.text import field_text, sentence
from nep_studio.blocks.typing_in.vocabulary import vocabulary
from nep_studio.help import markdown
from nep_studio.help.index import Findable, Index
from nep_studio.help.markdown import code_html, inline
from nep_studio.help.texts import (
    BLOCK,
    CATEGORY,
    HOME,
    HOW_TO,
    NODE,
    BlockText,
    Example,
    block_texts,
    category_texts,
    error_anchor,
    error_texts,
    example_of,
    examples,
    node_texts,
    page_texts,
    split,
)
from nep_studio.ui.canvas.fields.editors import slot_name
from nep_studio.ui.theme.icons import category_icon_name
from nep_studio.ui.words import language_code, tr
from nep_studio.ui.workbench.help_card import flag_words, shape_words

# The page of a block: picture, what it does, its slots, an example, its Python, what is near.

MOST_CHOICES = 12
EVERY_BLOCK = "*"
"""The key under which slots are explained that many blocks have."""

SAID_BY_WORDS = frozenset({"body", "boolean", "list", "robot"})
"""Kinds of slot of which nothing more need be said where people have written about the slot."""

TAKES_BLOCKS_TOO = frozenset({"checkbox", "choice", "line", "robot", "state"})
"""Kinds of slot of which nobody sees that they take blocks: they are chosen, or typed."""

PICTURE, EXAMPLE, DRAG = "picture:", "example:", "drag:"
CHOOSE = "choose:"
"""What addresses of pictures begin with, links out of which an example is dragged, and links that
let the buttons below the page act on one."""


def block_html(language: Language, definition: Definition, titles: dict[str, str]) -> str:
    """The page of a block; ``titles`` are those of other pages, for links."""
    told = text_of(definition.id)
    example = example_of(definition.id)
    parts = [
        f"<h1>{escape(titles[BLOCK + definition.id])}</h1>",
        f'<p><img src="{PICTURE}{definition.id}"></p>',
        f"<p>{inline(told.about)}</p>" if told.about else "",
        f'<p class="hint">{escape(" ".join(needs(definition)))}</p>',
        tip_html(told.tip),
        slots_html(language, definition, told),
        example_html(language, example, definition.page),
        _see_html(definition, told, titles),
    ]
    return "\n".join(part for part in parts if part)


def text_of(block_type: str) -> BlockText:
    """What people wrote about a block, in the language in use."""
    return block_texts(language_code()).get(block_type, BlockText())


def needs(definition: Definition) -> Iterator[str]:
    """What kind of block it is, and what must be there for it."""
    yield _shape(definition)
    if "takes_time" in definition.flags:
        yield tr("The program waits here until it is done.")
    yield from flag_words(definition)
    if "needs_real_robot" in definition.flags:
        yield tr("Needs a real robot: the one on the screen cannot do it.")
    if any(slot.kind.name == "gesture" for slot in definition.slots.values()):
        yield tr("A node must recognise the gesture: Run adds one where none is on the page Nodes.")


def _shape(definition: Definition) -> str:
    if definition.page != "behaviour":
        return tr("It is a line of its page: the order does not matter.")
    return shape_words(definition)


def tip_html(tip: str) -> str:
    """A tip in a box of its own."""
    if not tip:
        return ""
    words = f"<b>{escape(tr('Tip:'))}</b> {inline(tip)}"
    return f'<table class="tip" width="100%" cellspacing="0"><tr><td>{words}</td></tr></table>'


def slots_html(language: Language, definition: Definition, told: BlockText) -> str:
    """A table of the places of a block: what goes in, and what is in it at first."""
    rows = [_slot_row(language, definition, told, slot) for slot in definition.slots.values()]
    heads = tr("Name"), tr("What goes in")
    return f"<h2>{escape(tr('Its places'))}</h2>{_table(heads, rows)}" if rows else ""


def _table(heads: Iterable[str], rows: Iterable[str]) -> str:
    head = "".join(f"<th>{escape(words)}</th>" for words in heads)
    told = "".join(rows)
    return f'<table class="table" width="100%" cellspacing="0"><tr>{head}</tr>{told}</table>'


def _slot_row(language: Language, definition: Definition, told: BlockText, slot: Slot) -> str:
    words = told.slots.get(slot.name) or text_of(EVERY_BLOCK).slots.get(slot.name, "")
    hints = list(_hints(language, definition, slot, has_words=bool(words)))
    parts = [escape(words)] if words else []
    parts += [f'<span class="hint">{escape(hint)}</span>' for hint in hints]
    name = f'<a name="slot-{slot.name}"></a><b>{escape(tr(slot_name(slot)))}</b>'
    return f"<tr><td>{name}</td><td>{'<br>'.join(parts)}</td></tr>"


def _hints(
    language: Language, definition: Definition, slot: Slot, *, has_words: bool
) -> Iterator[str]:
    """What kind of value fits, what is there at first, and how there are more of these."""
    block = definition.new_block("b1")
    if not has_words or slot.kind.name not in SAID_BY_WORDS:
        yield _kind(language, block, slot)
    if slot.pluggable and slot.kind.name in TAKES_BLOCKS_TOO:
        yield tr("A block that gives it fits here too, such as a variable.")
    value = _default(language, definition, block, slot)
    if value and slot.kind.name != "robot":
        yield tr("At first: {value}", value=value)
    if slot.group and definition.group_slots(slot.group)[0] == slot.name:
        yield tr("Press + on the block to add it.")


def _kind(language: Language, block: Block, slot: Slot) -> str:
    """What kind of value fits, its limits, or what can be chosen."""
    kind = tr(slot.kind.noun)
    if slot.low is not None and slot.high is not None:
        ends = {"low": f"{slot.low:g}", "high": f"{slot.high:g}"}
        kind = tr("{kind} from {low} to {high}", kind=kind, **ends)
    key = f"{slot.name}.1" if slot.group else slot.name
    choices = list(language.choices_of(slot, block, key).values())
    if choices:
        more = ", …" if len(choices) > MOST_CHOICES else ""
        return ", ".join(choices[:MOST_CHOICES]) + more
    return kind


def _default(language: Language, definition: Definition, block: Block, slot: Slot) -> str:
    value = definition.defaults.get(slot.name, "")
    return "" if value == "" else field_text(Project(), language, block, slot, value)


def example_html(language: Language, example: Example | None, page: str) -> str:
    """An example to be dragged out, and how it reads in Python."""
    if example is None:
        return ""
    picture = f'<a href="{DRAG}{example.name}"><img src="{EXAMPLE}{example.name}"></a>'
    return (
        f'<h2><a name="example"></a>{escape(tr("Example"))}</h2>'
        f"<p>{picture}</p>"
        f'<p class="hint">{escape(tr("Drag it onto the page, or use the buttons below."))}</p>'
        f"<h2>{escape(tr('In Python'))}</h2>"
        f"{code_html(python(language, example, page))}"
    )


def python(language: Language, example: Example, page: str = "behaviour") -> str:
    """The Python of an example: its rules, or how it is launched where that is what it shows."""
    project = example.clip(language, language_code()).project
    try:
        if page != "behaviour":
            return generate_launch(project, language).text.strip()
        whole = (block for stack in project.pages[page] for block in stack.body)
        return python_of(project, language, whole).strip()
    except BlocksError as error:  # the example is shown all the same
        return f"# {error.sentence}"


def _see_html(definition: Definition, told: BlockText, titles: dict[str, str]) -> str:
    """Links to what is near: other blocks, pages, the category."""
    near = (BLOCK + name if "." in name else HOW_TO + name for name in told.see)
    links = [link(page, titles[page]) for page in near if page in titles]
    words = tr("All blocks of “{category}”", category=definition.category.title)
    links.append(link(CATEGORY + definition.category.id, words))
    items = "".join(f"<li>{each}</li>" for each in links)
    return f"<h2>{escape(tr('See also'))}</h2><ul>{items}</ul>"


def link(page: str, words: str) -> str:
    """A link to another page."""
    return f'<a href="help:{escape(page)}">{escape(words)}</a>'


# A block of each type as it is when it is new, for its picture and its title.


def sample_clip(language: Language, definition: Definition) -> Clip:
    """One new block; where it names a variable, there is one."""
    names = [slot.name for slot in definition.slots.values() if slot.kind.name == "variable"]
    clip = clip_of(language, definition.id, **dict.fromkeys(names, "v1"))
    if names:
        AddVariable("v1", tr("variable"), 0).apply(clip.project)
    return clip


# The page of a node, made from its manifest: what it does, its settings, its topics.


def manifests() -> Mapping[str, Manifest]:
    """The manifests of all nodes that can be launched, by id; wrong ones are left out."""
    found: dict[str, Manifest] = {}
    for path in NodeCatalog(node_folders()).paths():
        try:
            manifest = read_manifest(path)
        except ManifestError:
            continue  # its problem is told where it is launched
        found.setdefault(manifest.id, manifest)
    return found


def node_title(manifest: Manifest, titles: Mapping[str, str]) -> str:
    """What a node is called; ``titles`` are those in the language in use."""
    return titles.get(manifest.id) or tr(manifest.title)


def node_html(manifest: Manifest, title: str) -> str:
    """The page of a node."""
    told = node_texts(language_code()).get(manifest.id, "")
    parts = [
        f"<h1>{escape(title)}</h1>",
        f"<p>{inline(told or tr(manifest.description))}</p>",
        f"<p>{escape(_type(manifest.type))}</p>",
        _settings(manifest),
        _topics(manifest),
        f"<h2>{escape(tr('In a terminal'))}</h2>",
        code_html(f"nep-studio node {manifest.id}"),
    ]
    return "\n".join(part for part in parts if part)


def _type(name: str) -> str:
    return {
        "sensory": tr("It measures: it publishes what a sensor says."),
        "perceptual": tr("It recognises: it turns measurements into human states."),
        "cognitive": tr("It decides: it runs a program."),
        "action": tr("It acts: it moves a robot."),
    }[name]


def _settings(manifest: Manifest) -> str:
    heads = tr("Setting"), tr("What it is"), tr("Usually")
    rows = [_row(name, each) for name, each in manifest.parameters.items()]
    return f"<h2>{escape(tr('Its settings'))}</h2>{_table(heads, rows)}" if rows else ""


def _row(name: str, parameter: Parameter) -> str:
    usual = parameter.default
    if parameter.required:
        shown = tr("must be given")
    elif isinstance(usual, bool):
        shown = tr("on") if usual else tr("off")
    else:
        shown = "" if usual in ("", None) else f"{usual:g}" if _is_number(usual) else str(usual)
    told = "<br>".join(escape(part) for part in (tr(parameter.help), _limits(parameter)) if part)
    return (
        f'<tr><td><a name="setting-{name}"></a><b>{escape(name)}</b></td>'
        f"<td>{told}</td><td>{escape(shown)}</td></tr>"
    )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _limits(parameter: Parameter) -> str:
    if parameter.choices:
        return ", ".join(parameter.choices)
    if parameter.minimum is not None and parameter.maximum is not None:
        low, high = f"{parameter.minimum:g}", f"{parameter.maximum:g}"
        return tr("{kind} from {low} to {high}", kind=tr("a number"), low=low, high=high)
    return ""


def _topics(manifest: Manifest) -> str:
    """What it hears and says."""
    lines = []
    if manifest.hears:
        lines.append(tr("It hears: {topics}", topics=", ".join(manifest.hears)))
    if manifest.says:
        lines.append(tr("It says: {topics}", topics=", ".join(manifest.says)))
    items = "".join(f"<li>{escape(line)}</li>" for line in lines)
    return f"<h2>{escape(tr('Its topics'))}</h2><ul>{items}</ul>" if items else ""


# All pages of the help, in the language in use: their contents, each page, what is searched.

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
            clip = sample_clip(self.language, definition)
            said = sentence(clip.project, self.language, clip.roots[0][0])
            titles[BLOCK + definition.id] = said
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
            about = category_texts(language_code()).get(rest, "")
            parts = [f"<h1>{escape(self.titles[CATEGORY + rest])}</h1>", f"<p>{escape(about)}</p>"]
            for definition in self._blocks_of(rest):
                page = BLOCK + definition.id
                picture = f'<a href="help:{page}"><img src="{PICTURE}{definition.id}"></a>'
                words = markdown.inline(text_of(definition.id).about)
                parts.append(f"<p>{picture}<br>{words} {link(page, tr('More'))}</p>")
            if rest == "my":
                own = HOW_TO + "own-blocks"
                parts.append(f"<p>{link(own, self.titles[own])}</p>")
            html = "".join(parts)
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
        called = definition.call.name if definition.call else ""
        words = f"{definition.in_words} {told.words} {called}"
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
            icon = category_icon_name(category.colour)
            yield Content(CATEGORY + category.id, category.title, icon, inside)

    def _nodes(self) -> Iterator[Content]:
        for name, manifest in self._manifests.items():
            yield Content(NODE + name, self.titles[NODE + name], manifest.icon)

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

    def _how_to_html(self, name: str) -> str:
        keys = (
            f"<tr><td>{escape(key)}</td><td>{escape(words)}</td></tr>"
            for words, key in self._shortcuts()
        )
        table = _table((tr("Keys"), tr("What it does")), keys)
        source = page_texts(language_code())[name]
        inserts = {"shortcuts": table, "errors": _errors_html()}
        inserts |= {each: _shown(each) for each in examples() if f"{{{{{each}}}}}" in source}
        return markdown.read(source, inserts).html


def _shown(example: str) -> str:
    """The picture of an example in a page, to be dragged out, and a link to do more with it."""
    picture = f'<a href="{DRAG}{example}"><img src="{EXAMPLE}{example}"></a>'
    words = escape(tr("Put it on the page, or try it"))
    return f'<p>{picture}</p><p><a href="{CHOOSE}{example}">{words}</a></p>'


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
