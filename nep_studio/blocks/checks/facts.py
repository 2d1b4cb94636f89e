"""Checks of facts: without a name, needed and never made true, and of what own blocks say."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches

from faults import text_of
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.generate.plans import TASK_LINES
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import DEFINE
from nep_studio.blocks.program import Block, Project

from .diagnostic import Diagnostic, Fix, found

MAKING, NEEDING = ("now_true", "makes_true", "true_while"), ("needs", "fact")
"""The generators of blocks that make a fact true, and of those that want it to be."""

_Fact = tuple[str, int]
"""The name of a fact, and how many values it has: facts that differ there are never the same."""


def check_facts(
    project: Project, language: Language, running: Iterable[list[str]]
) -> Iterator[Diagnostic]:
    """Problems of facts in all chains that become code; Python in blocks may make any true."""
    made, needed = dict[_Fact, str](), list[tuple[_Fact, Block]]()
    is_open = False
    for chain in running:
        for block in project.within(chain, enabled=True):
            definition = language.definitions.get(block.type)
            if definition is None:
                continue
            is_open |= definition.holds_python and _makes_facts(block, definition)
            if "fact" not in definition.slots:
                continue
            fact = str(definition.value(block, "fact")).strip(), block.groups.get("of", 0)
            if not fact[0]:
                yield found("no_fact", project, language, block.id)
            elif definition.generator in MAKING:
                made.setdefault(fact, fact[0])
            elif definition.generator in NEEDING:
                needed.append((fact, block))
        yield from _misplaced(project, language, chain)
    for fact, block in needed if not is_open else ():
        if fact not in made:
            fix = _nearest(block, fact, made)
            yield found("never_true", project, language, block.id, fix, fact=fact[0])


def _misplaced(project: Project, language: Language, chain: list[str]) -> Iterator[Diagnostic]:
    """What an own block would say of itself, but where nobody who plans looks."""
    is_own = project.blocks[chain[0]].type.startswith(DEFINE)
    first = frozenset(chain if is_own else ())
    for block in project.within(chain, enabled=True):
        definition = language.definitions.get(block.type)
        if definition is not None and definition.generator in TASK_LINES and block.id not in first:
            yield found("not_planned", project, language, block.id)


def _makes_facts(block: Block, definition: Definition) -> bool:
    """Whether Python that a person wrote may make facts true."""
    code = str(definition.value(block, "code"))
    return any(word in code for word in MAKING)


def _nearest(block: Block, fact: _Fact, made: Mapping[_Fact, str]) -> Fix | None:
    """What takes the name of a fact of as many values that is nearly the same."""
    names = {name.casefold(): name for name, count in made if count == fact[1]}
    near = get_close_matches(fact[0].casefold(), names, 1)
    if not near:
        return None
    name = names[near[0]]
    label = text_of("Choose “{choice}”", choice=name)
    return Fix("choose", label, {"block": block.id, "slot": "fact", "value": name})
