"""What Python that a person wrote names, and how it ends, as far as its form tells."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from functools import lru_cache

from nep_studio.blocks.code_text import as_names, made_by, outside_functions

NO_NAMES: frozenset[str] = frozenset()


@lru_cache(maxsize=1024)
def names_in_code(text: str) -> frozenset[str]:
    """The names in Python that a person wrote; none where it is refused when it is written."""
    tree = tree_of(text)
    used = (n.id for n in ast.walk(tree) if isinstance(n, ast.Name)) if tree else ()
    return names_bound_in(text).union(used)


@lru_cache(maxsize=1024)
def names_bound_in(text: str) -> frozenset[str]:
    """The names to which Python that a person wrote may give another value."""
    tree = tree_of(text)
    return frozenset(name for n in ast.walk(tree) for name in made_by(n)) if tree else NO_NAMES


@lru_cache(maxsize=1024)
def gives_back(text: str) -> bool:
    """Whether Python that a person wrote may give something back for the function it is in."""
    tree = tree_of(text)
    return tree is not None and any(isinstance(n, ast.Return) for n in outside_functions(tree))


@lru_cache(maxsize=1024)
def always_ends(text: str) -> bool:
    """Whether what stands below Python that a person wrote is never reached."""
    tree = tree_of(text)
    return tree is not None and _ends(tree.body)


def _ends(body: Sequence[ast.stmt]) -> bool:
    """Whether statements never come to their end, as far as their form tells."""
    for node in body:
        match node:
            case ast.Return() | ast.Raise():
                return True
            case ast.If(body=then, orelse=other) if _ends(then) and _ends(other):
                return True
            case ast.Try(finalbody=last) if _ends(last):
                return True
            case ast.Try(body=first, orelse=more, handlers=handlers) if _ends(
                [*first, *more]
            ) and all(_ends(one.body) for one in handlers):
                return True
            case ast.While(test=ast.Constant(value=test)) if test and not _is_left(node):
                return True
    return False


def _is_left(loop: ast.While) -> bool:
    return any(isinstance(node, ast.Break) for node in outside_functions(loop))


def tree_of(text: str) -> ast.Module | None:
    """Python that a person wrote; None where it is none."""
    try:
        return as_names(ast.parse(text.strip()))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
