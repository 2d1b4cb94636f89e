"""What stacks do with values, and of which kinds the variables of a program are therefore.

``Facts`` say of one stack what it puts where; ``together`` makes of those of all stacks the kinds
in the whole program.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

from nep_studio.blocks.arithmetic import ArithmeticRefused, calculate
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import DEFINE, parameter_of, parameters, procedure_of
from nep_studio.blocks.program import Block, Project, split_slot
from nep_studio.blocks.sharing import EACH_ROBOT
from nep_studio.blocks.slots import TEXT_RESULTS

from .kinds import (
    ANY,
    FRACTION,
    ITEMS,
    KEPT,
    KEYS,
    LIST,
    NATURAL,
    NEGATIVE,
    NUMBER,
    POSITIVE,
    RESULT_KINDS,
    TABLE,
    TEXT,
    TRUTH,
    VARIABLE,
    WHOLE,
    ZERO,
    Kinds,
    all_kinds,
    are,
    counted,
    kinds_of,
    kinds_of_code,
    negated,
    of_constant,
    parameter_key,
    result_key,
    variable_key,
)
from .names import ProgramNames
from .written_code import NO_NAMES, always_ends, gives_back, names_bound_in, names_in_code, tree_of

_FIRST = {LIST: "[]", TABLE: "{}", TEXT: '""', TRUTH: "False", WHOLE: "0"}

_DEEPEST = 100
"""Deeper blocks are refused when they are written."""


# What a stack does with values.


class Given(NamedTuple):
    """The kinds of a value: some that are known, and those of others by their keys.

    ``counted`` are the keys of what is in arithmetic: it gives whole numbers if they are whole.
    ``sized`` say no more than whether it is whole, ``signed`` no more than whether it is below 0.
    """

    kinds: int = 0
    same: frozenset[str] = frozenset()
    counted: frozenset[str] = frozenset()
    sized: frozenset[str] = frozenset()
    signed: frozenset[str] = frozenset()

    def within(self, known: Mapping[str, int]) -> int:
        """The kinds with what is known of the others."""
        kinds = self.kinds | all_kinds(known.get(key, 0) for key in self.same)
        if self.counted:
            kinds |= counted(all_kinds(known.get(key, 0) for key in self.counted))
        if not are(all_kinds(known.get(key, 0) for key in self.sized), WHOLE):
            kinds |= FRACTION
        return kinds | _signs(all_kinds(known.get(key, 0) for key in self.signed))

    def or_else(self, other: Given) -> Given:
        """The kinds of one of two values."""
        return Given(
            self.kinds | other.kinds,
            self.same | other.same,
            self.counted | other.counted,
            self.sized | other.sized,
            self.signed | other.signed,
        )

    def calculated(self) -> Given:
        """The kinds of what arithmetic makes of the value, which must be a number then."""
        return self._replace(
            kinds=counted(self.kinds & NUMBER), same=frozenset(), counted=self.same | self.counted
        )

    def size(self) -> Given:
        """Whether it is whole, and no more."""
        keys = self.same | self.counted | self.sized
        return Given(self.kinds & FRACTION, sized=keys)

    def sign(self) -> Given:
        """Whether it is below 0, and no more."""
        keys = self.same | self.counted | self.signed
        return Given(_signs(self.kinds | (WHOLE if self.sized else 0)), signed=keys)

    def below(self) -> Given:
        """The kinds of it with the other sign."""
        negative = NEGATIVE if self[1:] != Given()[1:] else 0
        return self._replace(kinds=negated(self.kinds) | negative)


def _signs(kinds: int) -> int:
    """The signs of numbers, as the kinds of whole ones; any of a fraction."""
    return WHOLE if kinds & FRACTION else kinds & WHOLE


@dataclass(frozen=True, slots=True)
class Facts:
    """What a stack does with values, wherever it stands.

    ``put`` are values with the keys of where they are put, ``taken`` the variables that are taken
    for a list (LIST) or a table (TABLE), or to which a text is appended (TEXT), ``set_to`` the
    kinds to which blocks set variables, by how these look. ``used`` are the variables that it
    uses: ``early`` those that may be read there before they are set there, ``apart`` those in
    functions of their own that share them, ``watched`` those that are never read there, or in a
    loop that began after they were set.
    ``written`` is what Python in it names; ``begun`` are the names that it does no more with than
    to give them a plain value, each with the kinds of it, and of what is in it if it is a list.
    """

    put: frozenset[tuple[str, Given]] = frozenset()
    taken: frozenset[tuple[str, int]] = frozenset()
    set_to: frozenset[tuple[str, int]] = frozenset()
    used: frozenset[str] = frozenset()
    early: frozenset[str] = frozenset()
    apart: frozenset[str] = frozenset()
    written: frozenset[str] = frozenset()
    watched: frozenset[str] = frozenset()
    is_open: bool = True
    """Whether it may come to its end without giving something back."""
    begun: frozenset[tuple[str, int, int]] = frozenset()
    inside: frozenset[tuple[str, str, bool]] = frozenset()
    """Own blocks with what Python in them names, and whether it may give it another value."""


_NATURAL_RESULTS = frozenset(
    {"text_length", "list_length", "text_find", "list_find", "table_length"}
)
_COUNTED = {
    "arithmetic": ("a", "b"),
    "number_function": ("number",),
    "constrain": ("number", "low", "high"),
    "number": ("number",),
}
_FRACTIONS = {"divide": FRACTION, "power": NUMBER}
_ROOTS = frozenset({"root", "ln", "log10", "exp", "pow10"})
_ITEMS_OF = frozenset({"list_get", "list_take", "random_item"})
_PUT_IN_LISTS = {
    "list_add": "value",
    "list_set": "value",
    "list_insert": "value",
    "list_filled": "item",
}
_PUT_IN_TABLES = {"table_set": "value", "table_change": "amount"}
_LOOK_IN_TABLES = ("table_get", "table_get_or", "table_has", "table_take")
_OUT_OF_TABLES = {"table_names": KEYS, "table_values": KEPT}
_SETS = {"set_variable": "value", "change_variable": "amount", "append_text": "text"}
_CODE = frozenset({"code_lines", "code_value", "program_lines"})
_HARMLESS = ("as_number(", "as_text(", "as_list(", "as_robot(", "str(", "bool(")


_LOOKED_AT = frozenset(
    {
        *(*_SETS, *_PUT_IN_LISTS, *_PUT_IN_TABLES, *_LOOK_IN_TABLES, *_OUT_OF_TABLES, *_CODE),
        "table_create",
        *("variable", "count", "for_each", "list_create", "list_split", "own_return", "own_call"),
        *("fact", "the_plan", "makes_true", "makes_untrue"),
    }
)
"""The blocks that put something somewhere, or name a variable."""


class _Set(NamedTuple):
    """The variables that are surely set, and those of them that are in the same round of loops."""

    ever: frozenset[str]
    here: frozenset[str]

    def with_also(self, variable: str) -> _Set:
        return _Set(self.ever | {variable}, self.here | {variable})

    def in_loop(self) -> _Set:
        return _Set(self.ever, NO_NAMES)

    def without(self, variables: Set[str]) -> _Set:
        return _Set(self.ever - variables, self.here - variables)


_NOTHING = _Set(NO_NAMES, NO_NAMES)
_EACH = "each_robot"
"""What does a body several times at once: each time is a function with variables of its own."""
_AGAIN = frozenset({"while", "repeat_until", "wait_until"})
"""What looks at a value again and again."""
_ASKED_AGAIN = frozenset({"within"})
"""The values that look at others again and again."""
_ROUNDS = frozenset(
    {"forever", "repeat", "until_state", "until_state_at_most", "count", "for_each"}
)


def _in_all(ways: Sequence[_Set]) -> _Set:
    every = zip(*ways, strict=True)
    return _Set(*(frozenset.intersection(*sets) for sets in every))


class FactReader:
    """Reads the facts of one stack."""

    def __init__(self, project: Project, language: Language) -> None:
        self._project = project
        self._language = language
        self._put: set[tuple[str, Given]] = set()
        self._taken: set[tuple[str, int]] = set()
        self._set_to: set[tuple[str, int]] = set()
        self._used: set[str] = set()
        self._early: set[str] = set()
        self._apart: set[str] = set()
        self._read: set[str] = set()
        self._watched: set[str] = set()
        self._written: set[str] = set()
        self._begun: set[tuple[str, int, int]] = set()
        self._inside: set[tuple[str, str, bool]] = set()
        self._procedure = ""
        self._first: frozenset[str] = NO_NAMES
        """The blocks directly under the hat."""
        self._has_each = False

    def read(self, chain: Sequence[str]) -> Facts:
        """The facts of the stack of a chain of blocks; its first is the hat."""
        hat, self._first = self._project.blocks[chain[0]], frozenset(chain)
        self._procedure = procedure_of(hat.type) if hat.type.startswith(DEFINE) else ""
        for block in self._project.within(chain, enabled=True):
            definition = self._language.definitions.get(block.type)
            if definition is None:
                continue
            if block.inputs:
                self._inputs(block, definition)
            if definition.generator in _LOOKED_AT:
                self._block(block, definition)
            self._has_each |= definition.generator == _EACH
        if hat.inputs:  # worked out before anything else is done, and each time again
            self._reads(hat, _NOTHING)
        end = self._walk(chain[1:], _NOTHING, 0)
        if self._procedure and end is not None:  # it ends without giving back: 0
            self._put.add((result_key(self._procedure), Given(ZERO)))
        return Facts(
            frozenset(self._put),
            frozenset(self._taken),
            frozenset(self._set_to),
            frozenset(self._used),
            frozenset(self._early),
            frozenset(self._apart),
            frozenset(self._written),
            frozenset(self._watched | (self._used - self._read)),
            end is not None,
            frozenset(self._begun),
            frozenset(self._inside),
        )

    def _block(self, block: Block, definition: Definition) -> None:
        generator = definition.generator
        if "variable" in definition.slots:
            self._variable_block(block, definition)
        if generator in _PUT_IN_LISTS:
            self._put.add((ITEMS, self._slot(block, _PUT_IN_LISTS[generator])))
        elif generator == "list_create":
            for number in range(1, block.groups.get("item", 0) + 1):
                self._put.add((ITEMS, self._slot(block, f"item.{number}")))
        elif "table" in generator:
            self._table_block(block, generator)
        elif generator == "fact":
            self._put.add((ITEMS, Given(TEXT)))
            for number in range(1, block.groups.get("of", 0) + 1):
                self._put.add((ITEMS, self._slot(block, f"value.{number}")))
        elif generator in ("list_split", "the_plan"):
            self._put.add((ITEMS, Given(TEXT)))
        elif generator in ("makes_true", "makes_untrue") and block.id in self._first:
            self._task()
        elif generator == "own_return" and self._procedure:
            self._put.add((result_key(self._procedure), self._slot(block, "value")))
        elif generator == "own_call":
            self._call(block)
        elif generator in _CODE:
            text = str(definition.value(block, "code"))
            begun = begun_in(text) if generator == "program_lines" else None
            if begun is not None:
                self._begun |= begun
            elif not text.startswith(_HARMLESS):
                used, bound = names_in_code(text), names_bound_in(text)
                self._written |= used
                if self._procedure:
                    self._inside |= {(self._procedure, name, name in bound) for name in used}
            if generator == "code_lines" and self._procedure and gives_back(text):
                self._put.add((result_key(self._procedure), Given(ANY)))

    def _table_block(self, block: Block, generator: str) -> None:
        """Note what a block looks for in a table, puts there, or gives as the items of a list."""
        if generator in _OUT_OF_TABLES:
            self._put.add((ITEMS, Given(same=frozenset({_OUT_OF_TABLES[generator]}))))
            return
        count = block.groups.get("entry", 0)
        parts = [f".{n}" for n in range(1, count + 1)] if generator == "table_create" else [""]
        value = _PUT_IN_TABLES.get(generator, "value" if generator == "table_create" else "")
        for part in parts:
            self._put.add((KEYS, self._slot(block, f"key{part}")))
            if value:
                self._put.add((KEPT, self._slot(block, f"{value}{part}")))
        if generator == "table_change":
            self._put.add((KEPT, Given(ZERO, counted=frozenset({KEPT}))))

    def _inputs(self, block: Block, definition: Definition) -> None:
        for key in block.inputs:
            plugged = self._project.plugged(block, key)
            inner = self._language.definitions.get(plugged.type) if plugged is not None else None
            if plugged is None or inner is None or inner.generator != "variable":
                continue
            slot = definition.slots.get(split_slot(key)[0])
            if slot is not None and slot.kind.name in ("list", "table"):
                self._taken.add((_variable(plugged), RESULT_KINDS[slot.kind.name]))

    def _variable_block(self, block: Block, definition: Definition) -> None:
        variable, generator = _variable(block), definition.generator
        self._used.add(variable)
        key = variable_key(variable)
        if generator in _SETS:
            value = self._slot(block, _SETS[generator])
            looks = WHOLE
            if generator == "append_text":
                value = Given(TEXT)
                self._taken.add((variable, TEXT))
            elif generator == "change_variable":
                value = value.or_else(Given(same=frozenset({key}))).calculated()
            else:
                looks = self._looks(block, "value")
            self._put.add((key, value))
            self._set_to.add((variable, looks))
        elif generator == "count":
            self._put.add((key, self._counted_with(block, definition)))
            self._set_to.add((variable, WHOLE))
        elif generator == "for_each":
            self._put.add((key, Given(same=frozenset({ITEMS}))))
            self._set_to.add((variable, WHOLE))

    def _counted_with(self, block: Block, definition: Definition) -> Given:
        """The kinds of the numbers between the two from which and to which a block counts."""
        first, last, step = (self._slot(block, key) for key in ("first", "last", "step"))
        ends = {"up": first, "down": last}
        between = ends.get(str(definition.value(block, "way")), first.or_else(last))
        return between.sign().or_else(Given(POSITIVE)).or_else(first.size()).or_else(step.size())

    def _looks(self, block: Block, key: str) -> int:
        """The kind of a value as a person sees it: by what is typed, or the block's outline."""
        plugged = self._project.plugged(block, key)
        definition = self._language.definitions[block.type]
        if plugged is None:
            return TEXT if isinstance(definition.value(block, key), str) else WHOLE
        inner = self._language.definitions.get(plugged.type)
        result = inner.result if inner is not None else ""
        if result in TEXT_RESULTS:
            return TEXT
        return TRUTH if result == "boolean" else WHOLE

    def _call(self, block: Block) -> None:
        procedure = self._project.procedures.get(procedure_of(block.type))
        if procedure is not None:
            for parameter in parameters(procedure):
                key = parameter_key(procedure.id, parameter.id)
                self._put.add((key, self._slot(block, parameter.id)))

    def _task(self) -> None:
        """A plan may call an own block that changes facts, with any values that are in facts."""
        procedure = self._project.procedures.get(self._procedure)
        for parameter in parameters(procedure) if procedure is not None else ():
            if parameter.kind != "list":  # no fact has one
                key = parameter_key(self._procedure, parameter.id)
                self._put.add((key, Given(NUMBER | TEXT | TRUTH)))

    def _slot(self, block: Block, key: str, depth: int = 0) -> Given:
        """The kinds of what a slot gives, after it was made what the slot needs."""
        definition = self._language.definitions[block.type]
        kind = definition.slots[split_slot(key)[0]].kind
        plugged = self._project.plugged(block, key)
        if plugged is not None:
            given = self._value(plugged, depth + 1)
        elif kind.is_number or kind.name == "any":
            given = _typed(definition.value(block, key), is_number=kind.is_number)
        else:
            given = Given(RESULT_KINDS.get(kind.name, TEXT))
        if kind.is_number:
            return given.calculated()
        if kind.becomes_text or kind.name in ("boolean", "list", "table", "robot"):
            return Given(RESULT_KINDS.get(kind.name, TEXT))
        return given

    def _value(self, block: Block, depth: int) -> Given:
        definition = self._language.definitions.get(block.type)
        if definition is None or depth > _DEEPEST:
            return Given(ANY)
        generator = definition.generator
        if generator == "variable":
            return Given(same=frozenset({variable_key(_variable(block))}))
        if generator in _COUNTED:
            return self._arithmetic(block, definition, depth)
        if generator in _NATURAL_RESULTS:
            return Given(NATURAL)
        if generator == "round":
            return Given(WHOLE)
        if generator == "random_integer":
            ends = self._slot(block, "low", depth).or_else(self._slot(block, "high", depth))
            return ends.sign()
        if generator == "of_list" and definition.value(block, "function") in ("sum", "min", "max"):
            return Given(ZERO, counted=frozenset({ITEMS}))
        if generator in _ITEMS_OF:
            return Given(same=frozenset({ITEMS}))
        if generator in ("table_get", "table_get_or"):
            kept = Given(same=frozenset({KEPT}))
            is_sure = generator == "table_get"
            return kept if is_sure else kept.or_else(self._slot(block, "otherwise", depth))
        if generator == "table_name_with":
            return Given(same=frozenset({KEYS}))
        if generator == "choose":
            return self._slot(block, "a", depth).or_else(self._slot(block, "b", depth))
        if generator == "own_call":
            return Given(same=frozenset({result_key(procedure_of(block.type))}))
        if generator == "own_parameter":
            key = parameter_key(procedure_of(block.type), parameter_of(block.type))
            return Given(same=frozenset({key}))
        if generator == "code_value":
            return Given(kinds_of_code(str(definition.value(block, "code"))))
        return Given(RESULT_KINDS.get(definition.result, ANY))

    def _arithmetic(self, block: Block, definition: Definition, depth: int) -> Given:
        operation = definition.value(block, "operation") if "operation" in definition.slots else ""
        if kinds := _FRACTIONS.get(str(operation)):
            return Given(kinds)
        function = definition.value(block, "function") if "function" in definition.slots else ""
        if function in _ROOTS:
            return Given(NUMBER)
        keys = _COUNTED[definition.generator]
        given = self._slot(block, keys[0], depth)
        for key in keys[1:]:
            more = self._slot(block, key, depth)
            given = given.or_else(more.below() if operation == "subtract" else more)
        if function == "minus":
            return given.below().calculated()
        is_smaller = operation in ("remainder", "floor_divide")
        given = given.or_else(Given(ZERO)) if is_smaller else given
        return given.calculated()

    # Which variables are always set before they are read: blocks in the order in which they run.

    def _walk(self, chain: Sequence[str], known: _Set, depth: int) -> _Set | None:
        """What is set after a chain, given what is before; None where nothing comes after it.

        What is never reached is looked at too: its Python says what it would do.
        """
        if depth > _DEEPEST:
            return known
        is_reached = True
        for block_id in chain:
            block = self._project.blocks[block_id]
            definition = self._language.definitions.get(block.type)
            if block.disabled or definition is None:
                continue
            after = self._step(block, definition, known, depth)
            is_reached = is_reached and after is not None
            known = known if after is None else after
        return known if is_reached else None

    def _step(self, block: Block, definition: Definition, known: _Set, depth: int) -> _Set | None:
        generator, variable = definition.generator, _variable(block)
        is_again = generator in _AGAIN
        if block.inputs:
            self._reads(block, known.in_loop() if is_again else known)
        if generator == "set_variable":
            return known.with_also(variable)
        if generator in ("change_variable", "append_text"):
            self._read_of({variable}, known)
        if generator == "true_while" and "condition" in block.inputs:  # others ask it, later too
            self._apart.update(self._variables_in([block.inputs["condition"]]))
        if generator == _EACH:
            return self._each(block, known, depth)
        if "apart" in definition.flags:
            inside = [block_id for chain in block.bodies.values() for block_id in chain]
            self._apart.update(self._variables_in(inside, shared=True))
        may_end = definition.shape == "cap" or generator in ("forever", "code_lines")
        if not block.bodies and not may_end:
            return known
        inner = known
        if is_again or generator in _ROUNDS:  # what is done for each robot comes before it, too
            inner = known.in_loop().without(self._set_for_each(block))
        inner = inner.with_also(variable) if generator in ("count", "for_each") else inner
        ends = [self._walk(chain, inner, depth + 1) for chain in block.bodies.values()]
        if generator == "if":
            return self._after_if(block, ends, known)
        if generator == "code_lines" and always_ends(str(definition.value(block, "code"))):
            return None
        known = known.without(self._set_for_each(block))
        if definition.shape == "cap" or generator == "forever":
            return None if not self._is_left(block) else known
        return known

    def _each(self, block: Block, known: _Set, depth: int) -> _Set:
        """What is done for each robot is as a stack by itself: nobody else knows what it sets."""
        chain = block.bodies.get("do", [])
        read, watched = self._read, self._watched
        self._read, self._watched = set(), set()
        self._walk(chain, _NOTHING, depth + 1)
        own = set(self._variables_in(chain))
        self._watched |= watched | (own - self._read)
        self._read |= read
        return known.without(own)

    def _set_for_each(self, block: Block) -> set[str]:
        """The variables of what is done for each robot inside of a block."""
        inside = [i for chain in block.bodies.values() for i in chain] if self._has_each else []
        found = set[str]()
        for one in self._project.within(inside, enabled=True):
            definition = self._language.definitions.get(one.type)
            if definition is not None and definition.generator == _EACH:
                found.update(self._variables_in(one.bodies.get("do", [])))
        return found

    def _after_if(self, block: Block, ends: list[_Set | None], known: _Set) -> _Set | None:
        branches = 1 + block.groups.get("also", 0) + block.groups.get("otherwise", 0)
        if len(ends) < branches or not block.groups.get("otherwise"):
            ends = [*ends, known]
        reached = [end for end in ends if end is not None]
        return _in_all(reached) if reached else None

    def _is_left(self, block: Block) -> bool:
        """Whether there is a block in a loop that leaves it (or another one inside)."""
        inside = [block_id for chain in block.bodies.values() for block_id in chain]
        found = self._project.within(inside, enabled=True)
        definitions = (self._language.definitions.get(one.type) for one in found)
        return any(one is not None and one.generator == "leave_loop" for one in definitions)

    def _reads(self, block: Block, known: _Set) -> None:
        inputs = [i for i in block.inputs.values() if not self._project.blocks[i].disabled]
        if inputs:
            self._read_of(set(self._variables_in(inputs)), known)
            for inner in self._project.within(inputs, enabled=True):
                definition = self._language.definitions.get(inner.type)
                if definition is not None and definition.generator in _ASKED_AGAIN:
                    self._read_of(set(self._variables_in([inner.id])), known.in_loop())

    def _read_of(self, variables: set[str], known: _Set) -> None:
        self._read |= variables
        self._early |= variables - known.ever
        self._watched |= variables - known.here

    def _variables_in(self, roots: Sequence[str], *, shared: bool = False) -> Iterator[str]:
        """The variables of blocks; ``shared``: not those of what is done for each robot."""
        blocks, waiting = self._project.blocks, list(roots)
        while waiting:
            block = blocks[waiting.pop()]
            if block.disabled:
                continue
            if variable := _variable(block):
                yield variable
            if shared and block.type == EACH_ROBOT:
                waiting += block.inputs.values()
            elif block.inputs or block.bodies:
                waiting += block.children()


