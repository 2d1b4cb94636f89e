"""Learn how the Python of each block looks, by making it with markers in its slots.

So every block that the generators know can be read back, also those that are added later.
"""

from __future__ import annotations

import ast
import itertools
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from functools import lru_cache

from faults import Words, text_of
from nep_studio.blocks.definitions import Definition, Slot
from nep_studio.blocks.errors import BlocksError, CodeRefused, EditRefused
from nep_studio.blocks.generate.expressions import Body, Expressions, Function, Piece, show
from nep_studio.blocks.generate.generators import REPORTERS, STATEMENTS
from nep_studio.blocks.generate.kinds import (
    ANY,
    LIST,
    NUMBER,
    RESULT_KINDS,
    ROBOT,
    TABLE,
    TEXT,
    TRUTH,
    WHOLE,
    Kinds,
    note,
)
from nep_studio.blocks.generate.names import VALUES, ProgramNames
from nep_studio.blocks.generate.plans import FACT_LINES, FACT_VALUES
from nep_studio.blocks.generate.rules import HATS
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import procedure_of
from nep_studio.blocks.program import ALL_ROBOTS, Block, Project, split_slot
from nep_studio.blocks.slots import FieldValue, constant

# Names and numbers that stand for slots in a learned piece of Python, and how they are told.

SLOT, BODY, PART, _VARIABLE = "SLOT_", "BODY_", "PART_", "VARIABLE_"
VARIABLE_NAME = f"{_VARIABLE}variable"
_MARKS = (SLOT, BODY, PART, _VARIABLE)
_FIRST_NUMBER, _STEP, _REACH = 7_000_000, 1000, 20
_WORD = re.compile(r"qslotq([a-z0-9]+?)q")


def mark(sort: str, key: str) -> str:
    """A name that stands for a slot, for the blocks in a body, or for the name of a function."""
    return sort + key.replace(".", "_N")


@lru_cache(maxsize=4096)
def marked(sort: str, name: str) -> str:
    """The slot, body or function of this sort that a name stands for, or an empty text."""
    return name.removeprefix(sort).replace("_N", ".") if name.startswith(sort) else ""


def position_of(number: object) -> tuple[int, int] | None:
    """The position that a number stands for, and what was added to it; or None."""
    if type(number) is not int or number < _FIRST_NUMBER - _REACH:
        return None
    position, more = divmod(number - _FIRST_NUMBER + _REACH, _STEP)
    return (position, more - _REACH) if more <= 2 * _REACH else None


def word_pattern(text: str) -> tuple[re.Pattern[str], list[int]] | None:
    """How a text with such words in it is matched, and which positions they have; or None."""
    positions = [int(number) for number in _WORD.findall(text)]
    if not positions:
        return None
    parts = [re.escape(part) for part in re.split(r"qslotq[a-z0-9]+?q", text)]
    return re.compile("(.*)".join(parts), re.DOTALL), positions


@dataclass(frozen=True, slots=True)
class Known:
    """What is known of slots: where it is enough, the Python of a block is plain.

    ``may_swap`` says that they may be worked out in another order, ``shows_text`` that one sees
    that they hold texts.
    """

    may_swap: bool
    shows_text: bool
    number: int
    value: int
    items: int


KNOWN = (
    Known(True, True, WHOLE, TEXT, LIST),
    Known(True, True, NUMBER, NUMBER, LIST),
    Known(False, False, ANY, ANY, ANY),
    Known(False, True, ANY, ANY, ANY),
)

_SAME_WHATEVER_IS_KNOWN = frozenset({*FACT_LINES, *FACT_VALUES})
"""The generators that write one call, whatever its values are."""

# Makes the Python of a new block with markers in its slots.


