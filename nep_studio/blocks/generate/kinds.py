"""Of which kinds values can be, so that the Python of a program stays plain where it may.

``Kinds`` has those of variables, of the values of own blocks and of what these give back, and of
the items of lists. Where nothing is ever put the set is empty, and any Python will do.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import lru_cache

from .written_code import tree_of

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


def are(kinds: int, wanted: int) -> bool:
    """Whether a value of these kinds is always one of the wanted."""
    return not kinds & ~wanted


def variable_key(variable_id: str) -> str:
    """What a variable is called among the kinds."""
    return f"{VARIABLE}{variable_id}"


VARIABLE = "variable "


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
    **dict.fromkeys(("heard_answer", "heard_word"), TEXT),
    **dict.fromkeys(("list", "sorted", "as_list", "items_between", "list_with"), LIST),
    **dict.fromkeys(("parts_of", "sorted_items", "names_in", "fact", "the_plan"), LIST),
    **dict.fromkeys(("dict", "as_table", "table_of"), TABLE),
    **dict.fromkeys(("as_number", "to_power", "number_in", "sum_of", "mean_of"), NUMBER),
    **dict.fromkeys(("median_of", "deviation_of", "smallest_of", "largest_of"), NUMBER),
    **dict.fromkeys(("as_robot", "this_robot"), ROBOT),
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
            return of_constant(value)
        case ast.JoinedStr():
            return TEXT
        case ast.UnaryOp(op=ast.Not()) | ast.Compare():
            return TRUTH
        case ast.UnaryOp(operand=operand):
            return counted(negated(kinds_of(operand, seen)))
        case ast.BinOp():
            return _of_chain(node, seen)
        case ast.BoolOp(values=values):
            return all_kinds(kinds_of(value, seen) for value in values)
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
            return counted(all_kinds(kinds_of(one, seen) for one in given)) & NUMBER or NUMBER
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


def of_constant(value: object) -> int:
    """The kind of a constant of Python."""
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
        return counted(left | negated(right))
    if isinstance(op, ast.Pow):
        return NUMBER
    return counted(left | right | (0 if isinstance(op, ast.Add | ast.Mult) else ZERO))


def are_mixed(first: int, second: int) -> bool:
    """Whether Python may take two values for equal that are not: True == 1, also inside others."""
    truth, number = TRUTH | OTHER, NUMBER | OTHER
    takes_truth = (first & truth and second & number) or (first & number and second & truth)
    return bool(takes_truth or first & second & (LIST | TABLE))


def counted(kinds: int) -> int:
    """What sums and products are: whole of whole ones, and none below 0 where none of them is."""
    if not are(kinds, WHOLE):
        return NUMBER
    return WHOLE if kinds & NEGATIVE else kinds


def negated(kinds: int) -> int:
    """The kinds of numbers with the other sign."""
    signs = (POSITIVE if kinds & NEGATIVE else 0) | (NEGATIVE if kinds & POSITIVE else 0)
    return kinds & ~(POSITIVE | NEGATIVE) | signs


def all_kinds(kinds: Iterable[int]) -> int:
    """All of several kinds."""
    together = 0
    for one in kinds:
        together |= one
    return together


@lru_cache(maxsize=1024)
def kinds_of_code(text: str) -> int:
    """The kinds of a value that a person wrote as Python, as far as its form tells."""
    match tree_of(text):
        case ast.Module(body=[ast.Expr(value=value)]):
            return kinds_of(value)
    return ANY


# The kinds in a whole program.


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