def _variable(block: Block) -> str:
    return str(block.fields.get("variable", ""))


def _typed(value: object, *, is_number: bool) -> Given:
    if not isinstance(value, str):
        return Given(of_constant(value))
    if not is_number:
        return Given(TEXT)
    try:
        return Given(kinds_of(calculate(value).node) & NUMBER or NUMBER)
    except ArithmeticRefused:
        return Given(NUMBER)


@lru_cache(maxsize=1024)
def begun_in(text: str) -> frozenset[tuple[str, int, int]] | None:
    """The names to which Python gives plain values, with their kinds and those of their items.

    None where it does anything else, besides importing and telling what it is for.
    """
    found = set[tuple[str, int, int]]()
    tree = tree_of(text)
    for node in tree.body if tree is not None else [ast.Pass()]:
        match node:
            case ast.Import() | ast.ImportFrom() | ast.Expr(value=ast.Constant()):
                continue
            case (
                ast.Assign(targets=[ast.Name(id=name)], value=value)
                | ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value)
            ) if _is_plain(value):
                found.add((name, kinds_of(value), 0))
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Dict(keys=[])):
                found.add((name, TABLE, 0))
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.List(elts=items)) if all(
                map(_is_plain, items)
            ):
                found.add((name, LIST, all_kinds(map(kinds_of, items))))
            case _:
                return None
    return frozenset(found)


