"""The Python of the blocks of lists: plain Python where the kinds of what they get allow it."""

from __future__ import annotations

import ast
from dataclasses import dataclass

from nep_studio.blocks.program import Block
from nep_studio.blocks.slots import constant

from .expressions import (
    Expressions,
    Piece,
    StatementGenerator,
    ValueGenerator,
    call,
    compare,
    known_whole,
    method_call,
    show,
)
from .kinds import (
    ITEMS,
    LIST,
    NATURAL,
    NUMBER,
    OTHER,
    TABLE,
    TEXT,
    TRUTH,
    WHOLE,
    ZERO,
    are,
    are_mixed,
    kinds_of,
    note,
)
from .positions import index_of, is_length_of
from .templates import python_of

_RANDOM_ITEM = python_of("random.choice(list)")


@dataclass(frozen=True, slots=True)
class _Place:
    """The number of an item, and the list: ``index`` is where Python has it, if that is plain."""

    number: ast.expr
    items: ast.expr
    index: ast.expr | None
    options: dict[str, ast.expr]


_INDEXED = LIST | NUMBER | TRUTH
"""What has items, or refuses to be asked for one, as what is kept in lists of lists."""


def _place(code: Expressions, block: Block, then: ast.expr | None = None) -> _Place:
    """Item 1 from the start is item 0 of Python, item 1 from the end is item -1."""
    number, items = code.values_in(block, "number", "list", then=then)
    is_from_end = code.choice(block, "end") == "end"
    options: dict[str, ast.expr] = {"from_end": ast.Constant(True)} if is_from_end else {}
    index, kinds = None, kinds_of(items)
    may_have_items = not kinds or kinds & LIST
    if may_have_items and are(kinds, _INDEXED) and code.may_swap(number, items):
        place = known_whole(number) or 0
        index = index_of(number, items)
        if is_from_end:
            index = constant(-place) if place > 0 else None
    return _Place(number, items, index, options)


def _get(code: Expressions, block: Block) -> ast.expr:
    at = _place(code, block)
    if at.index is not None:
        return note(ast.Subscript(at.items, at.index), code.kinds_at(ITEMS))
    got = code.api_call("item_of", at.number, at.items, **at.options)
    return note(got, code.kinds_at(ITEMS))


def _take(code: Expressions, block: Block) -> ast.expr:
    at = _place(code, block)
    if at.index is not None:
        place = [] if known_whole(at.index) == -1 else [at.index]
        return note(method_call(at.items, "pop", place), code.kinds_at(ITEMS))
    taken = code.api_call("take_item", at.number, at.items, **at.options)
    return note(taken, code.kinds_at(ITEMS))


def _random_item(code: Expressions, block: Block) -> ast.expr:
    return note(_RANDOM_ITEM(code, block), code.kinds_at(ITEMS))


def _part(code: Expressions, block: Block) -> ast.expr:
    first, last, items = code.values_in(block, "first", "last", "list")
    begin = index_of(first, items)
    is_plain = (
        are(kinds_of(items), LIST)
        and (is_length_of(last, items) or are(kinds_of(last), NATURAL))
        and code.may_swap(first, items)
        and code.may_swap(last, items)
    )
    if begin is None or not is_plain:
        return code.api_call("items_between", first, last, items)
    end = None if is_length_of(last, items) else last
    return note(
        ast.Subscript(items, ast.Slice(None if known_whole(begin) == 0 else begin, end)), LIST
    )


def _filled(code: Expressions, block: Block) -> ast.expr:
    item, times = code.slot(block, "item"), code.value_in(block, "times")
    if are(kinds_of(times), WHOLE) and not kinds_of(item) & (LIST | TABLE | OTHER):
        return note(ast.BinOp(ast.List([item]), ast.Mult(), times), LIST)
    return code.api_call("list_with", item, times)


def _list_contains(code: Expressions, block: Block) -> ast.expr:
    items, item = code.slot(block, "list"), code.slot(block, "item")
    is_plain = not are_mixed(kinds_of(item), code.kinds_at(ITEMS))
    if is_plain and code.may_swap(items, item):
        return compare(item, ast.In(), items)
    return code.api_call("has_item", items, item)


def _sorted(code: Expressions, block: Block) -> ast.expr:
    items, is_down = code.slot(block, "list"), code.choice(block, "order") == "down"
    keywords: dict[str, ast.expr] = {"reverse": ast.Constant(True)} if is_down else {}
    held = code.kinds_at(ITEMS)
    if are(held, NUMBER) or are(held, TEXT):
        return call("sorted", items, **keywords)
    return code.api_call("sorted_items", items, **keywords)


