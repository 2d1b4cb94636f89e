"""What the whole of a Python text tells of its names: what is imported, a list or a truth."""

from __future__ import annotations

import ast
import itertools
from collections.abc import Iterator

from ..generate.names import MODULES

_TIME = "time"
_TAKEN_OVER = MODULES | {_TIME}
"""The modules whose functions blocks know."""
_USUAL = {
    "sleep": (_TIME, "sleep"),
    "randint": ("random", "randint"),
    "choice": ("random", "choice"),
}
"""What people call without its module, also when a program imports that by itself by now."""

_ASKING = frozenset(
    {
        *("abs", "bool", "enumerate", "float", "int", "len", "list", "max", "min", "print"),
        *("range", "reversed", "round", "set", "sorted", "str", "sum", "tuple", "type"),
    }
)
"""Functions that look at what they are given, and keep nothing of it but its items."""
_FRESH = frozenset({"list", "sorted", "split", "copy"})
"""What gives a list that nobody else has."""


def may_be_asked_twice(node: ast.expr) -> bool:
    """Whether it makes no difference how often, and when, a value is worked out."""
    for number, inner in enumerate(ast.walk(node)):
        if number >= MOST_ASKED_TWICE:
            return False
        if isinstance(inner, ast.Call):
            name = getattr(inner.func, "id", "")
            if name not in _ASKING - {"print"} or inner.keywords:
                return False
        elif not isinstance(inner, _HARMLESS):
            return False
    return True


MOST_ASKED_TWICE = 60
"""Parts of a value that is worked out twice."""
_HARMLESS = (
    *(ast.Name, ast.Constant, ast.Subscript, ast.Attribute, ast.BinOp, ast.UnaryOp, ast.BoolOp),
    *(ast.Compare, ast.operator, ast.unaryop, ast.boolop, ast.cmpop, ast.expr_context, ast.List),
    *(ast.Tuple, ast.Slice, ast.IfExp),
)


def is_taken_over(node: ast.stmt) -> bool:
    """Whether this imports nothing but what the program does by itself for its blocks."""
    return hasattr(node, "is_taken_over")


