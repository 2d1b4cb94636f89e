"""The Python of own blocks and of code that a person wrote: calls, parameters, the names in it."""

from __future__ import annotations

import ast

from ..code_text import CodeText, CodeTextRefused, read_value
from ..errors import CodeRefused
from ..procedures import parameter_of, parameters, procedure_of
from ..program import Block
from .expressions import Expressions, ValueGenerator
from .names import API, MODULES
from .nodes import call
from .printing import Verbatim


def call_of(code: Expressions, block: Block, procedure_id: str) -> ast.expr:
    """The call of an own block."""
    if procedure_id not in code.names.procedures:
        raise CodeRefused(
            "This own block has no definition.",
            block=block.id,
            checklist=("Put its “define” block onto a page again.", "Or take this block out."),
        )
    procedure = code.project.procedures[procedure_id]
    arguments = [code.slot(block, parameter.id) for parameter in parameters(procedure)]
    return call(code.names.procedures[procedure_id], *arguments)


def note_names(code: Expressions, read: CodeText) -> frozenset[str]:
    """Note what written code names, so that it is there; gives the variables it assigns to."""
    named = read.read | read.made
    for variable_id, name in code.names.variables.items():
        if name in named:
            code.variables[variable_id]  # a variable that is used is there
    code.robots.update(robot for robot, name in code.names.robots.items() if name in read.read)
    code.api.update(API & read.read - read.made)
    code.modules.update(MODULES & read.read - read.made)
    return read.set_here & frozenset(code.names.variables.values())


def _own_call(code: Expressions, block: Block) -> ast.expr:
    return call_of(code, block, procedure_of(block.type))


def _own_parameter(code: Expressions, block: Block) -> ast.expr:
    if procedure_of(block.type) != code.procedure:
        raise CodeRefused(
            "This value is known only inside the definition of its own block.",
            block=block.id,
            checklist=("Move it under the “define” block that it comes from.",),
        )
    return ast.Name(code.names.parameters[f"{code.procedure}.{parameter_of(block.type)}"])


def _code_value(code: Expressions, block: Block) -> ast.expr:
    text = str(code.definition(block).value(block, "code"))
    try:
        read = read_value(text)
    except CodeTextRefused as refused:
        raise CodeRefused(
            str(refused), block=block.id, checklist=("Correct what is written in this block.",)
        ) from refused
    note_names(code, read)
    return Verbatim(read.lines[0], is_closed=read.is_closed)


OWN_REPORTERS: dict[str, ValueGenerator] = {
    "own_call": _own_call,
    "own_parameter": _own_parameter,
    "code_value": _code_value,
}
