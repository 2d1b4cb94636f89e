"""Find blocks by words: in their sentences, fields, comments and names."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator

from ..language import Language
from ..program import Block, Project
from ..sentence import Group
from ..text import field_text


def find(project: Project, language: Language, text: str) -> tuple[str, ...]:
    """The blocks that have all words of ``text`` in them, in page order.

    Case and accents do not count; a word may be a part of one. Blocks inside a block count for
    themselves only.
    """
    words = folded(text).split()
    if not words:
        return ()
    return tuple(
        block.id
        for stacks in project.pages.values()
        for stack in stacks
        for block in project.within(stack.body)
        if _has(project, language, block, words)
    )


def folded(text: str) -> str:
    """Text without case and accents, to compare it by."""
    letters = unicodedata.normalize("NFKD", text)
    return "".join(c for c in letters if not unicodedata.combining(c)).casefold()


def _has(project: Project, language: Language, block: Block, words: list[str]) -> bool:
    text = folded(" ".join([*_said(project, language, block), block.comment]))
    return all(word in text for word in words)


def _said(project: Project, language: Language, block: Block) -> Iterator[str]:
    """The words and fields of a block itself."""
    definition = language.definitions.get(block.type)
    if definition is None:
        yield block.type
        return
    for part in definition.parts:
        inner = part.parts if isinstance(part, Group) else (part,)
        is_there = not isinstance(part, Group) or block.groups.get(part.name, 0) > 0
        if is_there:
            yield from (words for words in inner if isinstance(words, str))
    for key, slot in definition.keys(block.groups):
        if key not in block.inputs and slot.kind.name != "body":
            yield field_text(project, language, block, slot, definition.value(block, key))