class Learner(Expressions):
    """Makes Python with markers; ``asked`` are the choices that the generator looked at.

    ``filled`` are the slots that it wrote as they are.
    """

    def __init__(
        self,
        language: Language,
        fields: Mapping[str, FieldValue],
        keys: Sequence[str],
        typed: frozenset[str],
        plain: str,
        known: Known,
        *,
        is_other: bool = False,
    ) -> None:
        super().__init__(Project("Learned"), language, ProgramNames({}, {}), REPORTERS, Kinds())
        self.asked: list[str] = []
        self.filled: set[str] = set()
        self._fields_chosen = fields
        self._positions = {key: position for position, key in enumerate(keys)}
        self._typed = typed
        self._plain = plain
        self._known = known
        self._functions = 0
        self._is_other = is_other
        self.has_other = False
        """Whether the Python has another form for values that are worked out."""
        self.worked_out: set[str] = set()
        """The choices that a block gives in this variant."""
        self.must_show: set[str] = set()
        """The slots that must show that they hold a text."""
        self.free: set[str] = set()
        """The slots that take a value of any kind."""

    def nodes(self, definition: Definition, groups: Mapping[str, int]) -> tuple[ast.AST, ...]:
        """The Python of a new block of a definition."""
        block = self._block(definition, groups)
        if definition.shape == "hat":
            decorator = HATS[definition.generator](self, block).decorator
            return () if decorator is None else (_parsed(show(decorator)),)
        if definition.is_value:
            return (_parsed(show(REPORTERS[definition.generator](self, block))),)
        pieces = STATEMENTS[definition.generator](self, block)
        return tuple(ast.parse("\n".join(_lines(pieces))).body)

    def slot(self, block: Block, key: str) -> ast.expr:
        """A marker for a slot; the text slots of a value that is no text are markers too."""
        slot, node = self._slot(block, key), self._marker(block, key)
        if slot.kind.is_number and not isinstance(node, ast.Constant):
            return note(node, self._known.number)
        if slot.kind.name in ("list", "table"):
            return note(node, RESULT_KINDS[slot.kind.name])
        if slot.kind.name == "robot":
            return note(node, ROBOT)
        if slot.kind.name == "checkbox":
            return note(node, TRUTH)
        return note(node, TEXT) if slot.kind.becomes_text else node

    def value_in(self, block: Block, key: str) -> ast.expr:
        """A marker for a slot, of the kinds that are known in this variant."""
        self.free.add(key)
        return self._marker(block, key)

    def _marker(self, block: Block, key: str) -> ast.expr:
        slot = self._slot(block, key)
        self.filled.add(key)
        if key == self._plain:
            return constant(self.definition(block).defaults[slot.name])
        if key in self._typed:
            return ast.Constant(_FIRST_NUMBER + _STEP * self._positions[key])
        by_kind = {
            "any": self._known.value,
            "list": self._known.items,
            "table": TABLE if self._known.items == LIST else ANY,
        }
        known = self._known.number if slot.kind.is_number else by_kind.get(slot.kind.name, ANY)
        return note(ast.Name(mark(SLOT, key)), known)

    def shows_text(self, block: Block, key: str) -> bool:
        """As this variant has it."""
        if self._known.shows_text:
            self.must_show.add(key)
        return self._known.shows_text

    def knows_text(self, node: ast.expr) -> bool:
        """No: a slot that must show that it holds a text does so by its block here."""
        return False

    def f_string(self, parts: Sequence[ast.expr]) -> None:
        """None: a join is learned as a sum, and f-strings are read by their form."""

    def has_two_names(self, variable: str) -> bool:
        """As this variant has it."""
        return not self._known.may_swap

    def may_swap(self, first: ast.expr, second: ast.expr) -> bool:
        """As this variant has it."""
        return self._known.may_swap

    def kinds_at(self, key: str) -> int:
        """As this variant has it."""
        return self._known.value

    def choice(self, block: Block, key: str) -> str:
        """The choice that this variant is made with."""
        self.asked.append(key)
        if key in self._fields_chosen:
            return str(self._fields_chosen[key])
        return next(iter(self.language.choices_of(self._slot(block, key))), "")

    def chosen(self, block: Block, key: str) -> str | None:
        """The choice that this variant is made with; None where a block gives it."""
        self.has_other = True
        if not self._is_other:
            return self.choice(block, key)
        self.worked_out.add(key)
        return None

    def stays(self, node: ast.expr) -> bool:
        """As this variant has it."""
        self.has_other = True
        return not self._is_other

    def variable(self, block: Block) -> str:
        """A marker for the variable of a block."""
        return VARIABLE_NAME

    def part_name(self, text: str = "") -> str:
        """A marker for the name of a function."""
        self._functions += 1
        return mark(PART, str(self._functions))

    def inner_name(self, name: str) -> str:
        """A marker for a name that a block has beside variables."""
        return mark(PART, name)

    def _slot(self, block: Block, key: str) -> Slot:
        return self.definition(block).slots[split_slot(key)[0]]

    def _block(self, definition: Definition, groups: Mapping[str, int]) -> Block:
        """A new block whose texts are marker words."""
        block = definition.new_block("b1", groups)
        block.fields |= {
            key: f"qslotq{self._positions[key]}q"
            for key, slot in definition.keys(groups)
            if slot.kind.takes_any_words and not slot.group
        }
        block.fields |= self._fields_chosen
        return block


