"""Match Python with a learned pattern: what stands where the markers are."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import dataclass, field

from .learning import Pattern
from .markers import VARIABLE_NAME, body_of, is_part, position_of, slot_of, word_pattern

_UNSAID = frozenset({"ctx", "type_comment", "kind", "type_ignores", "type_params"})


@dataclass(slots=True)
class Found:
    """What stands where the markers of a pattern are."""

    slots: dict[str, ast.expr] = field(default_factory=dict)
    words: dict[str, str] = field(default_factory=dict)
    bodies: dict[str, list[ast.stmt]] = field(default_factory=dict)
    parts: dict[str, str] = field(default_factory=dict)
    variable: str = ""


def match(pattern: Pattern, nodes: Sequence[ast.AST]) -> Found | None:
    """What a pattern finds in as many nodes as it has, or None when they differ."""
    found = Found()
    matcher = _Matcher(pattern, found)
    return found if matcher.lists(pattern.nodes, nodes) else None


class _Matcher:
    def __init__(self, pattern: Pattern, found: Found) -> None:
        self._keys = pattern.keys
        self._found = found

    def lists(self, wanted: Sequence[object], there: Sequence[object]) -> bool:
        if len(wanted) == 1 and isinstance(wanted[0], ast.Expr):
            name = wanted[0].value
            if isinstance(name, ast.Name) and (body := body_of(name.id)):
                self._found.bodies[body] = list(there)  # type: ignore[arg-type]
                return bool(there)
        return len(wanted) == len(there) and all(map(self.one, wanted, there))

    def one(self, wanted: object, there: object) -> bool:
        if isinstance(wanted, ast.Name):
            return self._name(wanted.id, there)
        if isinstance(wanted, ast.Constant):
            return self._constant(wanted.value, there)
        if isinstance(wanted, ast.Call) and (key := _whole_slot(wanted)):
            return isinstance(there, ast.expr) and self._slot(key, _without_int(there))
        if type(wanted) is not type(there):
            return False
        if isinstance(wanted, list):
            return self.lists(wanted, there)  # type: ignore[arg-type]
        if not isinstance(wanted, ast.AST):
            return wanted == there
        if isinstance(wanted, ast.FunctionDef) and isinstance(there, ast.FunctionDef):
            plain = not (there.decorator_list or there.returns or there.args.args)
            return plain and self._part(wanted.name, there.name) and self._body(wanted, there)
        if isinstance(wanted, ast.If) and _is_elif(wanted) != _is_elif(there):
            return False
        return all(
            self.one(getattr(wanted, name, None), getattr(there, name, None))
            for name in wanted._fields
            if name not in _UNSAID
        )

    def _body(self, wanted: ast.FunctionDef, there: ast.FunctionDef) -> bool:
        return self.lists(wanted.body, there.body)

    def _name(self, wanted: str, there: object) -> bool:
        if key := slot_of(wanted):
            return isinstance(there, ast.expr) and self._slot(key, there)
        if not isinstance(there, ast.Name):
            return False
        if wanted == VARIABLE_NAME:
            is_same = self._found.variable in ("", there.id)
            self._found.variable = there.id
            return is_same
        return self._part(wanted, there.id) if is_part(wanted) else wanted == there.id

    def _part(self, wanted: str, there: str) -> bool:
        return self._found.parts.setdefault(wanted, there) == there

    def _slot(self, key: str, there: ast.expr) -> bool:
        known = self._found.slots.setdefault(key, there)
        return known is there or ast.dump(known) == ast.dump(there)

    def _constant(self, wanted: object, there: object) -> bool:
        marker = position_of(wanted)
        if marker is not None:
            position, added = marker
            number = _whole_number(there)
            if number is None:
                return False
            return self._slot(self._keys[position], _constant(number - added))
        if not isinstance(there, ast.Constant):
            return False
        words = word_pattern(wanted) if isinstance(wanted, str) else None
        if words is None or not isinstance(there.value, str):
            return type(wanted) is type(there.value) and wanted == there.value
        matched = words[0].fullmatch(there.value)
        if matched is None:
            return False
        for position, word in zip(words[1], matched.groups(), strict=True):
            if self._found.words.setdefault(self._keys[position], word) != word:
                return False
        return True


def _whole_slot(node: ast.Call) -> str:
    """The slot in ``int(slot)``, which is written only where the slot may give a fraction."""
    match node:
        case ast.Call(func=ast.Name(id="int"), args=[ast.Name(id=name)], keywords=[]):
            return slot_of(name)
    return ""


def _without_int(node: ast.expr) -> ast.expr:
    match node:
        case ast.Call(func=ast.Name(id="int"), args=[inner], keywords=[]):
            return inner
    return node


def _is_elif(node: object) -> bool:
    """Whether what comes after an if is an elif, not an if inside an else."""
    if not isinstance(node, ast.If) or len(node.orelse) != 1:
        return False
    inner = node.orelse[0]
    return isinstance(inner, ast.If) and inner.col_offset == node.col_offset


def _whole_number(node: object) -> int | None:
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        inner = _whole_number(node.operand)
        return None if inner is None else -inner
    if isinstance(node, ast.Constant) and type(node.value) is int:
        return node.value
    return None


def _constant(number: int) -> ast.expr:
    if number < 0:
        return ast.UnaryOp(ast.USub(), ast.Constant(-number))
    return ast.Constant(number)