_OF_LIST = {
    "sum": ("sum", "sum_of"),
    "min": ("min", "smallest_of"),
    "max": ("max", "largest_of"),
    "mean": ("statistics.mean", "mean_of"),
    "median": ("statistics.median", "median_of"),
    "stdev": ("statistics.stdev", "deviation_of"),
}
_OF_WHOLE = ("sum", "min", "max")
"""The functions of lists of numbers, and those that look first whether all are numbers."""


def _of_list(code: Expressions, block: Block) -> ast.expr:
    plain, careful = _OF_LIST[code.choice(block, "function")]
    held, items = code.kinds_at(ITEMS), code.slot(block, "list")
    if not are(held, NUMBER):
        return code.api_call(careful, items)
    if plain in ("min", "max") and isinstance(items, ast.List) and len(items.elts) > 1:
        return call(plain, *items.elts)
    made = python_of(f"{plain}(list)")(code, block)
    return note(made, held | ZERO) if held and are(held, WHOLE) and plain in _OF_WHOLE else made


def _joined(code: Expressions, block: Block) -> ast.expr:
    items, mark = code.slot(block, "list"), code.slot(block, "mark")
    held = code.kinds_at(ITEMS)
    if (not are(held, WHOLE) and not are(held, TEXT)) or not code.may_swap(items, mark):
        return code.api_call("join_items", items, mark)
    texts = items if are(held, TEXT) else call("map", ast.Name("str"), items)
    return method_call(mark, "join", [texts])


def _split(code: Expressions, block: Block) -> ast.expr:
    text, mark = code.slot(block, "text"), code.slot(block, "mark")
    if not isinstance(mark, ast.Constant):
        return code.api_call("parts_of", text, mark)
    if mark.value:
        return method_call(text, "split", [mark])
    return call("list", code.clear(block, "text", text))


def _add(code: Expressions, block: Block) -> list[Piece]:
    value, items = code.slot(block, "value"), code.value_in(block, "list")
    if are(kinds_of(items), LIST) and code.may_swap(value, items):
        return [show(method_call(items, "append", [value]))]
    return [show(code.api_call("add_item", value, items))]


def _set_item(code: Expressions, block: Block) -> list[Piece]:
    value = code.slot(block, "value")
    at = _place(code, block, then=value)
    if at.index is not None and code.may_swap(at.items, value):
        return [f"{show(ast.Subscript(at.items, at.index))} = {show(value)}"]
    return [show(code.api_call("set_item", at.number, at.items, value, **at.options))]


def _insert(code: Expressions, block: Block) -> list[Piece]:
    value, at = code.slot(block, "value"), _place(code, block)
    if known_whole(at.number) == 1 and at.index is not None and code.may_swap(value, at.items):
        first = [] if at.options else [ast.Constant(0)]
        method = "insert" if first else "append"
        return [show(method_call(at.items, method, [*first, value]))]
    return [show(code.api_call("insert_item", value, at.number, at.items, **at.options))]


def _remove(code: Expressions, block: Block) -> list[Piece]:
    at = _place(code, block)
    if (found := _first_such(code, at)) is not None:
        return [show(method_call(at.items, "remove", [found]))]
    if at.index is not None:
        return [f"del {show(ast.Subscript(at.items, at.index))}"]
    return [show(code.api_call("remove_item", at.number, at.items, **at.options))]


def _first_such(code: Expressions, at: _Place) -> ast.expr | None:
    """The item whose own place in the list is asked for; where there is none, both ways refuse."""
    match at.number:
        case ast.Call(func=ast.Name(id="place_of"), args=[item, items]) if not at.options:
            is_plain = are(kinds_of(at.items), LIST) and isinstance(items, ast.Name)
            is_same = is_plain and ast.dump(items) == ast.dump(at.items)
            return None if are_mixed(kinds_of(item), code.kinds_at(ITEMS)) or not is_same else item
    return None


LIST_VALUES: dict[str, ValueGenerator] = {
    "list_create": lambda code, block: ast.List(code.slots(block, "item", "item")),
    "list_get": _get,
    "list_take": _take,
    "list_part": _part,
    "list_filled": _filled,
    "list_contains": _list_contains,
    "list_sorted": _sorted,
    "list_split": _split,
    "list_joined": _joined,
    "of_list": _of_list,
    "random_item": _random_item,
}

LIST_STATEMENTS: dict[str, StatementGenerator] = {
    "list_add": _add,
    "list_set": _set_item,
    "list_insert": _insert,
    "list_remove": _remove,
}
