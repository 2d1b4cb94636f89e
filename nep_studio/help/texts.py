"""The hand-written texts and examples of the help, and the names of its pages."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import msgspec

from nep_studio import paths
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.deployment import NODE_BLOCK, names_used, node_entries, robot_entries
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddGroup, AddProcedure, SetField
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import Clip
from nep_studio.blocks.places import InBody, InInput, InStack, Place
from nep_studio.blocks.procedures import CALL, DEFINE, PARAMETER
from nep_studio.blocks.program import (
    ALL_ROBOTS,
    ROBOT_BLOCK,
    SCOPE_KEPT,
    Parameter,
    Procedure,
    Project,
    split_slot,
)
from nep_studio.blocks.slots import FieldValue

# Small programs written down line by line, as the examples of the help are.
#
#     event.started
#     robot.say text="Hello"
#     control.if condition=(sensing.human_state_is state=touched_head)
#       robot.say text="That tickles"
#      otherwise_do.1:
#       robot.play animation=nod
#
# A line is a block with the values of its slots; what is indented more is inside it, in its first
# mouth or in the one that a line ``mouth:`` names. A value in brackets is a block. ``wait=true``
# adds the words of a group that has no places. Quoted texts are for people and can be translated,
# bare words cannot. ``own p1 value "double" a1:x:number`` defines an own block, which the lines
# below use as ``my.define.p1``, ``my.call.p1``, ``my.parameter.p1.a1``. ``kept "best"`` keeps a
# variable for the next run. A rule is named by the number of its stack, which stands above: rule=1.

_TOKEN = re.compile(r'\s*("(?:[^"\\]|\\.)*"|[()=]|[^\s()="]+)')
_NUMBER = re.compile(r"-?\d+(\.\d+)?")


class NotationError(ValueError):
    """A line of an example that cannot be read; its text says which."""


class Quoted(str):
    """A text for people."""


@dataclass
class Sketch:
    """A block as it was written down: its type, its values by slot, what is in its mouths."""

    type: str
    values: dict[str, str | int | float | bool | Sketch] = field(default_factory=dict)
    bodies: dict[str, list[Sketch]] = field(default_factory=dict)

    def types(self) -> Iterator[str]:
        """The type of this block and of all that are in it."""
        yield self.type
        for value in self.values.values():
            if isinstance(value, Sketch):
                yield from value.types()
        for body in self.bodies.values():
            for inner in body:
                yield from inner.types()


@dataclass
class Written:
    """A program as it was written down: its own blocks, and its stacks in their order.

    ``kept`` are the variables that are kept for its next run.
    """

    procedures: list[Procedure] = field(default_factory=list)
    kept: list[str] = field(default_factory=list)
    stacks: list[list[Sketch]] = field(default_factory=list)


FIRST_MOUTH = ""
"""Stands for the first mouth of a block, whatever it is called."""


def read(text: str) -> Written:
    """Read a program; stacks have an empty line between them. Raises NotationError."""
    written = Written()
    chain: list[Sketch] = []
    open_: list[tuple[int, list[Sketch]]] = []
    for line in text.splitlines():
        depth, said = len(line) - len(line.lstrip()), line.strip()
        if not said:
            chain, open_ = [], []
        elif said.startswith("own "):
            written.procedures.append(_procedure(_tokens(said)))
        elif said.startswith("kept "):
            written.kept.append(json.loads(said.removeprefix("kept ")))
        else:
            if not open_:
                open_ = [(depth, chain)]
                written.stacks.append(chain)
            _take(said, depth, open_)
    return written


def _take(said: str, depth: int, open_: list[tuple[int, list[Sketch]]]) -> None:
    """Put a line where its indentation says."""
    while len(open_) > 1 and depth < open_[-1][0]:
        open_.pop()
    place, chain = open_[-1]
    if said.endswith(":"):
        open_.append((depth + 1, chain[-1].bodies.setdefault(said[:-1], [])))
        return
    if depth > place and chain and FIRST_MOUTH not in chain[-1].bodies:
        inside = chain[-1].bodies.setdefault(FIRST_MOUTH, [])
        open_.append((depth, inside))
        chain = inside
    elif depth > place and chain:
        raise NotationError(f"“{said}” is indented, but in no mouth")
    tokens = _tokens(said)
    made = _block(tokens)
    if tokens:
        raise NotationError(f"“{said}”: what is {tokens[0]}?")
    chain.append(made)


def _block(tokens: list[str]) -> Sketch:
    made = Sketch(tokens.pop(0))
    while tokens and tokens[0] != ")":
        name = tokens.pop(0)
        if len(tokens) < 2 or tokens.pop(0) != "=":
            raise NotationError(f"{made.type}: {name} has no value")
        made.values[name] = _value(tokens)
    return made


def _value(tokens: list[str]) -> str | int | float | bool | Sketch:
    token = tokens.pop(0)
    if token == "(":
        inner = _block(tokens)
        if not tokens or tokens.pop(0) != ")":
            raise NotationError(f"{inner.type} is not closed by )")
        return inner
    if token.startswith('"'):
        return Quoted(json.loads(token))
    if token in ("true", "false"):
        return token == "true"
    if _NUMBER.fullmatch(token):
        return float(token) if "." in token else int(token)
    return token


def _procedure(tokens: list[str]) -> Procedure:
    """``own p1 value "double" a1:x:number``: id, whether it gives a value, words, parameters."""
    _own, name, *rest = tokens
    gives_value = rest[:1] == ["value"]
    parts: list[str | Parameter] = []
    for token in rest[gives_value:]:
        if token.startswith('"'):
            parts.append(json.loads(token))
        else:
            parts.append(Parameter(*token.split(":")))
    return Procedure(name, tuple(parts), gives_value)


def _tokens(said: str) -> list[str]:
    found = _TOKEN.findall(said)
    if "".join(found).replace(" ", "") != re.sub(r"\s", "", said):
        raise NotationError(f"“{said}” cannot be read")
    return found


# Make blocks of a program that was written down, in any language of the person.

STEP = 220.0
"""How far below each other stacks begin; whoever lays them out pushes them apart."""

Translate = Callable[[str], str]


def project_of(written: Written, language: Language, title: str, translate: Translate) -> Project:
    """The program as a project; raises NotationError, and EditRefused where blocks do not fit."""
    editor = Editor(Project(title), language)
    for number, procedure in enumerate(written.procedures):
        editor.apply(AddProcedure(_said(procedure, translate), number))
    for variable in written.kept:
        editor.add_variable(translate(variable), SCOPE_KEPT)
    for number, chain in enumerate(written.stacks):
        page = _definition(editor, chain[0].type).page
        place = editor.new_stack(page, 40.0, 40.0 + STEP * number)
        _make(editor, chain[0], place, translate)
        for index, sketch in enumerate(chain[1:], start=1):
            _make(editor, sketch, InStack(place.stack, index), translate)
    return editor.project


def _said(procedure: Procedure, translate: Translate) -> Procedure:
    """An own block in the language of the person."""
    parts = (
        translate(part)
        if isinstance(part, str)
        else Parameter(part.id, translate(part.name), part.kind)
        for part in procedure.parts
    )
    return Procedure(procedure.id, tuple(parts), procedure.gives_value)


def _definition(editor: Editor, block_type: str) -> Definition:
    definition = editor.language.definitions.get(block_type)
    if definition is None:
        raise NotationError(f"there is no block {block_type}")
    return definition


def _make(editor: Editor, sketch: Sketch, place: Place, translate: Translate) -> str:
    """Make a block with all that is in it; gives its id."""
    definition = _definition(editor, sketch.type)
    block = editor.create(sketch.type, place)
    bodies = {key or _first_mouth(definition): body for key, body in sketch.bodies.items()}
    _add_groups(editor, definition, block, [*sketch.values, *bodies])
    for key, value in _gathered(sketch.values).items():
        if key in definition.groups:  # words without a place, as “and wait”
            continue
        if isinstance(value, Sketch):
            _make(editor, value, InInput(block, key), translate)
        else:
            editor.apply(SetField(block, key, _field(editor, definition, key, value, translate)))
    for key, body in bodies.items():
        for index, inner in enumerate(body):
            _make(editor, inner, InBody(block, key, index), translate)
    return block


def _first_mouth(definition: Definition) -> str:
    for slot in definition.slots.values():
        if slot.kind.name == "body":
            return f"{slot.name}.1" if slot.group else slot.name
    raise NotationError(f"{definition.id} has no mouth")


def _add_groups(editor: Editor, definition: Definition, block: str, keys: Iterable[str]) -> None:
    """Make the groups that the keys are in, as ``item.3`` needs three of its group."""
    for key in keys:
        name, number = split_slot(key)
        slot = definition.slots.get(name)
        group = slot.group if slot is not None else ""
        if key in definition.groups:
            group, number = key, 1
        while group and editor.project.blocks[block].groups.get(group, 0) < number:
            index = editor.project.blocks[block].groups.get(group, 0) + 1
            slots = definition.group_slots(group)
            editor.apply(AddGroup(block, group, index, slots, {}))


def _gathered(
    values: dict[str, str | int | float | bool | Sketch],
) -> dict[str, FieldValue | Sketch]:
    """Settings, written ``parameters.gesture=karate``, become one value."""
    gathered: dict[str, FieldValue | Sketch] = {}
    for key, value in values.items():
        name, dot, inner = key.partition(".")
        if dot and not inner.isdigit() and not isinstance(value, Sketch):
            settings = gathered.setdefault(name, {})
            assert isinstance(settings, dict)
            settings[inner] = str(value) if isinstance(value, Quoted) else value
        else:
            gathered[key] = value
    return gathered


def _field(
    editor: Editor, definition: Definition, key: str, value: FieldValue, translate: Translate
) -> FieldValue:
    slot = definition.slots.get(split_slot(key)[0])
    kind = slot.kind.name if slot is not None else ""
    if isinstance(value, bool) and kind == "choice":
        return str(value).lower()
    if kind == "rule" and type(value) is int:
        return editor.project.pages["behaviour"][value - 1].body[0]
    if not isinstance(value, str):
        return value
    said = translate(str(value)) if isinstance(value, Quoted) else value
    if kind != "variable":
        return said
    known = {variable.name: variable.id for variable in editor.project.variables}
    return known.get(said) or editor.add_variable(said)


# The hand-written texts and examples of the help, and the names of its pages.

HOME = "home"
BLOCK, CATEGORY, NODE, HOW_TO = "block/", "blocks/", "node/", "howto/"
OWN_BLOCKS, PROBLEMS = "howto/own-blocks", "howto/problems"


def split(name: str) -> tuple[str, str]:
    """Take the name of a page and of a place in it apart."""
    page, _, anchor = name.partition("#")
    return page, anchor


def block_page(block_type: str, slot: str = "") -> str:
    """The page of a block, at one of its slots; own blocks share one page."""
    if block_type.startswith((CALL, DEFINE, PARAMETER)):
        return OWN_BLOCKS
    return f"{BLOCK}{block_type}#slot-{slot}" if slot else f"{BLOCK}{block_type}"


def error_anchor(title: str) -> str:
    """The place of a message in the page about messages, by its English title."""
    return "error-" + "".join(letter if letter.isalnum() else "-" for letter in title.lower())


# The hand-written texts of the help, in the person's language or else in English.

ENGLISH = "en"


@dataclass(frozen=True)
class BlockText:
    """What people wrote about a block.

    ``words`` are other words by which it is searched for, ``see`` the ids of other pages,
    ``slots`` what is to be said about a slot.
    """

    about: str = ""
    tip: str = ""
    words: str = ""
    see: tuple[str, ...] = ()
    slots: Mapping[str, str] = field(default_factory=dict)


def help_folder() -> Path:
    """Where the texts, pages and examples of the help are."""
    return paths.resources() / "help"


def first_file(name: str, code: str) -> Path | None:
    """A file of the help in a language, else in English."""
    places = (help_folder() / each / name for each in (code, ENGLISH))
    return next((path for path in places if path.is_file()), None)


@cache
def block_texts(code: str) -> Mapping[str, BlockText]:
    """What is written about each block, by its id; a text that is not translated is English."""
    english = _tables("blocks", ENGLISH)
    own = {} if code == ENGLISH else _tables("blocks", code)
    texts = {block: {**told, **own.get(block, {})} for block, told in english.items()}
    return msgspec.convert(texts, dict[str, BlockText])


@cache
def node_texts(code: str) -> Mapping[str, str]:
    """What is written about each node, by its id."""
    return _merged("nodes", code)


@cache
def category_texts(code: str) -> Mapping[str, str]:
    """What is written about each category of blocks, by its id."""
    return _merged("categories", code)


@cache
def error_texts(code: str) -> Mapping[str, Mapping[str, Any]]:
    """What is written about each error, by its English title: about, and what to try."""
    own = {} if code == ENGLISH else _tables("errors", code)
    return {title: {**told, **own.get(title, {})} for title, told in _tables("errors").items()}


@cache
def translated_texts(code: str) -> Mapping[str, str]:
    """The texts in examples, by the English ones."""
    path = help_folder() / code / "examples.toml"
    return {} if code == ENGLISH or not path.is_file() else _read(path)


@cache
def page_texts(code: str) -> Mapping[str, str]:
    """The How-to pages as Markdown, by name, each in the language or else in English."""
    names = sorted(path.stem for path in (help_folder() / ENGLISH).glob("*.md"))
    found = ((name, first_file(f"{name}.md", code)) for name in names)
    return {name: path.read_text(encoding="utf-8") for name, path in found if path is not None}


def _merged(stem: str, code: str) -> Mapping[str, str]:
    english: dict[str, Any] = dict(_tables(stem))
    return english if code == ENGLISH else {**english, **_tables(stem, code)}


def _tables(stem: str, code: str = ENGLISH) -> dict[str, Any]:
    """Everything in the files ``<stem>.toml`` and ``<stem>_*.toml`` of a language."""
    tables: dict[str, Any] = {}
    folder = help_folder() / code
    for path in [*folder.glob(f"{stem}.toml"), *sorted(folder.glob(f"{stem}_*.toml"))]:
        tables |= _read(path)
    return tables


def _read(path: Path) -> dict[str, Any]:
    return tomllib.loads(path.read_text(encoding="utf-8"))


# The example programs of the help: small, shared by all languages, whole when they are tried.

WATCH = "sensory/virtual_watch"
FIRST_GESTURE_S = 4


@dataclass(frozen=True)
class Example:
    """A small program that shows what some blocks are for."""

    name: str
    blocks: tuple[str, ...]
    program: str

    def clip(self, language: Language, code: str, page: str = "") -> Clip:
        """Its blocks, to be put into a program, with their texts in the language ``code``.

        Those of one page only if one is named: blocks are put on one page at a time.
        """
        project = self._project(language, code)
        for stack in [each for stacks in project.pages.values() for each in stacks if page]:
            if project.page_of(stack.id) != page:
                DeleteBlocks(stack.body[0], len(stack.body)).apply(project)
        return Clip(project)

    def project(self, language: Language, code: str, title: str) -> Project:
        """A project that can run: the robots and nodes that its blocks need are added."""
        project = self._project(language, code, title)
        _complete(Editor(project, language))
        return project

    def _project(self, language: Language, code: str, title: str = "Blocks") -> Project:
        texts = translated_texts(code)
        return project_of(read(self.program), language, title, lambda text: texts.get(text, text))


@cache
def examples() -> Mapping[str, Example]:
    """All examples by their names."""
    return {
        name: Example(name, tuple(told["blocks"]), told["program"])
        for name, told in _read(help_folder() / "examples.toml").items()
    }


@cache
def _by_block() -> Mapping[str, Example]:
    return {block: example for example in examples().values() for block in example.blocks}


def example_of(block_type: str) -> Example | None:
    """The example that shows a block."""
    return _by_block().get(block_type)


def _complete(editor: Editor) -> None:
    """Add the robots that blocks name, and a watch with a node for each gesture."""
    project, language = editor.project, editor.language
    here = {entry.name for entry in robot_entries(project, language)}
    used = names_used(project, language, "robot")
    for name in dict.fromkeys(language.profile.title if n == ALL_ROBOTS else n for n in used):
        if name not in here:
            _add(editor, "robots", ROBOT_BLOCK, {"name": name, "driver": "virtual"})
    gestures = list(names_used(project, language, "gesture"))
    movements = [*gestures, *names_used(project, language, "arm")]
    if not movements or node_entries(project, language):
        return
    made = ", ".join(f"{FIRST_GESTURE_S * (n + 1)} {each}" for n, each in enumerate(movements))
    watch: FieldValue = {"gestures": made, "person": 107}
    _add(editor, "nodes", NODE_BLOCK, {"node": WATCH, "name": "watch", "parameters": watch})
    for gesture in gestures:
        settings: FieldValue = {"gesture": gesture}
        fields = {"node": "perceptual/gesture", "name": gesture, "parameters": settings}
        _add(editor, "nodes", NODE_BLOCK, fields)


def _add(editor: Editor, page: str, block_type: str, fields: Mapping[str, FieldValue]) -> None:
    height = 40.0 + 90.0 * len(editor.project.pages[page])
    block = editor.create(block_type, editor.new_stack(page, 40.0, height))
    for key, value in fields.items():
        editor.apply(SetField(block, key, value))
