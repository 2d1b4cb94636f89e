"""Which variables several parts of a program change at once, and which lists change in place.

Parts that run at once are rules, goals and what begins with the program, and in each of them the
parts of “do together” and of “do side by side”, and “do for each of … at once” with itself. An own
block runs wherever it is called.
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from .code_text import CodeTextRefused, read_lines
from .definitions import Definition
from .language import Language
from .procedures import CALL, DEFINE, procedure_of
from .program import Block, Project

TOGETHER, PARALLEL = "control.together", "tree.parallel"
EACH_ROBOT = "control.each_robot"
CODE_LINES, VARIABLE = "code.lines", "variable.get"
CHANGING_LISTS = frozenset({"list.add", "list.set", "list.insert", "list.remove", "list.take"})
CHANGING_TABLES = frozenset({"table.set", "table.take", "table.change"})
RESIZING_LISTS = CHANGING_LISTS - {"list.set"}
LIST_SLOT, TABLE_SLOT = "list", "table"

Path = tuple[tuple[str, str], ...]
"""The parts that run at once around a block, from the outermost to the innermost.

Of “do together” the block and the slot, of “do side by side” the block and the one in its mouth,
of “do for each of … at once” the block and ``WITH_ITSELF``.
"""
WITH_ITSELF = "*"
"""The part of what runs several times at once."""
Places = Mapping[str, frozenset[Path]]


@dataclass(frozen=True, slots=True)
class Chain:
    """What the blocks of one chain do to variables and lists, and which own blocks they call.

    ``sets`` and ``calls`` have the paths of the blocks, by variable and by own block; ``python``
    those of code blocks, by the names that they set. ``lists`` are the variables whose lists or
    tables are changed, ``any_list`` says that one without a name is, or by written code.
    """

    sets: Places = field(default_factory=dict)
    python: Places = field(default_factory=dict)
    calls: Places = field(default_factory=dict)
    lists: frozenset[str] = frozenset()
    any_list: bool = False
    takes_time: bool = False
    defines: str = ""


@dataclass(frozen=True, slots=True)
class Sharing:
    """What is known of all chains: ``shared`` variables are set by parts that run at once.

    ``lists`` are the variables whose lists or tables change while others may go through them (None:
    any),
    ``slow`` the own blocks that take time.
    """

    shared: frozenset[str] = frozenset()
    lists: frozenset[str] | None = frozenset()
    slow: frozenset[str] = frozenset()

    def changes(self, variable: str) -> bool:
        """Whether a list in this variable, "" for one that only an own block knows, may change."""
        return self.lists is None or variable in self.lists or (not variable and bool(self.lists))


BETWEEN_RESTS = 50
"""Blocks that are looked at without a rest."""


def look_at(project: Project, language: Language, chain: list[str]) -> Iterator[Chain | None]:
    """What a chain does; None wherever it may rest."""
    first = project.blocks[chain[0]]
    sets, python, calls = (defaultdict[str, set[Path]](set) for _ in range(3))
    lists, any_list, takes_time = set[str](), False, False
    waiting: list[tuple[str, Path]] = [(block_id, ()) for block_id in chain]
    blocks, definitions = project.blocks, language.definitions
    for number in itertools.count():
        if not waiting:
            break
        if number % BETWEEN_RESTS == 0:
            yield None
        block_id, path = waiting.pop()
        block = blocks[block_id]
        definition = definitions.get(block.type)
        if block.disabled or definition is None:
            continue
        takes_time = takes_time or waits(definition, block)
        if "variable" in block.fields or block.type in CHANGING_LISTS | CHANGING_TABLES:
            for variable in variables_set(project, language, block):
                sets[variable].add(path)
        if block.type in CHANGING_LISTS | CHANGING_TABLES:
            held = changed_in(project, block)
            if held is not None and held.type == VARIABLE:
                lists.add(str(held.fields.get("variable", "")))
            any_list |= held is not None and held.type != VARIABLE
        if block.type.startswith(CALL):
            calls[procedure_of(block.type)].add(path)
        if block.type == CODE_LINES:
            any_list = True
            for name in _names_set(str(definition.value(block, "code"))):
                python[name].add(path)
        if block.inputs:
            waiting += [(child, path) for child in block.inputs.values()]
        for slot, body in block.bodies.items():
            if block.type == PARALLEL:
                waiting += [(child, (*path, (block.id, child))) for child in body]
                continue
            inside = path
            if block.type in (TOGETHER, EACH_ROBOT):
                inside = (*path, (block.id, slot if block.type == TOGETHER else WITH_ITSELF))
            waiting += [(child, inside) for child in body]
    defines = procedure_of(first.type) if first.type.startswith(DEFINE) else ""
    yield Chain(
        _frozen(sets),
        _frozen(python),
        _frozen(calls),
        frozenset(lists),
        any_list,
        takes_time,
        defines,
    )


def variables_set(project: Project, language: Language, block: Block) -> Iterator[str]:
    """The variables into which a block puts something, or into whose lists or tables."""
    definition = language.definitions[block.type]
    if block.type in CHANGING_LISTS | CHANGING_TABLES:
        held = changed_in(project, block)
        if held is not None and held.type == VARIABLE:
            yield str(held.fields.get("variable", ""))
    elif not definition.is_value and "variable" in definition.slots:
        yield str(block.fields.get("variable", ""))


def changed_in(project: Project, block: Block) -> Block | None:
    """The block that gives the list or table that a block changes, or None."""
    if block.type in CHANGING_LISTS:
        return _held(project, block)
    return _held(project, block, TABLE_SLOT) if block.type in CHANGING_TABLES else None


def _held(project: Project, block: Block, slot: str = LIST_SLOT) -> Block | None:
    """The block in the place of the list, or of the table, that a block changes, or None."""
    held = project.blocks.get(block.inputs.get(slot, ""))
    return None if held is None or held.disabled else held


def is_slow(language: Language, sharing: Sharing, block: Block) -> bool:
    """Whether a block waits for something, such as an answer."""
    definition = language.definitions.get(block.type)
    is_own = block.type.startswith(CALL) and procedure_of(block.type) in sharing.slow
    return is_own or (definition is not None and waits(definition, block))


def waits(definition: Definition, block: Block) -> bool:
    """Whether the program waits at a block; who tells a message does so only where it says so."""
    is_short = WAIT_GROUP in definition.groups and not block.groups.get(WAIT_GROUP)
    return "takes_time" in definition.flags and not is_short


WAIT_GROUP = "wait"


def sharing_of(chains: Iterable[Chain], names: Mapping[str, str]) -> Sharing:
    """What follows from all chains; ``names`` are the Python names of variables by id."""
    every = list(chains)
    own = {chain.defines: chain for chain in every if chain.defines}
    ids = {name: variable for variable, name in names.items()}
    seen, shared = set[str](), set[str]()
    for chain in every:
        if chain.defines:
            continue
        places = _with_own_blocks(chain, own, ids)
        shared |= {v for v, paths in places.items() if v in seen or _run_at_once(paths)}
        seen |= places.keys()
    is_any = any(chain.any_list for chain in every)
    lists = frozenset(variable for chain in every for variable in chain.lists)
    return Sharing(frozenset(shared), None if is_any else lists, _slow(own))


def _with_own_blocks(
    rule: Chain, own: Mapping[str, Chain], ids: Mapping[str, str]
) -> dict[str, set[Path]]:
    """Where a rule sets variables, by itself and in the own blocks that it calls."""
    places = defaultdict[str, set[Path]](set)
    waiting: list[tuple[Chain, Path]] = [(rule, ())]
    entered = set[tuple[str, Path]]()
    while waiting:
        chain, around = waiting.pop()
        named = {ids[name]: paths for name, paths in chain.python.items() if name in ids}
        for found in (chain.sets, named):
            for variable, paths in found.items():
                places[variable] |= {(*around, *path) for path in paths}
        for procedure, paths in chain.calls.items():
            for path in paths:
                call = procedure, (*around, *path)
                if procedure in own and call not in entered and len(call[1]) < MOST_NESTED:
                    entered.add(call)
                    waiting.append((own[procedure], call[1]))
    return places


MOST_NESTED = 20
"""An own block that calls itself inside “do together” is not followed any deeper."""


def _run_at_once(paths: set[Path]) -> bool:
    """Whether two of these places, or one of them with itself, are done at the same time."""
    parts: dict[tuple[Path, str], str] = {}
    for path in paths:
        for depth, step in enumerate(path):
            together, part = step
            if part == WITH_ITSELF:
                return True
            if parts.setdefault((path[:depth], together), part) != part:
                return True
    return False


def _slow(own: Mapping[str, Chain]) -> frozenset[str]:
    """The own blocks that take time, by themselves or by others."""
    slow = {procedure for procedure, chain in own.items() if chain.takes_time}
    while more := {p for p, chain in own.items() if p not in slow and slow & chain.calls.keys()}:
        slow |= more
    return frozenset(slow)


def _names_set(code: str) -> frozenset[str]:
    try:
        return read_lines(code).set_here
    except CodeTextRefused:
        return frozenset()


def _frozen(found: Mapping[str, set[Path]]) -> Places:
    return {key: frozenset(paths) for key, paths in found.items()}
