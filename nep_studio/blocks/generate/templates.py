"""Values that are one line of Python, in which the names of slots stand for what is in them."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from operator import itemgetter
from typing import Any

from nep_studio.blocks.program import Block

from .expressions import Expressions, ValueGenerator
from .names import API, MODULES


def python_of(text: str) -> ValueGenerator:
    """The generator of an expression in which the names of slots stand for what is in them.

    Modules, and functions of nep_core, are noted for the import.
    """
    template = ast.parse(text, mode="eval").body
    named = [node for node in ast.walk(template) if isinstance(node, ast.Name)]
    functions = [node.func for node in ast.walk(template) if isinstance(node, ast.Call)]
    modules = MODULES.intersection(name.id for name in named)
    api = API.intersection(name.id for name in named)
    names = [node.id for node in named if node not in functions]
    slots = list(dict.fromkeys(name for name in names if name not in MODULES))
    make = _maker(template, slots)

    def generate(code: Expressions, block: Block) -> ast.expr:
        if modules or api:
            code.modules |= modules
            code.api |= api
        made: ast.expr = make({slot: code.slot(block, slot) for slot in slots})
        return made

    if isinstance(template, ast.Name):  # nothing but a slot: most numbers, texts and colours
        return lambda code, block: code.slot(block, text)
    return generate


_Maker = Callable[[Mapping[str, ast.expr]], Any]


def _maker(part: Any, slots: Sequence[str]) -> _Maker:
    """What copies a part of a template with what is in the slots; ``list(...)`` is no slot."""
    if isinstance(part, ast.Name) and part.id in slots:
        return itemgetter(part.id)
    if isinstance(part, list):
        makers = [_maker(one, slots) for one in part]
        return lambda filled: [make(filled) for make in makers]
    if not isinstance(part, ast.expr) or isinstance(part, ast.Name | ast.Constant):
        return lambda _filled: part
    if isinstance(part, ast.Call) and isinstance(part.func, ast.Name):
        arguments, function = _maker(part.args, slots), part.func
        return lambda filled: ast.Call(function, arguments(filled), [])
    kind, parts = type(part), [_maker(getattr(part, name), slots) for name in part._fields]
    return lambda filled: kind(*[make(filled) for make in parts])


def by_choice(slot: str, texts: dict[str, str]) -> ValueGenerator:
    """The generator of one of several expressions, by what is chosen in a slot."""
    generators = {choice: python_of(text) for choice, text in texts.items()}
    return lambda code, block: generators[code.choice(block, slot)](code, block)
