"""Python in the simpler words that blocks have for the same: what a text says is read in these.

Both a text of a person and the one that blocks make are put so: ``a, b = 1, 2`` is two lines, and
``x *= 2`` is ``x = x * 2``. Nothing here depends on what values are, but for names of which the
whole text tells it.
"""

from __future__ import annotations

import ast
import copy
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence

from nep_studio.blocks.code_text import bodies_of

from .robot_calls import CALLS, as_blocks_write
from .told_names import Names, may_be_asked_twice

_LESS_SHORT = (ast.Mult, ast.Div, ast.FloorDiv, ast.Mod, ast.Pow)
"""What blocks say in full: ``x = x * 2``."""


def simplify(tree: ast.Module) -> ast.Module:
    """Put a tree into simpler words, in place; what is new has the line that it comes from."""
    names = Names(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and not node.decorator_list and node in tree.body:
            _simplify_function(node, names)
    inside = [node for top in tree.body if isinstance(top, _FUNCTION) for node in ast.walk(top)]
    for node in inside:
        for lines in bodies_of(node):
            lines[:] = [made for line in lines for made in _statements(line, names)]
    for top in tree.body:
        if isinstance(top, _FUNCTION):
            said = (getattr(one, "id", getattr(one, "name", "")) for one in ast.walk(top))
            _make_above_loops(top.body, Counter(said))
    values = _Values(names)
    for node in reversed(list(ast.walk(tree))):  # what is inside first, without recursion
        values.put_into(node)
    return tree


_FUNCTION = ast.FunctionDef | ast.AsyncFunctionDef


def is_made(node: ast.stmt) -> bool:
    """Whether a statement has no line of its own in the text."""
    return hasattr(node, "is_made")


def with_more(nodes: Sequence[ast.stmt]) -> int:
    """How many statements the first of these is in the text, where they are one there."""
    count = 1
    while count < len(nodes) and is_made(nodes[count]) and nodes[count].lineno == nodes[0].lineno:
        count += 1
    return count


def _at(node: ast.AST, made: ast.stmt, *, is_first: bool = False) -> ast.stmt:
    """A statement in the place of another one in the text."""
    for inner in ast.walk(made):
        if isinstance(inner, ast.stmt | ast.expr) and not hasattr(inner, "lineno"):
            ast.copy_location(inner, node)
    ast.copy_location(made, node)
    if not is_first:
        made.is_made = True  # type: ignore[attr-defined]
    return made


def _all_at(node: ast.stmt, made: Sequence[ast.stmt]) -> list[ast.stmt]:
    return [_at(node, one, is_first=not number) for number, one in enumerate(made)]


# Statements.


def _statements(node: ast.stmt, names: Names) -> list[ast.stmt]:
    """A statement as one or several simpler ones."""
    for simpler in (_in_full, _one_by_one, _taken_out, _changed_anew):
        if (made := simpler(node, names)) is not None:
            return _all_at(node, made)
    for begun in (_with_what_is_kept, _with_item):
        first = begun(node, names)
        if first is not None and isinstance(node, ast.For):
            node.body.insert(0, _at(node, first))
    return [node]


def _in_full(node: ast.stmt, _names: Names) -> list[ast.stmt] | None:
    """``x *= 2`` and ``points[0] += 1``."""
    match node:
        case ast.AugAssign(ast.Name(name), op, value) if isinstance(op, _LESS_SHORT):
            held: ast.expr = ast.Name(name, ast.Load())
        case ast.AugAssign(ast.Subscript(ast.Name() as items, index), op, value) if not isinstance(
            index, ast.Slice
        ) and may_be_asked_twice(index):
            held = ast.Subscript(copy.deepcopy(items), copy.deepcopy(index), ast.Load())
        case _:
            return None
    return [ast.Assign([node.target], ast.BinOp(held, op, value))]


def _one_by_one(node: ast.stmt, names: Names) -> list[ast.stmt] | None:
    """``x = y = 0``, ``a, b = 1, 2`` and ``a, b = b, a``."""
    match node:
        case ast.Assign([ast.Name() as first, *more], value) if more:
            if not all(isinstance(target, ast.Name) for target in more):
                return None
            is_plain = isinstance(value, ast.Constant)
            again = value if is_plain else ast.Name(first.id, ast.Load())
            return [
                ast.Assign([first], value),
                *(ast.Assign([target], copy.deepcopy(again)) for target in more),
            ]
        case ast.Assign([ast.Tuple(targets)], ast.Tuple(values)) if len(targets) == len(values):
            if not all(isinstance(target, ast.Name) for target in targets):
                return None
            if not all(map(may_be_asked_twice, values[1:])):
                return None
            return _in_turn([t.id for t in targets if isinstance(t, ast.Name)], values, names)
    return None


def _in_turn(targets: list[str], values: list[ast.expr], names: Names) -> list[ast.stmt] | None:
    """One name set after the other; what is needed later is remembered before."""
    if len(set(targets)) < len(targets):
        return None
    lines: list[ast.stmt] = []
    before: dict[str, str] = {}
    for number, (target, value) in enumerate(zip(targets, values, strict=True)):
        if any(_reads(later, target) for later in values[number + 1 :]):
            before[target] = names.new(f"{target}_before")
            lines.append(_set(before[target], ast.Name(target, ast.Load())))
        for inner in ast.walk(value):
            if isinstance(inner, ast.Name) and inner.id != before.get(target):
                inner.id = before.get(inner.id, inner.id)
        lines.append(_set(target, value))
    return lines


def _set(name: str, value: ast.expr) -> ast.Assign:
    return ast.Assign([ast.Name(name, ast.Store())], value)


def _reads(node: ast.expr, name: str) -> bool:
    return any(isinstance(one, ast.Name) and one.id == name for one in ast.walk(node))


def _taken_out(node: ast.stmt, names: Names) -> list[ast.stmt] | None:
    """``names.pop(0)``, where nobody uses what it gives."""
    match node:
        case ast.Expr(ast.Call(ast.Attribute(held, "pop"), [] | [_] as given, [])):
            if names.has_own_method("pop"):
                return None
            place = given[0] if given else ast.UnaryOp(ast.USub(), ast.Constant(1))
            return [ast.Delete([ast.Subscript(held, place, ast.Del())])]
    return None


def _changed_anew(node: ast.stmt, names: Names) -> list[ast.stmt] | None:
    """``names.sort()``, where the list has no other name: then a new one is the same."""
    match node:
        case ast.Expr(ast.Call(ast.Attribute(ast.Name(name), method), [], given)):
            if not names.is_only_name_of_list(name):
                return None
            held: list[ast.expr] = [ast.Name(name, ast.Load())]
            match method, given:
                case ("sort", [] | [ast.keyword("reverse", ast.Constant())]):
                    return [_set(name, ast.Call(ast.Name("sorted", ast.Load()), held, given))]
                case ("reverse", []):
                    turned: ast.expr = ast.Call(ast.Name("reversed", ast.Load()), held, [])
                    return [_set(name, ast.Call(ast.Name("list", ast.Load()), [turned], []))]
                case ("clear", []):
                    return [_set(name, ast.List([], ast.Load()))]
    return None


def _with_what_is_kept(node: ast.stmt, _names: Names) -> ast.stmt | None:
    """``for name, age in ages.items()``: what is kept is asked in each round."""
    match node:
        case ast.For(
            ast.Tuple([ast.Name() as key, ast.Name(kept)]),
            ast.Call(ast.Attribute(ast.Name(held) as table, "items"), [], []),
            orelse=[],
        ) if len({key.id, kept, held}) == 3:
            node.target, node.iter = key, table
            return _set(kept, _item(held, ast.Name(key.id, ast.Load())))
    return None


def _with_item(node: ast.stmt, names: Names) -> ast.stmt | None:
    """``for i, name in enumerate(names)``, where the list is not changed meanwhile."""
    match node:
        case ast.For(
            ast.Tuple([ast.Name() as place, ast.Name(item)]),
            ast.Call(ast.Name("enumerate"), [ast.Name(held), *start], []),
            orelse=[],
        ) if len({place.id, item, held}) == 3 and not names.is_changed_in(held, node):
            index: ast.expr = ast.Name(place.id, ast.Load())
            end: ast.expr = ast.Call(ast.Name("len", ast.Load()), [ast.Name(held, ast.Load())], [])
            match start:
                case []:
                    given = [end]
                case [ast.Constant(value=int(first))] if type(first) is int and first > 0:
                    index = ast.BinOp(index, ast.Sub(), ast.Constant(first))
                    end = ast.BinOp(end, ast.Add(), ast.Constant(first))
                    given = [ast.Constant(first), end]
                case _:
                    return None
            made = ast.Call(ast.Name("range", ast.Load()), given, [])
            node.target, node.iter = place, made
            for inner in ast.walk(made):
                ast.copy_location(inner, node)
            return _set(item, _item(held, index))
    return None


def _item(held: str, index: ast.expr) -> ast.Subscript:
    return ast.Subscript(ast.Name(held, ast.Load()), index, ast.Load())


# Functions that a block in a loop is given are made above the loop, once.


def _make_above_loops(
    lines: list[ast.stmt], named: Mapping[str, int], above: list[ast.stmt] | None = None
) -> None:
    """Take functions that only the call below them is given out of loops, to what is ``above``.

    ``named`` tells how often each name stands in the outermost function.
    """
    kept: list[ast.stmt] = []
    for line in lines:
        is_outermost = above is None and isinstance(line, ast.For | ast.While)
        around = [] if is_outermost else above
        inside = None if isinstance(line, _SCOPE) else around
        for part in (line, *getattr(line, "handlers", []), *getattr(line, "cases", [])):
            for body in bodies_of(part):
                _make_above_loops(body, named, inside)
        kept += around if is_outermost and around else []
        if above is not None and (count := _functions_given(kept, line, named)):
            above += kept[-count:]
            del kept[-count:]
        kept.append(line)
    lines[:] = kept


_SCOPE = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef


def _functions_given(above: Sequence[ast.stmt], call: ast.stmt, named: Mapping[str, int]) -> int:
    """How many functions right above a call are all that it is given, and given to it alone."""
    match call:
        case ast.Expr(ast.Call(args=[_, *_] as given)):
            names = [one.id if isinstance(one, ast.Name) else "" for one in given]
        case _:
            return 0
    there = [
        one.name
        for one in above[-len(names) :]
        if isinstance(one, ast.FunctionDef) and not one.decorator_list
    ]
    return len(names) if there == names and all(named[one] == 2 for one in there) else 0


# Functions that become own blocks.


def _simplify_function(function: ast.FunctionDef, names: Names) -> None:
    _keep_given(function, names)
    returns = [node for node in _own(function) if isinstance(node, ast.Return)]
    if returns and all(node.value is None for node in returns):
        lines = _without_returns(function.body)
        if lines is not None:
            function.body = lines


def _own(function: ast.FunctionDef) -> Iterator[ast.AST]:
    """What stands in a function, and in no other one in it."""
    waiting: list[ast.AST] = list(function.body)
    while waiting:
        node = waiting.pop()
        yield node
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Lambda):
            waiting += ast.iter_child_nodes(node)