def _parsed(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


def _lines(pieces: Sequence[Piece]) -> Iterator[str]:
    for piece in pieces:
        if isinstance(piece, str):
            yield piece
        elif isinstance(piece, Body | Function):
            if isinstance(piece, Function):
                yield from (piece.decorator,) if piece.decorator else ()
                yield f"def {piece.name}():"
            if isinstance(piece, Body) and piece.first:
                yield f"    {piece.first}"
            yield f"    {mark(BODY, piece.slot)}"
        else:
            yield str(getattr(piece, "line", ""))


MOST_PATTERNS, MOST_LANGUAGES, MOST_MIXED = 600, 4, 3
_KEPT_AS_WRITTEN = frozenset({"code_lines", "code_value", "note", "program_lines"})


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
    clear: frozenset[str] = frozenset()
    """The slots where only a text is meant that shows itself as one."""
    free: frozenset[str] = frozenset()
    """The slots that take a value of any kind: what Python calls looks at it while it runs."""
    is_range: bool = False
    """Whether it counts with range(...), which ends before its end."""
    fractions: frozenset[str] = frozenset()
    """Slots of which one at least may hold a number that is not whole: else it is written so."""

    @property
    def word(self) -> re.Pattern[str] | None:
        """What the text is like that a call begins with; None where it begins with another."""
        word = _first_word(self.nodes[0])
        return None if word is None else _like(word)


@dataclass(slots=True)
class Learned:
    """All patterns of a language, the ones that say most first, by what they begin with."""

    values: dict[object, list[Pattern]] = field(default_factory=lambda: defaultdict(list))
    statements: dict[object, list[Pattern]] = field(default_factory=lambda: defaultdict(list))
    hats: list[Pattern] = field(default_factory=list)

    def hats_for(self, node: ast.AST) -> Iterator[Pattern]:
        """The patterns of hats that may fit the line above a function."""
        word = _first_word(node)
        for pattern in self.hats:
            said = pattern.word
            if said is None or (word is not None and said.match(word)):
                yield pattern


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


def _first_word(node: ast.AST) -> str | None:
    """The text that a call begins with, or None."""
    match node:
        case ast.Call(args=[ast.Constant(value=str(word)), *_]):
            return word
    return None


@lru_cache(maxsize=1024)
def _like(word: str) -> re.Pattern[str]:
    """What texts look like that fit one with markers in it, or without."""
    found = word_pattern(word)
    return found[0] if found else re.compile(re.escape(word) + r"\Z")


def _learn(definitions: Sequence[Definition], language: Language) -> Learned:
    found = Learned()
    for definition in definitions:
        if definition.call is not None or definition.generator in _KEPT_AS_WRITTEN:
            continue
        for pattern in (*_patterns(definition, language), *_old_patterns(definition)):
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
    fixed = sum(_is_plain(node) for nodes in pattern.nodes for node in ast.walk(nodes))
    slots = pattern.definition.slots.values()
    takes_more = sum(slot.kind.name in ("state", "text", "any") for slot in slots)
    return is_anybody, -pattern.size, fixed, takes_more


# Python of earlier versions, and of people, that means what a block says. Where it would do
# something else without a word, such as range(1, n + 1) for an n of 0, it stays Python.

_START: dict[str, FieldValue] = {"end": "start"}
_END: dict[str, FieldValue] = {"end": "end"}
_Old = tuple[str, Mapping[str, FieldValue]]
_OLD: dict[str, tuple[_Old, ...]] = {
    "list_get": (("list[int(number) - 1]", _START), ("list[-int(number)]", _END)),
    "list_take": (("list.pop(int(number) - 1)", _START), ("list.pop(-int(number))", _END)),
    "list_set": (
        ("list[int(number) - 1] = value", _START),
        ("list[-int(number)] = value", _END),
    ),
    "list_remove": (("del list[int(number) - 1]", _START), ("del list[-int(number)]", _END)),
    "list_insert": (("list.insert(int(number) - 1, value)", _START),),
    "list_filled": (("[item] * int(times)", {}),),
    "list_find": (("list.index(item) + 1 if item in list else 0", {}),),
    "list_contains": (("item in list", {}),),
    "list_joined": (("mark.join(map(str, list))", {}), ("mark.join(list)", {})),
    "list_sorted": (("sorted(list)", {"order": "up"}),),
    "list_split": (("text.split(mark)", {}), ("list(text)", {"mark": ""})),
    "list_copy": (("list.copy()", {}),),
    "table_names": (("list(table.keys())", {}),),
    "table_copy": (("table.copy()", {}),),
    "letter": (("text[int(number) - 1]", {}),),
    "random_integer": (("random.randint(int(low), int(high))", {}),),
    "text_replace": (("text.replace(part, new)", {}),),
    "text_case": (("text.title()", {"case": "title"}),),
    "text_number": (("float(text)", {}),),
    "arithmetic": (("a ** b", {"operation": "power"}),),
    "round": (("round(number)", {"way": "nearest"}),),
    "repeat": (("for _ in range(int(times)):\n    BODY_do", {}),),
    "count": (
        ("for VARIABLE_variable in range(last):\n    BODY_do", {"first": 0, "step": 1}),
        ("for VARIABLE_variable in range(first, last):\n    BODY_do", {"step": 1}),
        ("for VARIABLE_variable in range(first, last, step):\n    BODY_do", {}),
    ),
    "change_variable": (("VARIABLE_variable += amount", {}),),
    "append_text": (("VARIABLE_variable += text", {}),),
}
_MUST_BE_CLEAR = dict.fromkeys(
    ("text[int(number) - 1]", "VARIABLE_variable += text", "list(text)"), frozenset({"text"})
)


def _old_patterns(definition: Definition) -> Iterator[Pattern]:
    for text, fields in _OLD.get(definition.generator, ()):
        yield _old_pattern(definition, text, fields)


def _old_pattern(definition: Definition, text: str, fields: Mapping[str, FieldValue]) -> Pattern:
    tree = ast.parse(text)
    names = {name for name, slot in definition.slots.items() if slot.pluggable}
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and node.id in names:
            node.id = mark(SLOT, node.id)
    nodes: tuple[ast.AST, ...] = tuple(tree.body)
    if definition.is_value:
        nodes = tuple(node.value for node in tree.body if isinstance(node, ast.Expr))
    keys = tuple(key for key, _ in definition.keys({}))
    size = sum(_says(inner) for node in nodes for inner in ast.walk(node))
    clear = _MUST_BE_CLEAR.get(text, frozenset())
    is_range = _is_range(nodes)
    return Pattern(definition, nodes, fields, {}, keys, size, clear, is_range=is_range)


def _is_range(nodes: Sequence[ast.AST]) -> bool:
    match nodes:
        case [ast.For(target=ast.Name(id=name), iter=ast.Call(func=ast.Name(id="range")))]:
            return name == VARIABLE_NAME
    return False


def _patterns(definition: Definition, language: Language) -> Iterable[Pattern]:
    found: dict[str, Pattern] = {}
    every = KNOWN[:1] if definition.generator in _SAME_WHATEVER_IS_KNOWN else KNOWN
    for groups in itertools.islice(_group_counts(definition), MOST_PATTERNS):
        for fields in _choices(definition, language, groups):
            keys = tuple(key for key, _ in definition.keys(groups))
            variants = itertools.product((False, True), _variants(definition, keys), every)
            has_other = False
            for is_other, (typed, plain), known in variants:
                if is_other and not has_other:
                    break
                if is_other and (plain or known is KNOWN[1]):
                    continue  # what is worked out is so whatever stands in the other slots
                learner = Learner(language, fields, keys, typed, plain, known, is_other=is_other)
                try:
                    nodes = learner.nodes(definition, groups)
                except _NOT_MADE:
                    continue  # not made in this variant
                form, has_other = _form(nodes), has_other or learner.has_other
                if form in found and not learner.must_show:  # it says so whatever is shown
                    found[form] = replace(found[form], clear=frozenset())
                elif nodes and form not in (*found, _MARKER) and not _is_range(nodes):
                    size = sum(_says(inner) for node in nodes for inner in ast.walk(node))
                    free = frozenset(learner.free if learner.api & VALUES else ())
                    clear = frozenset(learner.must_show)
                    fractions = _numbers(definition, keys) - typed if known is not KNOWN[0] else ()
                    said = {k: v for k, v in fields.items() if k not in learner.worked_out}
                    found[form] = Pattern(
                        *(definition, nodes, said, groups, keys, size, clear, free),
                        fractions=frozenset(fractions),
                    )
    return found.values()


def _group_counts(definition: Definition) -> Iterator[dict[str, int]]:
    minimum, groups = definition.minimum, definition.groups
    ranges = {name: range(minimum[name], group.maximum + 1) for name, group in groups.items()}
    for counts in itertools.product(*ranges.values()):
        yield dict(zip(ranges, counts, strict=True))


def _choices(
    definition: Definition, language: Language, groups: Mapping[str, int]
) -> list[dict[str, FieldValue]]:
    """The ways in which the choices can be made by which the Python differs in its form."""
    keys = tuple(key for key, _ in definition.keys(groups))
    learner = Learner(language, {}, keys, frozenset(), "", KNOWN[0])
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
    """With numbers typed or plugged in; then each time with one slot left as it is when new."""
    numbers = sorted(_numbers(definition, keys))
    if len(numbers) > MOST_MIXED:
        numbers = []
    counts = range(len(numbers) + 1)
    ways = [frozenset(t) for n in counts for t in itertools.combinations(numbers, n)]
    yield from ((typed, "") for typed in ways)
    for typed in ways:
        for key in keys:
            if isinstance(definition.defaults.get(split_slot(key)[0]), int | float):
                yield typed, key


def _numbers(definition: Definition, keys: Sequence[str]) -> frozenset[str]:
    """The slots that take numbers."""
    return frozenset(k for k in keys if definition.slots[split_slot(k)[0]].kind.is_number)


def _says(node: ast.AST) -> bool:
    """Whether a node is a part of the Python itself, neither a marker nor a note of ast."""
    if isinstance(node, ast.Name) and node.id.startswith(_MARKS):
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


# Blocks read from Python, before they have ids.


class CodeUnread(BlocksError):
    """Python that cannot become blocks; ``line`` is where, from 1."""

    title = "This Python cannot become blocks"

    def __init__(
        self, sentence: Words, line: int, /, *, checklist: Sequence[Words] = (), **values: object
    ) -> None:
        said = text_of(sentence, **values)
        super().__init__("Line {line}: {sentence}", checklist=checklist, line=line, sentence=said)
        self.line = line


class RefusedAtLine(EditRefused):
    """An edit that cannot be; ``line`` of the text asks for it."""

    def __init__(self, sentence: Words, line: int, /, *, checklist: Sequence[Words] = ()) -> None:
        super().__init__(sentence, checklist=checklist)
        self.line = line


@contextmanager
def at_line(line: int) -> Iterator[None]:
    """Tell of edits that cannot be which line of the text asks for them."""
    try:
        yield
    except EditRefused as refused:
        raise RefusedAtLine(refused.sentence, line, checklist=refused.checklist) from refused


@dataclass(slots=True)
class Made:
    """A block with all that is inside it; ``text`` is its Python without the margin.

    ``written`` is how many values in it stay Python.
    """

    type: str
    fields: dict[str, FieldValue] = field(default_factory=dict)
    inputs: dict[str, Made] = field(default_factory=dict)
    bodies: dict[str, list[Made]] = field(default_factory=dict)
    groups: dict[str, int] = field(default_factory=dict)
    comment: str = ""
    text: str = ""
    written: int = 0

    def inner(self) -> Iterator[Made]:
        """The blocks directly inside."""
        yield from self.inputs.values()
        for chain in self.bodies.values():
            yield from chain


def blocks_of(
    project: Project, language: Language, chain: Sequence[Made]
) -> tuple[tuple[str, ...], tuple[Block, ...]]:
    """Blocks with ids that are new to a project: those of the chain, and all."""
    ids: dict[int, str] = {}
    order: list[Made] = []
    waiting = list(reversed(chain))
    while waiting:
        made = waiting.pop()
        ids[id(made)] = project.new_id("b")
        order.append(made)
        waiting.extend(reversed(list(made.inner())))
    blocks = tuple(_block(made, ids, language) for made in order)
    return tuple(ids[id(made)] for made in chain), blocks


def _block(made: Made, ids: dict[int, str], language: Language) -> Block:
    block = language.definitions[made.type].new_block(ids[id(made)], made.groups)
    block.fields |= made.fields
    block.inputs = {key: ids[id(inner)] for key, inner in made.inputs.items()}
    block.bodies = {
        key: [ids[id(inner)] for inner in chain] for key, chain in made.bodies.items() if chain
    }
    block.comment = made.comment
    return block
