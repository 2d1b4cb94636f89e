"""The hand-written texts and examples of the help, and the names of its pages."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from nep_studio import paths
from nep_studio.blocks.deployment import (
    NODE_BLOCK,
    names_used,
    node_entries,
    robot_entries,
)
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import Clip
from nep_studio.blocks.procedures import CALL, DEFINE, PARAMETER
from nep_studio.blocks.program import ALL_ROBOTS, ROBOT_BLOCK, Project
from nep_studio.blocks.slots import FieldValue

from . import notation
from .notation import project_of

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
    return {block: _block_text({**told, **own.get(block, {})}) for block, told in english.items()}


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


def _block_text(told: Mapping[str, Any]) -> BlockText:
    return BlockText(
        told.get("about", ""),
        told.get("tip", ""),
        told.get("words", ""),
        tuple(told.get("see", ())),
        told.get("slots", {}),
    )


def _merged(stem: str, code: str) -> Mapping[str, str]:
    english: dict[str, Any] = dict(_tables(stem))
    return english if code == ENGLISH else {**english, **_tables(stem, code)}


def _tables(stem: str, code: str = ENGLISH) -> dict[str, Any]:
    """Everything in the files ``<stem>.toml`` and ``<stem>_*.toml`` of a language."""
    tables: dict[str, Any] = {}
    for path in _files(stem, code):
        tables |= _read(path)
    return tables


def _files(stem: str, code: str) -> Iterator[Path]:
    folder = help_folder() / code
    yield from sorted(folder.glob(f"{stem}.toml"))
    yield from sorted(folder.glob(f"{stem}_*.toml"))


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
        written = notation.read(self.program)
        return project_of(written, language, title, lambda text: texts.get(text, text))


@cache
def examples() -> Mapping[str, Example]:
    """All examples by their names."""
    text = (paths.resources() / "help" / "examples.toml").read_text(encoding="utf-8")
    return {
        name: Example(name, tuple(told["blocks"]), told["program"])
        for name, told in tomllib.loads(text).items()
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
    if not gestures or node_entries(project, language):
        return
    made = ", ".join(f"{FIRST_GESTURE_S * (n + 1)} {each}" for n, each in enumerate(gestures))
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