def _keep_given(function: ast.FunctionDef, names: Names) -> None:
    """Let a value that a function changes be a variable that begins with what was given."""
    counted = {id(target): name for node in _own(function) for target, name in _counted(node)}
    others = {
        node.id
        for node in _own(function)
        if isinstance(node, ast.Name)
        and not isinstance(node.ctx, ast.Load)
        and id(node) not in counted
    }
    stored = set(counted.values()) - others
    inner = [node for node in _own(function) if isinstance(node, ast.FunctionDef | ast.Lambda)]
    if inner or names.is_called_by_words(function.name):
        return
    for argument in reversed(function.args.args):
        if argument.arg in stored and argument.annotation is None:
            name, argument.arg = argument.arg, names.new(f"{argument.arg}_given")
            first = _set(name, ast.Name(argument.arg, ast.Load()))
            function.body.insert(_has_docstring(function), _at(function, first))


def _counted(node: ast.AST) -> Iterator[tuple[ast.expr, str]]:
    """What a statement counts with, such as ``n = n - 1``."""
    match node:
        case ast.AugAssign(ast.Name(name) as target) | ast.Assign(
            [ast.Name(name) as target], ast.BinOp()
        ):
            yield target, name


def _has_docstring(function: ast.FunctionDef) -> int:
    return int(ast.get_docstring(function, clean=False) is not None)


