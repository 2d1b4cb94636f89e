"""Learn how the Python of each block looks, by making it with markers in its slots.

So every block that the generators know can be read back, also those that are added later.
"""

from __future__ import annotations

import ast
import itertools
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field

from ..definitions import Definition
from ..errors import CodeRefused
from ..language import Language
from ..procedures import procedure_of
from ..program import ALL_ROBOTS, split_slot
from ..values import FieldValue
from .learner import Learner
from .markers import MARKS, position_of

MOST_PATTERNS, MOST_LANGUAGES, MOST_MIXED = 600, 4, 3
_NUMBERS = frozenset({"number", "angle", "slider", "duration"})
_KEPT_AS_WRITTEN = frozenset({"code_lines", "code_value", "note"})


_NOT_MADE = (CodeRefused, KeyError, ValueError, TypeError, IndexError, SyntaxError)
"""How a generator says that it makes nothing of these choices and numbers."""

_MARKER = "?"
_ANY_VALUE = re.compile(r"Name\(id='SLOT_\w+', ctx=\w+\(\)\)|Constant\(value=-?[0-9][0-9.e+-]*\)")


@dataclass(frozen=True, slots=True)
class Pattern:
    """Python of a block with markers: an expression or statements; ``size`` is how much it says.

    ``fields`` are the choices it was made with, ``keys`` the slots by their positions.
    """

    definition: Definition
    nodes: tuple[ast.AST, ...]
    fields: Mapping[str, FieldValue]
    groups: Mapping[str, int]
    keys: tuple[str, ...]
    size: int


@dataclass(slots=True)
class Learned:
    """All patterns of a language, the ones that say most first, by what they begin with."""

    values: dict[object, list[Pattern]] = field(default_factory=lambda: defaultdict(list))
    statements: dict[object, list[Pattern]] = field(default_factory=lambda: defaultdict(list))
    hats: list[Pattern] = field(default_factory=list)


_KNOWN: dict[tuple[int, ...], tuple[object, Learned]] = {}
"""By the ids of the definitions and tables of choices, which are kept so that these stay theirs."""


def learned(language: Language) -> Learned:
    """The patterns of a language without a project's own blocks; learned once."""
    shared = [d for name, d in language.definitions.items() if not procedure_of(name)]
    choices = list(language.choices.values())
    key = (*map(id, choices), *map(id, shared))
    if key not in _KNOWN:
        if len(_KNOWN) >= MOST_LANGUAGES:
            _KNOWN.clear()
        _KNOWN[key] = ((choices, shared), _learn(shared, language))
    return _KNOWN[key][1]


def beginning(node: ast.AST) -> object:
    """What a piece of Python is sorted by: its type, its operator, the name that it calls."""
    match node:
        case ast.Expr(value=value):
            return ("statement", beginning(value))
        case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name)):
            return ("call", name)
        case ast.BinOp(op=sign) | ast.UnaryOp(op=sign) | ast.BoolOp(op=sign):
            return type(sign)
        case ast.Compare(ops=[sign]):
            return ("compare", type(sign))
    return type(node)


def _learn(definitions: Sequence[Definition], language: Language) -> Learned:
    found = Learned()
    for definition in definitions:
        if definition.call is not None or definition.generator in _KEPT_AS_WRITTEN:
            continue
        for pattern in _patterns(definition, language):
            if definition.shape == "hat":
                found.hats.append(pattern)
            elif definition.is_value:
                found.values[beginning(pattern.nodes[0])].append(pattern)
            else:
                found.statements[beginning(pattern.nodes[0])].append(pattern)
    for patterns in [*found.values.values(), *found.statements.values(), found.hats]:
        patterns.sort(key=_order)
    return found


