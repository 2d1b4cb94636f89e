"""Python that blocks know by another form of the same: places from 0, ranges, letters of a text.

What is read here is kept only where the blocks make it again as it was written, or what counts as
the same: so each form says what the blocks have to know of the values.
"""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator

from nep_studio.blocks.slots import constant

from ..generate.expressions import call, known_whole
from ..generate.kinds import TABLE, TEXT, are, kinds_of
from ..generate.positions import one_less, one_more
from .joined import is_number
from .told_names import looked_at

SAY = "say"
"""What a robot is asked that tells any value as str() does."""


def other_values(node: ast.expr) -> Iterator[ast.expr]:
    """The other forms of a value."""
    match node:
        case ast.Subscript(held, ast.Slice(low, high, None)):
            last = call("len", copy.deepcopy(held)) if high is None else high
            yield call("items_between", one_more(low or constant(0)), last, held)
        case ast.Subscript(held, ast.Slice()):
            return
        case ast.Subscript(held, index):
            yield from _in_list_or_text(held, index)
        case ast.Call(ast.Attribute(held, "pop"), [index], []) if known_whole(index) is None:
            yield call("take_item", one_more(index), held)
        case ast.Call(ast.Name("max" | "min" as name), [_, _, *_] as given, []):
            yield call(name, ast.List(given))
        case ast.Call(ast.Name("len"), [held], []):
            yield call("length_of", held)
        case ast.Call(ast.Name("max" | "min"), [_], [_]) if (plain := by_value(node)) is not node:
            yield plain


def _in_list_or_text(held: ast.expr, index: ast.expr) -> Iterator[ast.expr]:
    place = known_whole(index)
    if place is None:
        yield call("item_of", one_more(index), held)
        yield call("letter_of", one_more(index), held)
    elif place >= 0:
        yield call("letter_of", constant(place + 1), held)
    elif place == -1:
        yield call("letter_of", call("len", copy.deepcopy(held)), held)


def other_statements(node: ast.stmt) -> Iterator[ast.stmt]:
    """The other forms of a statement."""
    match node:
        case ast.For(iter=ast.Call(ast.Name("range"), [_, *_] as given, [])):
            counted = _counted(given)
            yield from [] if counted is None else [_through(node, counted)]
        case ast.For(iter=ast.Call(ast.Attribute(held, "keys"), [], [])):
            yield _through(node, call("list", held))
        case ast.For(iter=items):
            yield _through(node, call("list", items))
        case ast.AugAssign(ast.Name(), ast.Sub(), value):
            number = known_whole(value)
            less: ast.expr = ast.UnaryOp(ast.USub(), value)
            if number is not None and number > 0:  # to add none, or more, is written with +=
                less = constant(-number)
            if isinstance(value, ast.Constant) and isinstance(value.value, float):
                less = constant(-value.value)
            yield ast.copy_location(ast.AugAssign(node.target, ast.Add(), less), node)
        case ast.Assign([ast.Subscript(held, index)], value) if _is_worked_out(index):
            yield _done(node, call("set_item", one_more(index), held, value))
        case ast.Delete([ast.Subscript(held, index)]) if _is_worked_out(index):
            yield _done(node, call("remove_item", one_more(index), held))
        case ast.Expr(ast.Call(ast.Attribute(held, "remove"), [item], [])):
            place = call("place_of", item, copy.deepcopy(held))
            yield _done(node, call("remove_item", place, held))


def _is_worked_out(index: ast.expr) -> bool:
    """Whether a place is not typed: those that are have patterns of their own."""
    return not isinstance(index, ast.Slice | ast.Constant) and known_whole(index) is None


def _counted(given: list[ast.expr]) -> ast.expr | None:
    """The numbers of range(...) as they are counted up or down to the last one."""
    first, end = (constant(0), given[0]) if len(given) == 1 else given[:2]
    step = known_whole(given[2]) if len(given) > 2 else 1
    if not step or len(given) > 3:
        return None
    way, last = ("count_up", one_less(end)) if step > 0 else ("count_down", one_more(end))
    return call(way, first, last, *([] if abs(step) == 1 else [constant(abs(step))]))


