"""Checks of behaviour trees: two of one name, and names of trees that are not there."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from itertools import count

from faults import text_of

from ..language import Language
from ..program import Block, Project
from .diagnostic import Diagnostic, Fix, Found, found

TREE = "tree.tree"
OF_TREE = frozenset({"tree.sub_tree", "tree.do", "tree.succeeds"})


def check_trees(project: Project, language: Language, running: Iterable[list[str]]) -> Found:
    """Problems of the names of trees; ``running`` are the chains that become code."""
    trees, named = dict[str, str](), list[Block]()
    for chain in running:
        hat = project.blocks[chain[0]]
        if hat.type == TREE:
            name = _name(language, hat)
            if trees.setdefault(name, hat.id) != hat.id:
                named.append(hat)
        for block in project.within(chain, enabled=True):
            yield None
            if block.type in OF_TREE:
                named.append(block)
    for block in named:
        yield from _wrong_name(project, language, block, trees)


def _wrong_name(
    project: Project, language: Language, block: Block, trees: dict[str, str]
) -> Iterator[Diagnostic]:
    name = _name(language, block)
    if block.type == TREE:
        free = next(n for number in count(2) if (n := f"{name} {number}") not in trees)
        yield found("same_tree", project, language, block.id, _choose(block, free), name=name)
    elif name not in trees:
        folded = {tree.casefold().strip(): tree for tree in trees}
        near = get_close_matches(name.casefold().strip(), folded, 1)
        chosen = folded[near[0]] if near else next(iter(trees)) if len(trees) == 1 else ""
        fix = _choose(block, chosen) if chosen else None
        yield found("unknown_tree", project, language, block.id, fix, name=name)


def _name(language: Language, block: Block) -> str:
    return str(language.definitions[block.type].value(block, "name"))


def _choose(block: Block, name: str) -> Fix:
    label = text_of("Choose “{choice}”", choice=name)
    return Fix("choose", label, {"block": block.id, "slot": "name", "value": name})
