"""Of which kinds the values of a program can be, so that its Python stays plain where it may.

``Facts`` say of one stack what it puts where; ``Kinds`` puts those of all stacks together: the
kinds of variables, of the values of own blocks and of what these give back, and of the items of
lists. Where nothing is ever put the set is empty, and any Python will do.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple

from nep_studio.blocks.arithmetic import ArithmeticRefused, calculate
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import DEFINE, parameter_of, parameters, procedure_of
from nep_studio.blocks.program import Block, Project, split_slot
from nep_studio.blocks.slots import TEXT_RESULTS

from .names import ProgramNames
from .written_code import NO_NAMES, always_ends, gives_back, names_bound_in, names_in_code, tree_of

ZERO, FRACTION, TEXT, TRUTH, LIST, OTHER, TABLE, ROBOT = 1, 2, 4, 8, 16, 32, 64, 128
POSITIVE, NEGATIVE = 256, 512
NATURAL = ZERO | POSITIVE
"""The whole numbers that count places in Python: from below 0, it counts from the end."""
WHOLE = NATURAL | NEGATIVE
NUMBER = WHOLE | FRACTION
ANY = NUMBER | TEXT | TRUTH | LIST | OTHER | TABLE | ROBOT

ITEMS = "items"
"""What the items of all lists can be: lists have many names, so that none is told apart."""
KEYS, KEPT = "keys", "kept"
"""What the keys of all tables can be, also those that are looked for, and what is kept at them."""

RESULT_KINDS = {
    "number": NUMBER,
    "text": TEXT,
    "colour": TEXT,
    "boolean": TRUTH,
    "list": LIST,
    "table": TABLE,
    "robot": ROBOT,
    "any": ANY,
}

_FIRST = {LIST: "[]", TABLE: "{}", TEXT: '""', TRUTH: "False", WHOLE: "0"}

_DEEPEST = 100
"""Deeper blocks are refused when they are written."""


def are(kinds: int, wanted: int) -> bool:
    """Whether a value of these kinds is always one of the wanted."""
    return not kinds & ~wanted


def variable_key(variable_id: str) -> str:
    """What a variable is called among the kinds."""
    return f"{_VARIABLE}{variable_id}"


_VARIABLE = "variable "


def parameter_key(procedure_id: str, parameter_id: str) -> str:
    """What a value of an own block is called among the kinds."""
    return f"value {procedure_id}.{parameter_id}"


def result_key(procedure_id: str) -> str:
    """What is given back by an own block is called so among the kinds."""
    return f"result {procedure_id}"


# The kinds of an expression of Python, from its form; blocks note what they know as ``kinds``.

_CALLS = {
    **dict.fromkeys(("len", "length_of", "place_of", "place_in_text"), NATURAL),
    **dict.fromkeys(("int", "to_nearest", "random_whole"), WHOLE),
    **dict.fromkeys(("str", "as_text", "title_case", "letter_of", "replace_part"), TEXT),
    **dict.fromkeys(("join_items", "append_text"), TEXT),
    **dict.fromkeys(("bool", "has_item", "has_part", "is_same", "is_less", "is_more"), TRUTH),
    **dict.fromkeys(("is_at_most", "is_at_least", "wait_until", "has_key", "is_true"), TRUTH),
    **dict.fromkeys(("date_today", "time_now", "weekday_today", "what_went_wrong"), TEXT),
    **dict.fromkeys(("list", "sorted", "as_list", "items_between", "list_with"), LIST),
    **dict.fromkeys(("parts_of", "sorted_items", "names_in", "fact", "the_plan"), LIST),
    **dict.fromkeys(("dict", "as_table", "table_of"), TABLE),
    **dict.fromkeys(("as_number", "to_power", "number_in", "sum_of", "mean_of"), NUMBER),
    **dict.fromkeys(("median_of", "deviation_of", "smallest_of", "largest_of"), NUMBER),
    "as_robot": ROBOT,
}
_METHODS = {
    **dict.fromkeys(("randint", "floor", "ceil", "find"), WHOLE),
    **dict.fromkeys(("upper", "lower", "title", "replace", "join"), TEXT),
    **dict.fromkeys(("sqrt", "log", "log10", "exp", "radians", "degrees", "random"), FRACTION),
    **dict.fromkeys(("sin", "cos", "tan", "asin", "acos", "atan"), FRACTION),
    "split": LIST,
}


def note(node: ast.expr, kinds: int) -> ast.expr:
    """Note at an expression of which kinds its value is."""
    node.kinds = kinds  # type: ignore[attr-defined]
    return node


Seen = dict[int, tuple[ast.expr, int]]
"""The kinds of expressions by their ids; they are kept, so that the ids stay theirs."""


def kinds_of(node: ast.expr, seen: Seen | None = None) -> int:
    """The kinds of what an expression gives, as far as its form tells or a block has noted.

    Who asks for all parts of long expressions gives ``seen``, in which those are kept.
    """
    noted: int | None = getattr(node, "kinds", None)
    if noted is not None:
        return noted
    if seen is None:
        return _kinds_of(node, None)
    if (known := seen.get(id(node))) is None:
        known = seen[id(node)] = node, _kinds_of(node, seen)
    return known[1]


def _kinds_of(node: ast.expr, seen: Seen | None) -> int:
    match node:
        case ast.Constant(value=value):
            return _of_constant(value)
        case ast.JoinedStr():
            return TEXT
        case ast.UnaryOp(op=ast.Not()) | ast.Compare():
            return TRUTH
        case ast.UnaryOp(operand=operand):
            return _counted(_negated(kinds_of(operand, seen)))
        case ast.BinOp():
            return _of_chain(node, seen)
        case ast.BoolOp(values=values):
            return _all(kinds_of(value, seen) for value in values)
        case ast.IfExp(body=body, orelse=orelse):
            return kinds_of(body, seen) | kinds_of(orelse, seen)
        case ast.Attribute(value=ast.Name(id="math")):
            return FRACTION
        case ast.List():
            return LIST
        case ast.Dict():
            return TABLE
        case ast.Subscript(value=value, slice=index) if are(kinds_of(value, seen), TEXT | LIST):
            is_same = isinstance(index, ast.Slice) or are(kinds_of(value, seen), TEXT)
            return kinds_of(value, seen) if is_same else ANY
        case ast.Call(func=ast.Name(id="abs" | "min" | "max"), args=given) if given[1:] or (
            given and are(kinds_of(given[0], seen), NUMBER)
        ):
            return _counted(_all(kinds_of(one, seen) for one in given)) & NUMBER or NUMBER
        case ast.Call(func=ast.Name(id=name)):
            return _CALLS.get(name, NUMBER if name in ("abs", "min", "max", "round") else ANY)
        case ast.Call(func=ast.Attribute(attr=name)):
            return _METHODS.get(name, ANY)
    return ANY


def _of_chain(node: ast.BinOp, seen: Seen | None) -> int:
    """The kinds of a sum of many parts, which are nested to the left, without recursion."""
    chain: list[ast.BinOp] = []
    first: ast.expr = node
    while isinstance(first, ast.BinOp) and not hasattr(first, "kinds"):
        if seen is not None and id(first) in seen:
            break
        chain.append(first)
        first = first.left
    kinds = kinds_of(first, seen)
    for part in reversed(chain):
        is_one_less = isinstance(part.op, ast.Sub) and _is_one(part.right)
        if is_one_less and are(kinds, POSITIVE):
            kinds = NATURAL if kinds else 0
        else:
            kinds = _of_operation(part.op, kinds, kinds_of(part.right, seen))
        if seen is not None:
            seen[id(part)] = part, kinds
    return kinds


def _is_one(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and type(node.value) is int and node.value == 1


def _of_constant(value: object) -> int:
    if type(value) is int:
        return POSITIVE if value > 0 else NEGATIVE if value else ZERO
    kinds = {bool: TRUTH, float: FRACTION, str: TEXT}
    return kinds.get(type(value), OTHER)


def _of_operation(op: ast.operator, left: int, right: int) -> int:
    if isinstance(op, ast.Add) and TEXT in (left, right):
        return TEXT  # or it is refused
    if not are(left | right, NUMBER):
        return ANY
    if isinstance(op, ast.Div):
        return FRACTION
    if isinstance(op, ast.Sub):
        return _counted(left | _negated(right))
    if isinstance(op, ast.Pow):
        return NUMBER
    return _counted(left | right | (0 if isinstance(op, ast.Add | ast.Mult) else ZERO))


def are_mixed(first: int, second: int) -> bool:
    """Whether Python may take two values for equal that are not: True == 1, also inside others."""
    truth, number = TRUTH | OTHER, NUMBER | OTHER
    takes_truth = (first & truth and second & number) or (first & number and second & truth)
    return bool(takes_truth or first & second & (LIST | TABLE))


def _counted(kinds: int) -> int:
    """What sums and products are: whole of whole ones, and none below 0 where none of them is."""
    if not are(kinds, WHOLE):
        return NUMBER
    return WHOLE if kinds & NEGATIVE else kinds


def _negated(kinds: int) -> int:
    """The kinds of numbers with the other sign."""
    signs = (POSITIVE if kinds & NEGATIVE else 0) | (NEGATIVE if kinds & POSITIVE else 0)
    return kinds & ~(POSITIVE | NEGATIVE) | signs


def _all(kinds: Iterable[int]) -> int:
    together = 0
    for one in kinds:
        together |= one
    return together


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
        kinds = self.kinds | _all(known.get(key, 0) for key in self.same)
        if self.counted:
            kinds |= _counted(_all(known.get(key, 0) for key in self.counted))
        if not are(_all(known.get(key, 0) for key in self.sized), WHOLE):
            kinds |= FRACTION
        return kinds | _signs(_all(known.get(key, 0) for key in self.signed))

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
            kinds=self.kinds & NUMBER, same=frozenset(), counted=self.same | self.counted
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
        return self._replace(kinds=_negated(self.kinds) | negative)


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
    functions of their own, ``watched`` those that are never read there, or in a loop that began
    after they were set.
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


_NOTHING = _Set(NO_NAMES, NO_NAMES)
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
        if "apart" in definition.flags:
            inside = [block_id for chain in block.bodies.values() for block_id in chain]
            self._apart.update(self._variables_in(inside))
        may_end = definition.shape == "cap" or generator in ("forever", "code_lines")
        if not block.bodies and not may_end:
            return known
        inner = known.in_loop() if is_again or generator in _ROUNDS else known
        inner = inner.with_also(variable) if generator in ("count", "for_each") else inner
        ends = [self._walk(chain, inner, depth + 1) for chain in block.bodies.values()]
        if generator == "if":
            return self._after_if(block, ends, known)
        if generator == "code_lines" and always_ends(str(definition.value(block, "code"))):
            return None
        if definition.shape == "cap" or generator == "forever":
            return None if not self._is_left(block) else known
        return known

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

    def _variables_in(self, roots: Sequence[str]) -> Iterator[str]:
        blocks, waiting = self._project.blocks, list(roots)
        while waiting:
            block = blocks[waiting.pop()]
            if block.disabled:
                continue
            if variable := _variable(block):
                yield variable
            if block.inputs or block.bodies:
                waiting += block.children()


def _variable(block: Block) -> str:
    return str(block.fields.get("variable", ""))


def _typed(value: object, *, is_number: bool) -> Given:
    if not isinstance(value, str):
        return Given(_of_constant(value))
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
                found.add((name, LIST, _all(map(kinds_of, items))))
            case _:
                return None
    return frozenset(found)


def _is_plain(value: ast.expr) -> bool:
    inner = value.operand if isinstance(value, ast.UnaryOp) else value
    return isinstance(inner, ast.Constant) and type(inner.value) in (str, int, float, bool)


@lru_cache(maxsize=1024)
def kinds_of_code(text: str) -> int:
    """The kinds of a value that a person wrote as Python, as far as its form tells."""
    match tree_of(text):
        case ast.Module(body=[ast.Expr(value=value)]):
            return kinds_of(value)
    return ANY


# All stacks together.


@dataclass(slots=True)
class Kinds:
    """The kinds of what a program's values are kept in, by their keys.

    ``first`` is what a variable holds before it is set, as Python, by its id. When
    ``has_lists_twice``, a variable may hold a list that is kept elsewhere too.
    """

    known: dict[str, int] = field(default_factory=dict)
    first: dict[str, str] = field(default_factory=dict)
    has_lists_twice: bool = False

    def of(self, key: str) -> int:
        """The kinds of the values that are kept there."""
        return self.known.get(key, 0)


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
        if key.startswith(_VARIABLE)
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