def _without_returns(lines: Sequence[ast.stmt]) -> list[ast.stmt] | None:
    """The same without “return” lines: what comes after one is done else. None where it cannot."""
    for number, line in enumerate(lines):
        if isinstance(line, ast.Return):
            return list(lines[:number]) or [ast.copy_location(ast.Pass(), line)]
        if not any(isinstance(inner, ast.Return) for inner in ast.walk(line)):
            continue
        match line:
            case ast.If(test, [*before, ast.Return()], []):
                rest, done = _without_returns(lines[number + 1 :]), _without_returns(before)
            case _:
                return None
        if rest is None or done is None:
            return None
        if not rest:
            made = ast.If(test, done or [ast.copy_location(ast.Pass(), line)], [])
        elif not done:
            made = ast.If(_negated(test), rest, [])
        else:
            made = ast.If(test, done, rest)
        ast.copy_location(made, line)
        made.end_lineno, made.end_col_offset = lines[-1].end_lineno, lines[-1].end_col_offset
        return [*lines[:number], made]
    return list(lines)


_OPPOSITES: dict[type[ast.cmpop], Callable[[], ast.cmpop]] = {
    **{ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.In: ast.NotIn, ast.NotIn: ast.In},
    **{ast.Lt: ast.GtE, ast.GtE: ast.Lt, ast.Gt: ast.LtE, ast.LtE: ast.Gt},
}