def _is_plain(value: ast.expr) -> bool:
    inner = value.operand if isinstance(value, ast.UnaryOp) else value
    return isinstance(inner, ast.Constant) and type(inner.value) in (str, int, float, bool)


# All stacks together.


def together(facts: Mapping[str, Facts], project: Project, names: ProgramNames) -> Kinds:
    """The kinds in a program, from the facts of its stacks."""
    kinds = Kinds()
    early = frozenset().union(*(one.early for one in facts.values()))
    put = frozenset().union(*(one.put for one in facts.values()))
    taken = frozenset().union(*(one.taken for one in facts.values()))
    set_to: dict[str, set[int]] = {}
    for one in facts.values():
        for variable, looks in one.set_to:
            set_to.setdefault(variable, set()).add(looks)
    known = kinds.known
    for variable in names.variables:
        first = _first(variable, taken, set_to.get(variable, set()))
        kinds.first[variable] = _FIRST[first]
        held = ZERO if first == WHOLE else first
        known[variable_key(variable)] = held if variable in early else 0
    written = frozenset().union(*(one.written for one in facts.values()))
    if written:
        known.update(_written(written, project, names))
    inside = frozenset().union(*(one.inside for one in facts.values()))
    for key, name in names.parameters.items() if inside else ():
        procedure, _, parameter = key.partition(".")
        if (procedure, name, True) in inside:
            known[parameter_key(procedure, parameter)] = ANY
        if not {(procedure, name, True), (procedure, name, False)}.isdisjoint(inside):
            known.update(dict.fromkeys((ITEMS, KEYS, KEPT), ANY))
    for name, of_value, of_items in frozenset[tuple[str, int, int]]().union(
        *(one.begun for one in facts.values())
    ):
        for variable, so_called in names.variables.items():
            if so_called == name:
                known[variable_key(variable)] = known.get(variable_key(variable), 0) | of_value
                known[ITEMS] = known.get(ITEMS, 0) | of_items
    has_changed = True
    while has_changed:
        has_changed = False
        for key, given in put:
            before = known.get(key, 0)
            after = before | given.within(known)
            if after != before:
                known[key], has_changed = after, True
    kinds.has_lists_twice = any(
        (LIST | TABLE) & known.get(source, 0)
        for key, given in put
        if key.startswith(VARIABLE)
        for source in given.same
    )
    return kinds


def _first(variable: str, taken: frozenset[tuple[str, int]], set_to: set[int]) -> int:
    """The kind of what a variable holds before it is set."""
    if (variable, LIST) in taken:
        return LIST
    if (variable, TABLE) in taken:
        return TABLE
    if (variable, TEXT) in taken or set_to == {TEXT}:
        return TEXT
    return TRUTH if set_to == {TRUTH} else WHOLE


def _written(
    written: frozenset[str], project: Project, names: ProgramNames
) -> Iterator[tuple[str, int]]:
    """What Python that a person wrote may put anything into: all that it names, and lists."""
    named = [key for key, name in names.variables.items() if name in written]
    yield from ((variable_key(variable), ANY) for variable in named)
    called = [key for key, name in names.procedures.items() if name in written]
    for procedure in called:
        for parameter in parameters(project.procedures[procedure]):
            yield parameter_key(procedure, parameter.id), ANY
    if named or called:
        yield from ((inside, ANY) for inside in (ITEMS, KEYS, KEPT))