def _through(loop: ast.For, items: ast.expr) -> ast.For:
    made = ast.For(loop.target, items, loop.body, loop.orelse, loop.type_comment)
    return ast.copy_location(made, loop)


def _done(node: ast.stmt, made: ast.expr) -> ast.Expr:
    return ast.copy_location(ast.Expr(made), node)


# Forms that are the same whatever the values are, but for what is known of those in the text.


def is_gone_through(ours: ast.For, theirs: object) -> bool:
    """Whether two loops go through the same, where the blocks make a list of that first.

    Letters, and the keys of a table, are the same in a list of them: a table to which something is
    added meanwhile ends its loop by an error. All else must not be changed in the loop.
    """
    if not isinstance(theirs, ast.For):
        return False
    if ast.dump(_without_keys(ours.iter)) == ast.dump(theirs.iter):
        return True
    match theirs.iter:
        case ast.Call(ast.Name("list"), [inner], []):
            plain = _without_keys(ours.iter)
            if ast.dump(plain) != ast.dump(inner):
                return False
            kinds = kinds_of(plain)
            return bool(kinds and are(kinds, TABLE | TEXT)) or not _is_changed_in(ours, plain)
    return False


def _without_keys(items: ast.expr) -> ast.expr:
    match items:
        case ast.Call(ast.Attribute(held, "keys"), [], []):
            return held
    return items


def _is_changed_in(loop: ast.For, items: ast.expr) -> bool:
    """Whether what is gone through may be another at a later round."""
    named = {part.id for part in ast.walk(items) if isinstance(part, ast.Name)}
    parts = [part for line in loop.body for part in ast.walk(line)]
    asked = {id(one) for part in parts for one in looked_at(part)}
    return any(
        isinstance(part, ast.Name) and part.id in named and id(part) not in asked for part in parts
    )


def as_said(node: ast.Call) -> ast.Call:
    """What a robot says, without what it does itself: it tells any value as str() does."""
    match node:
        case ast.Call(ast.Attribute(_, "say"), [ast.Call(ast.Name("str"), [told], []), *more]):
            return ast.Call(node.func, [told, *more], node.keywords)
    return node


def told_by_robot(ours: ast.Call, theirs: object) -> list[tuple[object, object]]:
    """What must be the same where a robot says a number: it tells it as blocks do."""
    match ours, theirs:
        case (
            ast.Call(ast.Attribute(_, "say"), [told, *more]),
            ast.Call(ast.Attribute(_, "say"), [ast.Call(ast.Name("as_text"), [shown], [])]),
        ) if is_number(told):
            assert isinstance(theirs, ast.Call)
            words: list[tuple[object, object]] = [
                (ours.func, theirs.func),
                (ours.keywords, theirs.keywords),
            ]
            return [(told, shown), (more, []), *words]
    return []


def by_value(node: ast.Call) -> ast.Call:
    """The name with the largest value of a table as blocks write it: ``max(t, key=t.get)``.

    People write ``t.keys()`` for the names too, and ``lambda name: t[name]`` for their values.
    """
    match node:
        case ast.Call(ast.Name("max" | "min"), [names], [ast.keyword("key", value_of)]):
            held = _without_keys(names)
        case _:
            return node
    match value_of:
        case ast.Attribute(table, "get"):
            pass
        case ast.Lambda(
            ast.arguments([], [ast.arg(given)], None, [], [], None, []),
            ast.Subscript(table, ast.Name(asked)),
        ) if given == asked:
            pass
        case _:
            return node
    named = {part.id for part in ast.walk(table) if isinstance(part, ast.Name)}
    if ast.dump(table) != ast.dump(held) or (isinstance(value_of, ast.Lambda) and given in named):
        return node
    key = ast.keyword("key", ast.Attribute(table, "get", ast.Load()))
    return ast.Call(node.func, [held], [key])


def as_power(node: ast.BinOp) -> ast.expr:
    """A power of numbers as blocks write it; they refuse what is no number, or far too long."""
    if isinstance(node.op, ast.Pow) and is_number(node.left) and is_number(node.right):
        return ast.Call(ast.Name("to_power", ast.Load()), [node.left, node.right], [])
    return node
