"""What is said in an example, in the language of the person who opens it.

``resources/examples/texts/<language>.toml`` has a table for each example, with the English texts as
keys: so a text goes with its sentence, however its block is called, and what is named in several
places, such as a goal, keeps one name.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

import msgspec

from nep_studio import paths
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import LANGUAGE, Block, Parameter, Project, split_slot

_NAME_KINDS = ("message", "mode")
"""The kinds of fields with names that stand in several places, each with a default of its own."""
_TEXT_KINDS = ("text", "lines", "line", "goal", "any", *_NAME_KINDS)
"""The kinds of fields in which people write words."""
_OF_PROGRAMS = ("robots.robot", "nodes.launch", "code.lines", "code.value", "code.program")
"""Blocks whose texts are names and code: they are the same in every language."""


@cache
def texts_of_examples(code: str) -> Mapping[str, Mapping[str, str]]:
    """The texts of all examples in a language, by the example's file name and the English text."""
    path = paths.examples() / "texts" / f"{code}.toml"
    return tomllib.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def translate(project: Project, name: str, language: Language, code: str) -> None:
    """Tell an example that was just read in the language ``code``.

    That is what robots say and hear, and the notes, variables, own blocks and gestures of it.
    ``language`` are the blocks in that language, ``name`` is the stem of the example's file. What
    is not translated stays as it is.
    """
    told = texts_of_examples(code).get(name)
    if told is None:
        return
    own = language.of(project)
    for block in project.blocks.values():
        definition = own.definitions[block.type]
        for key, text in _texts_of_block(block, own):
            said = told.get(text, text)
            if _is_default(definition, key, text):
                said = definition.said.get(split_slot(key)[0], text)
            block.fields[key] = said
    for variable in project.variables:
        variable.name = told.get(variable.name, variable.name)
    for note in list(project.notes.values()):
        text = told.get(note.text, note.text)
        project.notes[note.id] = msgspec.structs.replace(note, text=text)
    for procedure in list(project.procedures.values()):
        parts = tuple(_told_part(part, told) for part in procedure.parts)
        project.procedures[procedure.id] = msgspec.structs.replace(procedure, parts=parts)
    for gesture in _own_gestures(project):
        gesture["title"] = told.get(gesture["title"], gesture["title"])
    project.procedure_revision += 1
    project.extra_revision += 1
    project.extra[LANGUAGE] = code


def texts_in(project: Project, language: Language) -> Iterator[str]:
    """All that ``translate`` can tell otherwise in a project, in any order."""
    own = language.of(project)
    for block in project.blocks.values():
        for key, text in _texts_of_block(block, own):
            if not _is_default(own.definitions[block.type], key, text):
                yield text
    yield from (variable.name for variable in project.variables)
    yield from (note.text for note in project.notes.values())
    for procedure in project.procedures.values():
        yield from (p.name if isinstance(p, Parameter) else p for p in procedure.parts)
    yield from (gesture["title"] for gesture in _own_gestures(project))


def _is_default(definition: Definition, key: str, text: str) -> bool:
    """Whether a text is what a new block says, which the language of the blocks can tell."""
    slot = split_slot(key)[0]
    is_name = definition.slots[slot].kind.name in _NAME_KINDS
    return not is_name and text == definition.defaults.get(slot)


def _texts_of_block(block: Block, language: Language) -> Iterator[tuple[str, str]]:
    if block.type in _OF_PROGRAMS:
        return
    slots = language.definitions[block.type].slots
    for key, value in block.fields.items():
        kind = slots[split_slot(key)[0]].kind.name
        if isinstance(value, str) and kind in _TEXT_KINDS:
            yield key, value


def _told_part(part: str | Parameter, told: Mapping[str, str]) -> str | Parameter:
    if isinstance(part, Parameter):
        return msgspec.structs.replace(part, name=told.get(part.name, part.name))
    return told.get(part, part)


def _own_gestures(project: Project) -> Iterator[dict[str, Any]]:
    for key, kept in project.extra.items():
        if key.startswith("gesture_") and isinstance(kept, dict) and kept.get("title"):
            yield kept
