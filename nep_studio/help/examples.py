"""The example programs of the help: small, shared by all languages, whole when they are tried."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

from nep_studio import paths
from nep_studio.blocks.deployment import (
    NODE_BLOCK,
    ROBOT_BLOCK,
    gestures_used,
    node_entries,
    robot_entries,
    robots_used,
)
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import DeleteBlocks, SetField
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import Clip
from nep_studio.blocks.program import ALL_ROBOTS, Project
from nep_studio.blocks.values import FieldValue

from . import notation
from .sketching import project_of
from .texts import translated_texts

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
    used = robots_used(project, language)
    for name in dict.fromkeys(language.profile.title if n == ALL_ROBOTS else n for n in used):
        if name not in here:
            _add(editor, "robots", ROBOT_BLOCK, {"name": name, "driver": "virtual"})
    gestures = list(gestures_used(project, language))
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