class Names:
    """The names of a text, each with what may be said of it wherever it stands."""

    def __init__(self, tree: ast.Module) -> None:
        self._tree = tree
        self._nodes = list(ast.walk(tree))
        self._taken = {node.id for node in self._nodes if isinstance(node, ast.Name)}
        self._defined = {
            node.name
            for node in self._nodes
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)
        }
        self._given = {node.arg for node in self._nodes if isinstance(node, ast.arg)}
        self._set = dict[str, list[ast.expr | None]]()
        for name, value in self._all_set():
            self._set.setdefault(name, []).append(value)
        self.robots = {
            name
            for name, values in self._set.items()
            if all(_is_made_by(value, "Robot") for value in values)
        }
        self.imported = dict(self._imported())
        """What a name stands for that was imported: a module, and what of it."""
        self._kept_by_others = self._lent()
        for node in tree.body:
            if isinstance(node, ast.Import | ast.ImportFrom) and self._is_taken_over(node):
                node.is_taken_over = True  # type: ignore[union-attr]

    def _all_set(self) -> Iterator[tuple[str, ast.expr | None]]:
        """Every name to which something is put, with that value where it is said as such."""
        plain = set[int]()
        for node in self._nodes:
            match node:
                case ast.Assign([ast.Name(name) as target], value):
                    plain.add(id(target))
                    yield name, value
        for node in self._nodes:
            if isinstance(node, ast.Import | ast.ImportFrom) and node not in self._tree.body:
                yield from ((alias.asname or alias.name, None) for alias in node.names)
            is_set = isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)
            if isinstance(node, ast.Name) and is_set and id(node) not in plain:
                yield node.id, None

    def _imported(self) -> Iterator[tuple[str, tuple[str, str]]]:
        """Functions of modules by their own names, also where a text does not import them."""
        free = self._taken - self._set.keys() - self._given - self._defined
        made = set[str]()
        for node in self._tree.body:
            match node:
                case ast.ImportFrom(module=str(module), names=names, level=0):
                    made |= {alias.asname or alias.name for alias in names}
                    if module not in _TAKEN_OVER or module in self._set:
                        continue
                    for alias in names:
                        is_known = module != _TIME or alias.name == "sleep"
                        if (name := alias.asname or alias.name) in free and is_known:
                            yield name, (module, alias.name)
        yield from ((name, _USUAL[name]) for name in free & _USUAL.keys() - made)

    def _is_taken_over(self, node: ast.Import | ast.ImportFrom) -> bool:
        """Whether the program imports by itself what blocks use of this."""
        if isinstance(node, ast.ImportFrom):
            return all((alias.asname or alias.name) in self.imported for alias in node.names)
        return all(alias.name == _TIME and not alias.asname for alias in node.names) and (
            self._only_sleeps()
        )

    def _only_sleeps(self) -> bool:
        used = sum(isinstance(node, ast.Name) and node.id == _TIME for node in self._nodes)
        sleeps = sum(
            isinstance(node, ast.Attribute)
            and node.attr == "sleep"
            and isinstance(node.value, ast.Name)
            and node.value.id == _TIME
            for node in self._nodes
        )
        return 0 < used == sleeps

    def may_wait(self) -> bool:
        """Whether “time” is the module, and “wait” what nep_core calls so, wherever they stand."""
        return self.is_free(_TIME) and self.is_free("wait")

    def is_free(self, name: str) -> bool:
        """Whether nothing in the text has this name but what nep_core calls so."""
        return not (name in self._set or name in self._given or name in self._defined)

    def new(self, name: str) -> str:
        """A name that nothing in the text has, as near as can be."""
        others = self._taken | self._defined | self._given
        tries = itertools.chain([name], (f"{name}_{n}" for n in itertools.count(2)))
        found = next(one for one in tries if one not in others)
        self._taken.add(found)
        return found

    def has_own_method(self, name: str) -> bool:
        """Whether the text defines a function of this name itself."""
        return name in self._defined

    def is_called_by_words(self, function: str) -> bool:
        """Whether a function is given a value by its name somewhere, or is given on itself."""
        called = [n for n in self._nodes if isinstance(n, ast.Call)]
        ours = [n for n in called if getattr(n.func, "id", "") == function]
        named = sum(isinstance(n, ast.Name) and n.id == function for n in self._nodes)
        return named > len(ours) or any(n.keywords for n in ours)

    def is_truth(self, name: str) -> bool:
        """Whether a name holds true or false wherever it stands."""
        values = self._set.get(name, [])
        return bool(values) and name not in self._given and all(map(_is_truth, values))

    def is_only_name_of_list(self, name: str) -> bool:
        """Whether a name stands for a list that has no other, wherever it stands."""
        values = self._set.get(name, [])
        is_own = name not in self._given and name not in self._kept_by_others
        return bool(values) and is_own and all(map(_is_fresh, values))

    def _lent(self) -> set[str]:
        """The names whose values get another name, or are kept in something else, or are shared."""
        shared = {n for one in self._nodes if isinstance(one, ast.Global) for n in one.names}
        outside = {
            target.id
            for node in self._tree.body
            if isinstance(node, ast.Assign)
            for target in node.targets
            if isinstance(target, ast.Name)
        }
        asked = {id(one) for node in self._nodes for one in _asked(node)}
        kept = {
            node.id
            for node in self._nodes
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
            if id(node) not in asked
        }
        return shared | outside | kept

    def is_changed_in(self, name: str, loop: ast.For) -> bool:
        """Whether a list may be changed while a loop goes through it."""
        inside = [node for line in loop.body for node in ast.walk(line)]
        only_asked = {id(one) for node in inside for one in looked_at(node)}
        named = [n for n in inside if isinstance(n, ast.Name) and n.id == name]
        elsewhere = {
            node.id
            for function in self._tree.body
            if isinstance(function, ast.FunctionDef) and not _holds(function, loop)
            for node in ast.walk(function)
            if isinstance(node, ast.Name)
        }
        return name in elsewhere or any(id(node) not in only_asked for node in named)


def _holds(function: ast.FunctionDef, loop: ast.For) -> bool:
    return any(node is loop for node in ast.walk(function))


def _is_made_by(value: ast.expr | None, name: str) -> bool:
    return isinstance(value, ast.Call) and getattr(value.func, "id", "") == name


def _is_truth(value: ast.expr | None) -> bool:
    match value:
        case ast.Constant(value=bool()) | ast.Compare() | ast.UnaryOp(op=ast.Not()):
            return True
    return False


def _is_fresh(value: ast.expr | None) -> bool:
    match value:
        case ast.List() | ast.ListComp():
            return True
        case ast.Call(ast.Name(name)) | ast.Call(ast.Attribute(_, name)):
            return name in _FRESH
    return False


def looked_at(node: ast.AST) -> Iterator[ast.expr]:
    """What is asked for an item, or for what is in it, and not changed."""
    match node:
        case ast.Subscript(held, _, ast.Load()):
            yield held
        case ast.Compare(comparators=others):
            yield from others
        case ast.Call(ast.Name("len"), [held]):
            yield held


def _asked(node: ast.AST) -> Iterator[ast.expr]:
    """Where a list stands and gets no other name."""
    yield from looked_at(node)
    match node:
        case ast.Subscript(held):
            yield held
        case ast.Call(ast.Attribute(held, method), given):
            yield held
            if method in ("say", "ask", "join"):
                yield from given
        case ast.Call(ast.Name(name), given) if name in _ASKING:
            yield from given
        case ast.FormattedValue(held) | ast.For(iter=held) | ast.Return(held):
            if held is not None:
                yield held
        case ast.Compare(left) | ast.While(left) | ast.If(left):
            yield left
        case ast.BinOp(left, _, right):
            yield from (left, right)
        case ast.UnaryOp(_, held):
            yield held