def _order(pattern: Pattern) -> tuple[bool, int, int, int]:
    """Patterns that say more come first, then those that take any number, not just 0 in “> 0”;

    then those that take less: a gesture is a state too. Whatever robot tells of it: a state.
    """
    is_anybody = ALL_ROBOTS in pattern.fields.values()
    slots = pattern.definition.slots.values()
    fixed = sum(_is_plain(node) for nodes in pattern.nodes for node in ast.walk(nodes))
    return (
        is_anybody,
        -pattern.size,
        fixed,
        sum(slot.kind.name in ("state", "text", "any") for slot in slots),
    )


def _patterns(definition: Definition, language: Language) -> Iterator[Pattern]:
    seen: set[str] = set()
    for groups in itertools.islice(_group_counts(definition), MOST_PATTERNS):
        for fields in _choices(definition, language, groups):
            keys = tuple(key for key, _ in definition.keys(groups))
            for typed, plain in _variants(definition, keys):
                learner = Learner(language, fields, keys, typed, plain)
                try:
                    nodes = learner.nodes(definition, groups)
                except _NOT_MADE:
                    continue  # not made in this variant
                form = _form(nodes)
                if nodes and form not in (*seen, _MARKER):
                    seen.add(form)
                    size = sum(_says(inner) for node in nodes for inner in ast.walk(node))
                    yield Pattern(definition, nodes, fields, groups, keys, size)


def _group_counts(definition: Definition) -> Iterator[dict[str, int]]:
    names = list(definition.groups)
    ranges = [
        range(definition.minimum[name], definition.groups[name].maximum + 1) for name in names
    ]
    for counts in itertools.product(*ranges):
        yield dict(zip(names, counts, strict=True))


def _choices(
    definition: Definition, language: Language, groups: Mapping[str, int]
) -> list[dict[str, FieldValue]]:
    """The ways in which the choices can be made by which the Python differs in its form."""
    keys = tuple(key for key, _ in definition.keys(groups))
    learner = Learner(language, {}, keys, frozenset(), "")
    with suppress(*_NOT_MADE):
        learner.nodes(definition, groups)
    asked = list(dict.fromkeys(learner.asked))
    tables = [
        list(language.choices_of(definition.slots[split_slot(key)[0]])) or [""] for key in asked
    ]
    ways = itertools.islice(itertools.product(*tables), MOST_PATTERNS)
    made = [dict[str, FieldValue](zip(asked, way, strict=True)) for way in ways]
    if definition.shape != "hat":
        return made
    slots = {key: definition.slots[split_slot(key)[0]] for key in keys}
    robots = [k for k in keys if slots[k].kind.name == "robot" and k not in learner.filled]
    anybody: dict[str, FieldValue] = dict.fromkeys(robots, ALL_ROBOTS)  # a hat then names none
    return [*made, *({**way, **anybody} for way in made if anybody)]


def _variants(definition: Definition, keys: Sequence[str]) -> Iterator[tuple[frozenset[str], str]]:
    """With numbers typed or plugged in, and each time with one slot left as it is when new."""
    numbers = [key for key in keys if definition.slots[split_slot(key)[0]].kind.name in _NUMBERS]
    if len(numbers) > MOST_MIXED:
        numbers = []
    for count in range(len(numbers) + 1):
        for typed in itertools.combinations(numbers, count):
            yield frozenset(typed), ""
            for key in keys:
                if isinstance(definition.defaults.get(split_slot(key)[0]), int | float):
                    yield frozenset(typed), key


def _says(node: ast.AST) -> bool:
    """Whether a node is a part of the Python itself, neither a marker nor a note of ast."""
    if isinstance(node, ast.Name) and node.id.startswith(MARKS):
        return False
    return not isinstance(node, ast.expr_context) and not _is_plain(node)


def _is_plain(node: ast.AST) -> bool:
    """Whether a node is a number or an empty text: a comparison with 0 is a comparison first."""
    if not isinstance(node, ast.Constant) or position_of(node.value) is not None:
        return False
    return node.value == "" or type(node.value) in (int, float)


def _form(nodes: Sequence[ast.AST]) -> str:
    """What the Python looks like, whatever is in its slots."""
    return _ANY_VALUE.sub(_MARKER, "".join(ast.dump(node) for node in nodes))