def _negated(test: ast.expr) -> ast.expr:
    match test:
        case ast.UnaryOp(ast.Not(), inner):
            return inner
        case ast.Compare(left, [sign], [right]) if type(sign) in _OPPOSITES:
            made: ast.expr = ast.Compare(left, [_OPPOSITES[type(sign)]()], [right])
        case _:
            made = ast.UnaryOp(ast.Not(), test)
    return ast.copy_location(made, test)


# Values.


class _Values:
    """Puts values into simpler words."""

    def __init__(self, names: Names) -> None:
        self._names = names

    def put_into(self, node: ast.AST) -> None:
        """Put the values directly in a node into simpler words, in place."""
        for field, held in ast.iter_fields(node):
            if isinstance(held, ast.expr):
                setattr(node, field, self._simpler(held))
            elif isinstance(held, list):
                held[:] = [self._simpler(o) if isinstance(o, ast.expr) else o for o in held]

    def _simpler(self, node: ast.expr) -> ast.expr:
        match node:
            case ast.Compare():
                made = self._compared(node)
            case ast.Call():
                made = self._called(node)
            case ast.Name(name) if name in self._names.imported:
                made = self._imported(node)
            case _:
                return node
        for inner in ast.walk(made) if made is not node else ():
            if isinstance(inner, ast.expr) and not hasattr(inner, "lineno"):
                ast.copy_location(inner, node)
        return made

    def _compared(self, node: ast.Compare) -> ast.expr:
        """``0 < x < 10``, ``x not in names`` and ``happy == True``."""
        if len(node.ops) == 1:
            return self._compared_once(node)
        if not all(map(may_be_asked_twice, node.comparators[:-1])):
            return node
        lefts = [node.left, *map(copy.deepcopy, node.comparators[:-1])]
        pairs = zip(lefts, node.ops, node.comparators, strict=True)
        parts = [self._compared_once(ast.Compare(a, [sign], [b])) for a, sign, b in pairs]
        return ast.BoolOp(ast.And(), parts)

    def _compared_once(self, node: ast.Compare) -> ast.expr:
        match node:
            case ast.Compare(left, [ast.NotIn()], [right]):
                return ast.UnaryOp(ast.Not(), ast.Compare(left, [ast.In()], [right]))
            case ast.Compare(
                ast.Name(name) as asked,
                [ast.Eq() | ast.NotEq() as sign],
                [ast.Constant(value=bool(wanted))],
            ) if self._names.is_truth(name):
                is_so = wanted is isinstance(sign, ast.Eq)
                return asked if is_so else ast.UnaryOp(ast.Not(), asked)
        return node

    def _called(self, node: ast.Call) -> ast.expr:
        """``sleep(2)`` and ``nao.say("Hi", "explain")``."""
        match node:
            case ast.Call(ast.Attribute(ast.Name(robot), method)) if robot in self._names.robots:
                return _of_robot(node, method)
            case ast.Call(ast.Attribute(ast.Name("time"), "sleep"), [seconds], []):
                if self._names.may_wait():
                    return ast.Call(ast.Name("wait", ast.Load()), [seconds], [])
        return node

    def _imported(self, node: ast.Name) -> ast.expr:
        """A function of a module that is imported alone, by its whole name."""
        module, name = self._names.imported[node.id]
        held = ast.Name(module, ast.Load())
        return ast.Attribute(held, name, ast.Load())


def _of_robot(node: ast.Call, method: str) -> ast.Call:
    """What a robot is asked; a whole number is said by its digits."""
    made = as_blocks_write(node, method) if method in CALLS else node
    match made.args:
        case [ast.Constant(value=int(told)), *more] if method == "say" and type(told) is int:
            return ast.Call(made.func, [ast.Constant(str(told)), *more], made.keywords)
    return made
