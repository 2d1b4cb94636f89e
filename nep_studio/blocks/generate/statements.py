"""The generator functions of statements, and of all blocks about lists.

Those of statements give pieces in order: lines, bodies (the chain of blocks in a slot, one step
further in), and functions (a body of its own, for what runs at the same time).
"""

from __future__ import annotations

import ast

from nep_studio.blocks.code_text import CodeText, CodeTextRefused, read_lines, read_value
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.procedures import parameter_of, parameters, procedure_of
from nep_studio.blocks.program import Block
from nep_studio.blocks.slots import constant

from .expressions import (
    Assignment,
    Body,
    Expressions,
    Function,
    Gap,
    GiveBack,
    Leave,
    Piece,
    StatementGenerator,
    ValueGenerator,
    Verbatim,
    Written,
    call,
    comment_lines,
    compare,
    known_whole,
    method_call,
    plus,
    show,
    whole,
)
from .names import API, MODULES


def _filled(code: Expressions, block: Block) -> ast.expr:
    one = ast.List([code.slot(block, "item")])
    return ast.BinOp(one, ast.Mult(), whole(code.slot(block, "times")))


def _length(code: Expressions, block: Block) -> ast.expr:
    return call("len", code.slot(block, "list"))


def _contains(code: Expressions, block: Block) -> ast.expr:
    return compare(code.slot(block, "item"), ast.In(), code.slot(block, "list"))


def _find(code: Expressions, block: Block) -> ast.expr:
    item, items = code.slot(block, "item"), code.slot(block, "list")
    place = plus_one(method_call(items, "index", [item]))
    return ast.IfExp(compare(item, ast.In(), items), place, ast.Constant(0))


def _get(code: Expressions, block: Block) -> ast.expr:
    return ast.Subscript(code.slot(block, "list"), _index(code, block))


def _take(code: Expressions, block: Block) -> ast.expr:
    return method_call(code.slot(block, "list"), "pop", [_index(code, block)])


def _part(code: Expressions, block: Block) -> ast.expr:
    low = plus(whole(code.slot(block, "first")), -1)
    high = whole(code.slot(block, "last"))
    first = None if known_whole(low) == 0 else low
    return ast.Subscript(code.slot(block, "list"), ast.Slice(first, high))


def _sorted(code: Expressions, block: Block) -> ast.expr:
    is_down = code.choice(block, "order") == "down"
    keywords: dict[str, ast.expr] = {"reverse": ast.Constant(True)} if is_down else {}
    return call("sorted", code.slot(block, "list"), **keywords)


def _split(code: Expressions, block: Block) -> ast.expr:
    text, mark = code.slot(block, "text"), code.slot(block, "mark")
    if isinstance(mark, ast.Constant) and mark.value == "":
        return call("list", text)
    return method_call(text, "split", [mark])


def _joined(code: Expressions, block: Block) -> ast.expr:
    texts = call("map", ast.Name("str"), code.slot(block, "list"))
    return method_call(code.slot(block, "mark"), "join", [texts])


def _add(code: Expressions, block: Block) -> list[Piece]:
    value = code.slot(block, "value")
    return [show(method_call(code.slot(block, "list"), "append", [value]))]


def _set(code: Expressions, block: Block) -> list[Piece]:
    return [f"{show(_get(code, block))} = {show(code.slot(block, 'value'))}"]


def _insert(code: Expressions, block: Block) -> list[Piece]:
    items, value = code.slot(block, "list"), code.slot(block, "value")
    number = whole(code.slot(block, "number"))
    if code.choice(block, "end") == "start":
        return [show(method_call(items, "insert", [plus(number, -1), value]))]
    if known_whole(number) == 1:
        return [show(method_call(items, "append", [value]))]
    return [show(method_call(items, "insert", [plus(_minus(number), 1), value]))]


def _index(code: Expressions, block: Block) -> ast.expr:
    """Item 1 from the start is item 0 of Python, item 1 from the end is item -1."""
    number = whole(code.slot(block, "number"))
    return plus(number, -1) if code.choice(block, "end") == "start" else _minus(number)


def _minus(number: ast.expr) -> ast.expr:
    known = known_whole(number)
    return ast.UnaryOp(ast.USub(), number) if known is None else constant(-known)


def plus_one(number: ast.expr) -> ast.expr:
    """A place as Python counts it, counted from 1."""
    return ast.BinOp(number, ast.Add(), ast.Constant(1))


LIST_REPORTERS: dict[str, ValueGenerator] = {
    "list_create": lambda code, block: ast.List(code.slots(block, "item", "item")),
    "list_filled": _filled,
    "list_length": _length,
    "list_is_empty": lambda code, block: compare(_length(code, block), ast.Eq(), ast.Constant(0)),
    "list_contains": _contains,
    "list_find": _find,
    "list_get": _get,
    "list_take": _take,
    "list_part": _part,
    "list_sorted": _sorted,
    "list_reversed": lambda code, block: call("list", call("reversed", code.slot(block, "list"))),
    "list_split": _split,
    "list_joined": _joined,
}
LIST_STATEMENTS: dict[str, StatementGenerator] = {
    "list_add": _add,
    "list_set": _set,
    "list_insert": _insert,
    "list_remove": lambda code, block: [f"del {show(_get(code, block))}"],
}


# Statement blocks that are more than one call.

# The Python of own blocks and of code that a person wrote: calls, parameters, the names in it.


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
            refused.sentence, block=block.id, checklist=("Correct what is written in this block.",)
        ) from refused
    note_names(code, read)
    return Verbatim(read.lines[0], is_closed=read.is_closed)


