"""The page of a block: picture, what it does, its slots, an example, its Python, what is near."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
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
from nep_studio.help.markdown import code_html, inline
from nep_studio.help.texts import (
    BLOCK,
    CATEGORY,
    HOW_TO,
    BlockText,
    Example,
    block_texts,
    example_of,
    node_texts,
)
from nep_studio.ui.canvas.fields.editors import slot_name
from nep_studio.ui.words import language_code, tr
from nep_studio.ui.workbench.help_card_words import shape_words

MOST_CHOICES = 12
EVERY_BLOCK = "*"
"""The key under which slots are explained that many blocks have."""

SAID_BY_WORDS = frozenset({"body", "boolean", "list", "robot"})
"""Kinds of slot of which nothing more need be said where people have written about the slot."""

PICTURE, EXAMPLE, DRAG = "picture:", "example:", "drag:"
"""What addresses of pictures begin with, and links out of which an example is dragged."""


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
    flags = {
        "takes_time": tr("The program waits here until it is done."),
        "in_loop": tr("It belongs inside a loop."),
        "stands": tr("The robot must stand for it."),
        "stands_up": tr("The robot stands afterwards."),
        "rests": tr("The robot rests afterwards, and cannot move until it wakes up."),
        "needs_real_robot": tr("Needs a real robot: the one on the screen cannot do it."),
    }
    yield from (words for flag, words in flags.items() if flag in definition.flags)
    if any(slot.kind.name == "gesture" for slot in definition.slots.values()):
        yield tr("A node must recognise the gesture: launch one on the page Nodes.")


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
    if not rows:
        return ""
    heads = "".join(f"<th>{escape(words)}</th>" for words in (tr("Name"), tr("What goes in")))
    return (
        f"<h2>{escape(tr('Its places'))}</h2>"
        f'<table class="table" width="100%" cellspacing="0"><tr>{heads}</tr>{"".join(rows)}</table>'
    )


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
    if slot.name not in definition.defaults:
        return ""
    value = definition.defaults[slot.name]
    return "" if value == "" else field_text(Project(), language, block, slot, value)


def example_html(language: Language, example: Example | None, page: str) -> str:
    """An example to be dragged out, and how it reads in Python."""
    if example is None:
        return ""
    picture = f'<a href="{DRAG}{example.name}"><img src="{EXAMPLE}{example.name}"></a>'
    code = python(language, example, page)
    return (
        f'<h2><a name="example"></a>{escape(tr("Example"))}</h2>'
        f"<p>{picture}</p>"
        f'<p class="hint">{escape(tr("Drag it onto the page, or use the buttons below."))}</p>'
        f"<h2>{escape(tr('In Python'))}</h2>"
        f"{code_html(code)}"
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
    links = list(_links(told.see, titles))
    category = CATEGORY + definition.category.id
    words = tr("All blocks of “{category}”", category=definition.category.title)
    links.append(link(category, words))
    items = "".join(f"<li>{each}</li>" for each in links)
    return f"<h2>{escape(tr('See also'))}</h2><ul>{items}</ul>"


def _links(names: Iterable[str], titles: dict[str, str]) -> Iterator[str]:
    for name in names:
        page = BLOCK + name if "." in name else HOW_TO + name
        if page in titles:
            yield link(page, titles[page])


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


def sample_words(language: Language, definition: Definition) -> str:
    """What a new block says."""
    clip = sample_clip(language, definition)
    return sentence(clip.project, language, clip.roots[0][0])


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
    if not manifest.parameters:
        return ""
    heads = (tr("Setting"), tr("What it is"), tr("Usually"))
    head = "".join(f"<th>{escape(words)}</th>" for words in heads)
    rows = "".join(_row(name, each) for name, each in manifest.parameters.items())
    return (
        f"<h2>{escape(tr('Its settings'))}</h2>"
        f'<table class="table" width="100%" cellspacing="0"><tr>{head}</tr>{rows}</table>'
    )


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
