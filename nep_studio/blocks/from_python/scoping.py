"""Names of a Python text as the program says them: a variable of the whole of it is program.score.

So a text reads the same whether it says ``global score`` or ``program.score``.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping

from nep_studio.blocks.code_text import made_by, outside_functions
from nep_studio.blocks.program import SCOPE_PROGRAM

from ..generate.names import CLASSES, RESERVED

_Function = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
_Comprehension = ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp


def is_shared(name: str) -> bool:
    """Whether a name of a tree is that of a variable of the whole program."""
    return "." in name


def with_beginnings(tree: ast.Module) -> ast.Module:
    """The tree with a line for each variable that ``program = Variables(score=0)`` begins.

    ``tree`` has names for variables of the whole program already.
    """
    body: list[ast.stmt] = []
    for node in tree.body:
        match node:
            case ast.Assign(
                targets=[ast.Name(id=name)],
                value=ast.Call(func=ast.Name(id=made), args=[], keywords=given),
            ) if CLASSES.get(name) == made and all(one.arg for one in given):
                body += [_beginning(name, one, node) for one in given]
            case _:
                body.append(node)
    tree.body = body
    return tree


def _beginning(owner: str, given: ast.keyword, line: ast.Assign) -> ast.Assign:
    target = ast.copy_location(ast.Name(f"{owner}.{given.arg}", ast.Store()), given)
    made = ast.copy_location(ast.Assign([target], given.value), line)
    made.is_given = True  # type: ignore[attr-defined]
    return made


def is_beginning(node: ast.stmt) -> bool:
    """Whether a line of a tree is a part of one that makes variables of the whole program."""
    return hasattr(node, "is_given")


def with_shared_names(tree: ast.Module, known: Mapping[str, str]) -> ast.Module:
    """The tree of a program in which its plain variables are called ``program.score`` too.

    These are the names that functions say are global, and those of plain values outside of all
    functions; ``known`` are those that a project has for names that a text does not explain. A name
    that stands for a function, a module or a robot too stays as it is.
    """
    own = {name for node in ast.walk(tree) if isinstance(node, _Function) for name in _made(node)}
    made = {name for node in tree.body for name in _stored(node)}
    said = _said_global(ast.walk(tree))
    begun = {name for node in tree.body if (name := _begun(node)) and name not in own}
    kept = RESERVED | {name for node in tree.body for name in (*_header(node), *_defined([node]))}
    for function in (one for one in ast.walk(tree) if isinstance(one, _Function)):
        inside = list(_inside(function))
        kept |= _defined(inside) & _said_global(inside)
    names = {name: f"{SCOPE_PROGRAM}.{name}" for name in (said | begun) - kept}
    free = known.keys() - made - own - kept
    _Renamer({**{name: known[name] for name in free}, **names}).rename(tree)
    return tree


def _begun(node: ast.stmt) -> str:
    match node:
        case ast.Assign(targets=[ast.Name(id=name)], value=ast.Constant() | ast.List()):
            return "" if is_shared(name) else name
    return ""


def _defined(nodes: Iterable[ast.AST]) -> set[str]:
    """What functions, classes, modules and the like are called that are made there."""
    return {name for one in nodes if not isinstance(one, ast.Name) for name in made_by(one)}


def _said_global(nodes: Iterable[ast.AST]) -> set[str]:
    return {name for one in nodes if isinstance(one, ast.Global) for name in one.names}


def _header(node: ast.stmt) -> Iterator[str]:
    match node:
        case ast.Assign(
            targets=[ast.Name(id=name)], value=ast.Call(func=ast.Name(id="Robot" | "Behavior"))
        ):
            yield name


def _stored(node: ast.AST) -> Iterator[str]:
    for inner in outside_functions(node):
        if isinstance(inner, ast.Name) and not isinstance(inner.ctx, ast.Load):
            yield inner.id


def _made(function: _Function) -> set[str]:
    """The names that a function has for itself, with what it is given."""
    every = function.args
    given = [*every.posonlyargs, *every.args, *every.kwonlyargs, every.vararg, every.kwarg]
    names = {one.arg for one in given if one is not None}
    nodes = list(_inside(function))
    scopes = (node.names for node in nodes if isinstance(node, ast.Global | ast.Nonlocal))
    names.update(name for node in nodes for name in made_by(node))
    return names.difference(*scopes)


def _inside(function: _Function) -> Iterator[ast.AST]:
    for part in [] if isinstance(function, ast.Lambda) else function.body:
        yield from outside_functions(part)


class _Renamer:
    """Gives names other names wherever they stand for what is outside of all functions."""

    def __init__(self, names: Mapping[str, str]) -> None:
        self._names = names

    def rename(self, tree: ast.Module) -> None:
        """Rename in place, without recursion."""
        waiting: list[tuple[ast.AST, frozenset[str]]] = [(tree, frozenset())]
        while waiting and self._names:
            node, hidden = waiting.pop()
            if isinstance(node, ast.Name):
                if node.id not in hidden:
                    node.id = self._names.get(node.id, node.id)
                continue
            if isinstance(node, ast.Global):
                node.names = [self._names.get(name, name) for name in node.names]
            inside = hidden
            if isinstance(node, _Function):
                said = {
                    n for one in _inside(node) if isinstance(one, ast.Global) for n in one.names
                }
                inside = (hidden | _made(node)) - said
            elif isinstance(node, _Comprehension):
                stored = (one.target for one in node.generators)
                inside = hidden | {name for target in stored for name in _stored(target)}
            waiting += [(child, inside) for child in ast.iter_child_nodes(node)]
