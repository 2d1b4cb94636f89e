"""What the text of a program tells before it runs: its variables, and which lines are no step."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

_FRAMEWORKS = {"Behavior", "robot_behaviors"}
_Block = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef
_SILENT = (ast.Global, ast.Nonlocal, ast.Import, ast.ImportFrom)


@dataclass(frozen=True)
class ProgramSource:
    """What is known of a program before it runs; lines count from 1.

    ``variables`` are the names that it gives values to. ``quiet_lines`` are no steps of it: heads
    of functions, imports and, where rules are the program, all that makes them. ``moved`` tells
    for the head of a rule or of an own block the line where its body begins.
    """

    variables: frozenset[str] = frozenset()
    quiet_lines: frozenset[int] = frozenset()
    moved: dict[int, int] = field(default_factory=dict)


def read_source(file: Path) -> ProgramSource:
    """Read a program; one that is not Python has nothing, as it will not run either."""
    try:
        tree = ast.parse(file.read_bytes())
    except (OSError, SyntaxError, ValueError, RecursionError):
        return ProgramSource()
    return ProgramSource(_variables(tree), frozenset(_quiet_lines(tree)), _moved(tree))


def _variables(tree: ast.Module) -> frozenset[str]:
    return frozenset(
        node.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    )


def _quiet_lines(tree: ast.Module) -> Iterator[int]:
    for node in ast.walk(tree):
        if isinstance(node, _Block):
            yield from _head(node)
        elif isinstance(node, ast.Import | ast.ImportFrom):
            yield from range(node.lineno, (node.end_lineno or node.lineno) + 1)
    if _has_rules(tree):
        for statement in tree.body:
            if not isinstance(statement, _Block):
                yield from range(statement.lineno, (statement.end_lineno or 0) + 1)


def _has_rules(tree: ast.Module) -> bool:
    """Whether functions are the program, and the lines beside them only make rules of them."""
    return any(
        isinstance(statement, ast.Assign)
        and isinstance(statement.value, ast.Call)
        and isinstance(statement.value.func, ast.Name)
        and statement.value.func.id in _FRAMEWORKS
        for statement in tree.body
    )


def _moved(tree: ast.Module) -> dict[int, int]:
    return {
        line: _first_step(node)
        for node in tree.body
        if isinstance(node, ast.FunctionDef)
        for line in _head(node)
    }


def _head(node: _Block) -> range:
    """The lines of decorators and of the def itself."""
    first = min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)])
    return range(first, max(node.body[0].lineno, node.lineno + 1))


def _first_step(node: ast.FunctionDef) -> int:
    """The first line of a function's body at which Python stops by."""
    for statement in node.body:
        is_text = isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
        if not is_text and not isinstance(statement, _SILENT):
            return statement.lineno
    return node.body[-1].lineno