OWN_REPORTERS: dict[str, ValueGenerator] = {
    "own_call": lambda code, block: call_of(code, block, procedure_of(block.type)),
    "own_parameter": _own_parameter,
    "code_value": _code_value,
}


__all__ = ["STATEMENTS", "Body", "Function", "Gap", "Piece", "StatementGenerator"]

_NO_ARGUMENTS = ast.arguments([], [], None, [], [], None, [])


def _wait_until(code: Expressions, block: Block) -> list[Piece]:
    condition: ast.expr = ast.Lambda(_NO_ARGUMENTS, code.slot(block, "condition"))
    limit = [code.slot(block, "seconds.1")] if block.groups.get("limit") else []
    return [show(code.api_call("wait_until", condition, *limit))]


def _repeat(code: Expressions, block: Block) -> list[Piece]:
    times = whole(code.slot(block, "times"))
    return [f"for _ in range({show(times)}):", Body("do", loop=True)]


def _while(code: Expressions, block: Block) -> list[Piece]:
    return [f"while {show(code.slot(block, 'condition'))}:", Body("do", loop=True)]


def _repeat_until(code: Expressions, block: Block) -> list[Piece]:
    condition = ast.UnaryOp(ast.Not(), code.slot(block, "condition"))
    return [f"while {show(condition)}:", Body("do", loop=True)]


def _count(code: Expressions, block: Block) -> list[Piece]:
    first, last = whole(code.slot(block, "first")), whole(code.slot(block, "last"))
    step = whole(code.slot(block, "step"))
    ends, by = (known_whole(first), known_whole(last)), known_whole(step)
    if by == 0:
        raise CodeRefused(
            "Counting in steps of 0 never ends.",
            block=block.id,
            checklist=("Make the step 1, or any number that is not zero.",),
        )
    if by is not None and by > 0 and None not in ends and ends[0] > ends[1]:  # type: ignore[operator]
        by, step = -by, constant(-by)  # from 10 to 1: down
    arguments = [first, plus(last, -1 if by is not None and by < 0 else 1)]
    counted = call("range", *arguments, *([] if by == 1 else [step]))
    name = code.variable(block)
    return [Assignment(name, f"for {name} in {show(counted)}:"), Body("do", loop=True)]


def _for_each(code: Expressions, block: Block) -> list[Piece]:
    items, name = code.slot(block, "list"), code.variable(block)
    return [Assignment(name, f"for {name} in {show(items)}:"), Body("do", loop=True)]


def _note(code: Expressions, block: Block) -> list[Piece]:
    return list(comment_lines(str(code.definition(block).value(block, "text"))))


def _code_lines(code: Expressions, block: Block) -> list[Piece]:
    text = str(code.definition(block).value(block, "code"))
    try:
        read = read_lines(text)
    except CodeTextRefused as refused:
        raise CodeRefused(
            refused.sentence, block=block.id, checklist=("Correct what is written in this block.",)
        ) from refused
    assigned = note_names(code, read)
    written = Written(read.lines, read.inside_texts, assigned)
    return [written, "pass"] if read.is_empty else [written]


def _if(code: Expressions, block: Block) -> list[Piece]:
    pieces: list[Piece] = [f"if {show(code.slot(block, 'condition'))}:", Body("do")]
    for number in range(1, block.groups.get("also", 0) + 1):
        condition = show(code.slot(block, f"also_condition.{number}"))
        pieces += [f"elif {condition}:", Body(f"also_do.{number}")]
    if block.groups.get("otherwise"):
        pieces += ["else:", Body("otherwise_do.1")]
    return pieces


def _together(code: Expressions, block: Block) -> list[Piece]:
    count = block.groups.get("part", 0)
    functions = [Function(code.part_name(), f"do.{number}") for number in range(1, count + 1)]
    started = code.api_call("together", *(ast.Name(function.name) for function in functions))
    return [*functions, Gap(), show(started)]


def _set_variable(code: Expressions, block: Block) -> list[Piece]:
    name = code.variable(block)
    return [Assignment(name, f"{name} = {show(code.slot(block, 'value'))}")]


def _change_variable(code: Expressions, block: Block) -> list[Piece]:
    name = code.variable(block)
    return [Assignment(name, f"{name} += {show(code.slot(block, 'amount'))}")]


def _append_text(code: Expressions, block: Block) -> list[Piece]:
    code.begins_as(block, "text")
    name = code.variable(block)
    return [Assignment(name, f"{name} += {show(code.slot(block, 'text'))}")]


STATEMENTS: dict[str, StatementGenerator] = {
    "wait_until": _wait_until,
    "repeat": _repeat,
    "forever": lambda code, block: ["while True:", Body("do", loop=True)],
    "while": _while,
    "if": _if,
    "together": _together,
    "set_variable": _set_variable,
    "change_variable": _change_variable,
    "repeat_until": _repeat_until,
    "count": _count,
    "for_each": _for_each,
    "leave_loop": lambda code, block: [Leave("break")],
    "next_round": lambda code, block: [Leave("continue")],
    "stop_rule": lambda code, block: ["return"],
    "note": _note,
    "code_lines": _code_lines,
    "own_call": lambda code, block: [show(call_of(code, block, procedure_of(block.type)))],
    "own_return": lambda code, block: [GiveBack(f"return {show(code.slot(block, 'value'))}")],
    "append_text": _append_text,
    **LIST_STATEMENTS,
}
