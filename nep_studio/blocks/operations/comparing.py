"""What is different between two versions of a project, in words, block by block."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Literal

from ..language import Language
from ..program import Block, Parent, Project
from ..text import sentence

What = Literal["added", "removed", "changed", "moved"]


@dataclass(frozen=True, slots=True)
class Difference:
    """One block that differs: ``sentence`` is what it says now, ``before`` what it said."""

    what: What
    block: str
    sentence: str
    before: str = ""

    def __str__(self) -> str:
        if self.what == "changed" and self.before != self.sentence:
            return f"changed: “{self.before}” is now “{self.sentence}”"
        return f"{self.what}: “{self.sentence}”"


def compare(old: Project, new: Project, language: Language) -> tuple[Difference, ...]:
    """The blocks that differ, as ids say which are the same; a block that moved with the one
    around it has not moved itself.
    """
    return (*_in_new(old, new, language), *_removed(old, new, language))


def _in_new(old: Project, new: Project, language: Language) -> Iterator[Difference]:
    moved = _moved(old, new)
    for block in _all_blocks(new):
        said = sentence(new, language, block.id)
        before = old.blocks.get(block.id)
        if before is None:
            yield Difference("added", block.id, said)
            continue
        if block.id in moved:
            yield Difference("moved", block.id, said)
        if _content(before) != _content(block):
            yield Difference("changed", block.id, said, sentence(old, language, block.id))


def _removed(old: Project, new: Project, language: Language) -> Iterator[Difference]:
    for block in _all_blocks(old):
        if block.id not in new.blocks:
            yield Difference("removed", block.id, sentence(old, language, block.id))


def _all_blocks(project: Project) -> Iterator[Block]:
    for stacks in project.pages.values():
        for stack in stacks:
            yield from project.within(stack.body)


def _content(block: Block) -> tuple[object, ...]:
    flags = block.disabled, block.collapsed, block.comment
    return block.type, block.fields, block.groups, flags, block.extra


def _moved(old: Project, new: Project) -> set[str]:
    """Blocks that are in another place, or in another order among those that stayed there."""
    both = old.blocks.keys() & new.blocks.keys()
    moved = {block for block in both if _owner(old, block) != _owner(new, block)}
    for parent in {new.parents[block] for block in both - moved}:
        before = [b for b in old.chain_of(parent) or () if b in both - moved]
        after = [b for b in new.chain_of(parent) or () if b in both - moved]
        moved |= _out_of_order(before, after)
    return moved


def _owner(project: Project, block: str) -> Parent:
    return project.parents[block]


def _out_of_order(before: Sequence[str], after: Sequence[str]) -> set[str]:
    """The fewest blocks, about, that must have moved to come from one order to the other."""
    if before == after:
        return set()
    matcher = SequenceMatcher(None, before, after, autojunk=False)
    stayed = {b for match in matcher.get_matching_blocks() for b in before[match.a :][: match.size]}
    return set(after) - stayed
