"""The generator functions of blocks about lists; items are counted from 1, from either end."""

from __future__ import annotations

import ast

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
    plus,
    show,
    whole,
)


def _create(code: Expressions, block: Block) -> ast.expr:
    return ast.List(code.slots(block, "item", "item"))


def _filled(code: Expressions, block: Block) -> ast.expr:
    one = ast.List([code.slot(block, "item")])
    return ast.BinOp(one, ast.Mult(), whole(code.slot(block, "times")))


def _length(code: Expressions, block: Block) -> ast.expr:
    return call("len", code.slot(block, "list"))


def _is_empty(code: Expressions, block: Block) -> ast.expr:
    return compare(_length(code, block), ast.Eq(), ast.Constant(0))


def _contains(code: Expressions, block: Block) -> ast.expr:
    return compare(code.slot(block, "item"), ast.In(), code.slot(block, "list"))


def _find(code: Expressions, block: Block) -> ast.expr:
    item, items = code.slot(block, "item"), code.slot(block, "list")
    place = plus_one(method_call(items, "index", [item]))
    return ast.IfExp(compare(item, ast.In(), items), place, ast.Constant(0))


def _get(code: Expressions, block: Block) -> ast.expr:
    return ast.Subscript(code.slot(block, "list"), _index(code, block))


def _take(code: Expressions, block: Block) -> ast.expr:
    return method_call(code.slot(block, "list"), "pop", [_index(code, block)])


def _part(code: Expressions, block: Block) -> ast.expr:
    low = plus(whole(code.slot(block, "first")), -1)
    high = whole(code.slot(block, "last"))
    first = None if known_whole(low) == 0 else low
    return ast.Subscript(code.slot(block, "list"), ast.Slice(first, high))


def _sorted(code: Expressions, block: Block) -> ast.expr:
    is_down = code.choice(block, "order") == "down"
    keywords: dict[str, ast.expr] = {"reverse": ast.Constant(True)} if is_down else {}
    return call("sorted", code.slot(block, "list"), **keywords)


def _reversed(code: Expressions, block: Block) -> ast.expr:
    return call("list", call("reversed", code.slot(block, "list")))


def _split(code: Expressions, block: Block) -> ast.expr:
    text, mark = code.slot(block, "text"), code.slot(block, "mark")
    if isinstance(mark, ast.Constant) and mark.value == "":
        return call("list", text)
    return method_call(text, "split", [mark])


def _joined(code: Expressions, block: Block) -> ast.expr:
    texts = call("map", ast.Name("str"), code.slot(block, "list"))
    return method_call(code.slot(block, "mark"), "join", [texts])


def _add(code: Expressions, block: Block) -> list[Piece]:
    value = code.slot(block, "value")
    return [show(method_call(code.slot(block, "list"), "append", [value]))]


def _set(code: Expressions, block: Block) -> list[Piece]:
    return [f"{show(_get(code, block))} = {show(code.slot(block, 'value'))}"]


def _insert(code: Expressions, block: Block) -> list[Piece]:
    items, value = code.slot(block, "list"), code.slot(block, "value")
    number = whole(code.slot(block, "number"))
    if code.choice(block, "end") == "start":
        return [show(method_call(items, "insert", [plus(number, -1), value]))]
    if known_whole(number) == 1:
        return [show(method_call(items, "append", [value]))]
    return [show(method_call(items, "insert", [plus(_minus(number), 1), value]))]


def _remove(code: Expressions, block: Block) -> list[Piece]:
    return [f"del {show(_get(code, block))}"]


def _index(code: Expressions, block: Block) -> ast.expr:
    """Item 1 from the start is item 0 of Python, item 1 from the end is item -1."""
    number = whole(code.slot(block, "number"))
    return plus(number, -1) if code.choice(block, "end") == "start" else _minus(number)


def _minus(number: ast.expr) -> ast.expr:
    known = known_whole(number)
    return ast.UnaryOp(ast.USub(), number) if known is None else constant(-known)


def plus_one(number: ast.expr) -> ast.expr:
    """A place as Python counts it, counted from 1."""
    return ast.BinOp(number, ast.Add(), ast.Constant(1))


LIST_REPORTERS: dict[str, ValueGenerator] = {
    "list_create": _create,
    "list_filled": _filled,
    "list_length": _length,
    "list_is_empty": _is_empty,
    "list_contains": _contains,
    "list_find": _find,
    "list_get": _get,
    "list_take": _take,
    "list_part": _part,
    "list_sorted": _sorted,
    "list_reversed": _reversed,
    "list_split": _split,
    "list_joined": _joined,
}
LIST_STATEMENTS: dict[str, StatementGenerator] = {
    "list_add": _add,
    "list_set": _set,
    "list_insert": _insert,
    "list_remove": _remove,
}
