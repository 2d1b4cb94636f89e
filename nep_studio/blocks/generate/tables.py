"""The Python of the blocks of tables: a dict where its keys are plain, else functions of nep_core.

Python takes True for 1. So whatever may be a truth goes through functions, which keep it under a
key of its own; a key that is a text or a number is plain in any program.
"""

from __future__ import annotations

import ast

from nep_studio.blocks.program import Block

from .expressions import (
    Expressions,
    Piece,
    StatementGenerator,
    ValueGenerator,
    call,
    compare,
    method_call,
    show,
)
from .kinds import KEPT, KEYS, LIST, NUMBER, OTHER, TABLE, TEXT, TRUTH, are, kinds_of, note


def _is_plain(key: int) -> bool:
    """Whether Python's dict has what is kept at a key of these kinds where functions look, too."""
    return not key & (TRUTH | OTHER)


def _is_place(code: Expressions, table: ast.expr, key: ast.expr) -> bool:
    """Whether ``table[key]`` is what a block means: nothing but a table takes a text there.

    What is surely none is refused in words by a function, and read as what it was meant for.
    """
    is_named = bool(kinds_of(key)) and are(kinds_of(key), TEXT) and bool(kinds_of(table) & TABLE)
    return is_named or (are(kinds_of(table), TABLE) and _is_plain(kinds_of(key)))


def _create(code: Expressions, block: Block) -> ast.expr:
    parts = range(1, block.groups.get("entry", 0) + 1)
    entries = [(code.slot(block, f"key.{n}"), code.slot(block, f"value.{n}")) for n in parts]
    if all(_is_plain(kinds_of(key)) for key, _ in entries):
        return ast.Dict([key for key, _ in entries], [value for _, value in entries])
    return code.api_call("table_of", *(one for entry in entries for one in entry))


def _get(code: Expressions, block: Block) -> ast.expr:
    table, key = code.values_in(block, "table", "key")
    if _is_place(code, table, key):
        return note(ast.Subscript(table, key), code.kinds_at(KEPT))
    return note(code.api_call("value_at", table, key), code.kinds_at(KEPT))


def _get_or(code: Expressions, block: Block) -> ast.expr:
    table, key, otherwise = code.values_in(block, "table", "key", "otherwise")
    kinds = code.kinds_at(KEPT) | kinds_of(otherwise)
    if are(kinds_of(table), TABLE) and _is_plain(kinds_of(key)):
        return note(method_call(table, "get", [key, otherwise]), kinds)
    return note(code.api_call("value_at", table, key, otherwise), kinds)


def _has(code: Expressions, block: Block) -> ast.expr:
    table, key = code.values_in(block, "table", "key")
    is_plain = are(kinds_of(table), TABLE) and _is_plain(kinds_of(key))
    if is_plain and code.may_swap(table, key):
        return compare(key, ast.In(), table)
    return code.api_call("has_key", table, key)


def _names(code: Expressions, block: Block) -> ast.expr:
    if not _is_plain(code.kinds_at(KEYS)):
        return code.api_call("names_in", code.value_in(block, "table"))
    return note(call("list", code.slot(block, "table")), LIST)


_EXTREMES = {"max": "name_with_largest", "min": "name_with_smallest"}


def _name_with(code: Expressions, block: Block) -> ast.expr:
    extreme, kept = code.choice(block, "extreme"), code.kinds_at(KEPT)
    table, keys = code.value_in(block, "table"), code.kinds_at(KEYS)
    is_plain = (
        are(kinds_of(table), TABLE) and _is_plain(keys) and (are(kept, NUMBER) or are(kept, TEXT))
    )
    if is_plain and isinstance(table, ast.Name):  # which is the same table both times
        value_of = ast.Attribute(table, "get")
        return note(call(extreme, table, key=value_of), keys)
    return note(code.api_call(_EXTREMES[extreme], table), keys)


def _set(code: Expressions, block: Block) -> list[Piece]:
    value = code.slot(block, "value")
    table, key = code.values_in(block, "table", "key", then=value)
    if _is_place(code, table, key) and all(code.may_swap(one, value) for one in (table, key)):
        return [f"{show(ast.Subscript(table, key))} = {show(value)}"]
    return [show(code.api_call("set_at", table, key, value))]


def _take(code: Expressions, block: Block) -> list[Piece]:
    key, table = code.values_in(block, "key", "table")
    if _is_place(code, table, key) and code.may_swap(key, table):
        return [f"del {show(ast.Subscript(table, key))}"]
    return [show(code.api_call("remove_key", key, table))]


def _change(code: Expressions, block: Block) -> list[Piece]:
    amount = code.slot(block, "amount")
    table, key = code.values_in(block, "table", "key", then=amount)
    place = ast.Subscript(table, key)
    held = method_call(table, "get", [key, ast.Constant(0)])
    is_simple = isinstance(table, ast.Name) and isinstance(key, ast.Name | ast.Constant)
    is_plain = are(kinds_of(table), TABLE) and _is_plain(kinds_of(key)) and is_simple
    is_number = not code.kinds_at(KEPT) & (TRUTH | OTHER)  # a text or a list refuses a number
    held_elsewhere = code.has_two_names(_variable(code, block))
    if is_plain and is_number and not held_elsewhere and code.may_swap(held, amount):
        return [f"{show(place)} = {show(ast.BinOp(held, ast.Add(), amount))}"]
    return [show(code.api_call("change_at", table, key, amount))]


def _variable(code: Expressions, block: Block) -> str:
    """The variable in the place of the table, or an empty text."""
    held = code.plugged(block, "table")
    return "" if held is None else str(held.fields.get("variable", ""))


TABLE_VALUES: dict[str, ValueGenerator] = {
    "table_create": _create,
    "table_get": _get,
    "table_get_or": _get_or,
    "table_has": _has,
    "table_names": _names,
    "table_name_with": _name_with,
}

TABLE_STATEMENTS: dict[str, StatementGenerator] = {
    "table_set": _set,
    "table_take": _take,
    "table_change": _change,
}
