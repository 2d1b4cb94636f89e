"""The generator functions of values and statements: the Python of blocks that are no plain call.

Most values are a line of Python with the names of slots in it. Statements give pieces in order:
lines, bodies (the chain of blocks in a slot, one step further in), and functions (a body of its
own, for what runs at the same time).
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from operator import itemgetter
from typing import Any

from nep_studio.blocks.code_text import CodeText, read_lines, read_value
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.procedures import parameter_of, parameters, procedure_of
from nep_studio.blocks.program import Block
from nep_studio.blocks.slots import constant

from .expressions import (
    Assignment,
    Body,
    EndRule,
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
    refusing,
    show,
    whole,
)
from .names import API, MODULES

# Values that are one line of Python.


def _python(text: str) -> ValueGenerator:
    """The generator of an expression in which the names of slots stand for what is in them.

    What is in ``whole(...)`` becomes a whole number. Modules, and functions of nep_core, are
    noted for the import.
    """
    template = ast.parse(text, mode="eval").body
    named = [node for node in ast.walk(template) if isinstance(node, ast.Name)]
    functions = [node.func for node in ast.walk(template) if isinstance(node, ast.Call)]
    modules = MODULES.intersection(name.id for name in named)
    api = API.intersection(name.id for name in named)
    names = [node.id for node in named if node not in functions]
    slots = list(dict.fromkeys(name for name in names if name not in (*MODULES, "str")))
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
        if function.id == "whole":
            return lambda filled: whole(*arguments(filled))
        return lambda filled: ast.Call(function, arguments(filled), [])
    kind, parts = type(part), [_maker(getattr(part, name), slots) for name in part._fields]
    return lambda filled: kind(*[make(filled) for make in parts])


def _by_choice(slot: str, texts: dict[str, str]) -> ValueGenerator:
    """The generator of one of several expressions, by what is chosen in a slot."""
    generators = {choice: _python(text) for choice, text in texts.items()}
    return lambda code, block: generators[code.choice(block, slot)](code, block)


_LINES = {
    "number": "number",
    "random_integer": "random.randint(whole(low), whole(high))",
    "random_fraction": "random.random()",
    "random_item": "random.choice(list)",
    "constrain": "min(max(number, low), high)",
    "divisible": "number % divisor == 0",
    "choose": "a if condition else b",
    "not": "not a",
    "human_state_is": "human_state() == state",
    "text": "text",
    "text_length": "len(text)",
    "text_is_empty": 'text == ""',
    "text_contains": "part in text",
    "text_find": "text.find(part) + 1",
    "text_replace": "text.replace(part, new)",
    "text_number": "float(text)",
    "colour": "colour",
    "colour_from": "colour_from(red, green, blue)",
    "colour_mix": "mix_colours(first, second, percent)",
    "list_filled": "[item] * whole(times)",
    "list_length": "len(list)",
    "list_is_empty": "len(list) == 0",
    "list_contains": "item in list",
    "list_find": "list.index(item) + 1 if item in list else 0",
    "list_reversed": "list(reversed(list))",
    "list_joined": "mark.join(map(str, list))",
    "sees_face_of": 'robot.sees("face", name)',
    "sees_mark": 'robot.sees("mark", number)',
    "seen_face": 'robot.seen_name("face")',
    "seen_mark": 'robot.seen_name("mark")',
}
_CHOSEN = {
    "arithmetic": (
        "operation",
        {
            "add": "a + b",
            "subtract": "a - b",
            "multiply": "a * b",
            "divide": "a / b",
            "power": "a ** b",
            "remainder": "a % b",
            "floor_divide": "a // b",
        },
    ),
    "compare": (
        "comparison",
        {
            "equal": "a == b",
            "not_equal": "a != b",
            "less": "a < b",
            "less_or_equal": "a <= b",
            "greater": "a > b",
            "greater_or_equal": "a >= b",
        },
    ),
    "number_function": (
        "function",
        {
            "absolute": "abs(number)",
            "root": "math.sqrt(number)",
            "minus": "-number",
            "ln": "math.log(number)",
            "log10": "math.log10(number)",
            "exp": "math.exp(number)",
            "pow10": "10 ** number",
        },
    ),
    "trigonometry": (
        "function",
        {name: f"math.{name}(math.radians(angle))" for name in ("sin", "cos", "tan")},
    ),
    "arc": (
        "function",
        {name: f"math.degrees(math.{name}(number))" for name in ("asin", "acos", "atan")},
    ),
    "constant": (
        "constant",
        {
            "pi": "math.pi",
            "e": "math.e",
            "golden": "(1 + math.sqrt(5)) / 2",
            "root2": "math.sqrt(2)",
            "root_half": "math.sqrt(2) / 2",
        },
    ),
    "round": (
        "way",
        {"nearest": "round(number)", "up": "math.ceil(number)", "down": "math.floor(number)"},
    ),
    "number_is": (
        "property",
        {
            "even": "number % 2 == 0",
            "odd": "number % 2 == 1",
            "whole": "number % 1 == 0",
            "positive": "number > 0",
            "negative": "number < 0",
        },
    ),
    "of_list": (
        "function",
        {name: f"{name}(list)" for name in ("sum", "min", "max")}
        | {name: f"statistics.{name}(list)" for name in ("mean", "median", "stdev")},
    ),
    "truth": ("truth", {"true": "True", "false": "False"}),
    "text_case": ("case", {name: f"text.{name}()" for name in ("upper", "lower", "title")}),
}


# Other values.


def _join(code: Expressions, block: Block) -> ast.expr:
    joined, *items = code.slots(block, "item", "item")
    for item in items:
        joined = ast.BinOp(joined, ast.Add(), item)
    return joined


def _junction(code: Expressions, block: Block) -> ast.expr:
    word = ast.And() if code.choice(block, "junction") == "and" else ast.Or()
    values = [code.slot(block, "a"), code.slot(block, "b"), *code.slots(block, "c", "more")]
    return ast.BoolOp(word, values)


def _letter(code: Expressions, block: Block) -> ast.expr:
    index = plus(whole(code.slot(block, "number")), -1)
    if (known := known_whole(index)) is not None and known < 0:
        index = ast.Constant(0)
    return ast.Subscript(code.slot(block, "text"), index)


def _emotion(code: Expressions, block: Block) -> ast.expr:
    state = ast.Constant(f"emotion_{code.choice(block, 'emotion')}")
    return code.api_call("was_seen", state, ast.Constant(EMOTION_S))


EMOTION_S = 3
"""How long a person looks so after a node has told it."""


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


def _index(code: Expressions, block: Block) -> ast.expr:
    """Item 1 from the start is item 0 of Python, item 1 from the end is item -1."""
    number = whole(code.slot(block, "number"))
    return plus(number, -1) if code.choice(block, "end") == "start" else _minus(number)


def _minus(number: ast.expr) -> ast.expr:
    known = known_whole(number)
    return ast.UnaryOp(ast.USub(), number) if known is None else constant(-known)


# The Python of own blocks and of code that a person wrote: calls, parameters, the names in it.


def _own_call(code: Expressions, block: Block) -> ast.expr:
    procedure_id = procedure_of(block.type)
    if procedure_id not in code.names.procedures:
        raise CodeRefused(
            "This own block has no definition.",
            block=block.id,
            checklist=("Put its “define” block onto a page again.", "Or take this block out."),
        )
    procedure = code.project.procedures[procedure_id]
    arguments = [code.slot(block, parameter.id) for parameter in parameters(procedure)]
    return call(code.names.procedures[procedure_id], *arguments)


def _own_parameter(code: Expressions, block: Block) -> ast.expr:
    if procedure_of(block.type) != code.procedure:
        raise CodeRefused(
            "This value is known only inside the definition of its own block.",
            block=block.id,
            checklist=("Move it under the “define” block that it comes from.",),
        )
    return ast.Name(code.names.parameters[f"{code.procedure}.{parameter_of(block.type)}"])


def _code_value(code: Expressions, block: Block) -> ast.expr:
    with refusing(block):
        read = read_value(code.text(block, "code"))
    note_names(code, read)
    return Verbatim(read.lines[0], is_closed=read.is_closed)


def _code_lines(code: Expressions, block: Block) -> list[Piece]:
    with refusing(block):
        read = read_lines(code.text(block, "code"))
    note_names(code, read)
    assigned = read.set_here & frozenset(code.names.variables.values())
    written = Written(read.lines, read.inside_texts, assigned)
    return [written, "pass"] if read.is_empty else [written]


def note_names(code: Expressions, read: CodeText) -> None:
    """Note what written code names, so that it is there."""
    named = read.read | read.made
    for variable_id, name in code.names.variables.items():
        if name in named:
            code.variables[variable_id]  # a variable that is used is there
    code.robots.update(robot for robot, name in code.names.robots.items() if name in read.read)
    code.api.update(API & read.read - read.made)
    code.modules.update(MODULES & read.read - read.made)


REPORTERS: dict[str, ValueGenerator] = {
    **{name: _python(text) for name, text in _LINES.items()},
    **{name: _by_choice(slot, texts) for name, (slot, texts) in _CHOSEN.items()},
    "variable": lambda code, block: ast.Name(code.variable(block)),
    "join": _join,
    "junction": _junction,
    "letter": _letter,
    "emotion": _emotion,
    "list_create": lambda code, block: ast.List(code.slots(block, "item", "item")),
    "list_get": _get,
    "list_take": _take,
    "list_part": _part,
    "list_sorted": _sorted,
    "list_split": _split,
    "own_call": _own_call,
    "own_parameter": _own_parameter,
    "code_value": _code_value,
}


# Statements.

ANSWER = "answer"
"""The name of what a robot was answered, in the function that asks."""

_NO_ARGUMENTS = ast.arguments([], [], None, [], [], None, [])


def _loop(word: str, text: str) -> StatementGenerator:
    """The generator of a loop around the blocks in slot ``do``."""
    value = _python(text)
    return lambda code, block: [f"{word} {show(value(code, block))}:", Body("do", loop=True)]


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
    held = code.plugged(block, "list")
    if held is not None and isinstance(items, ast.Name):
        variable = str(held.fields.get("variable", ""))
        if code.sharing.changes(variable):  # the items that it had when the loop began
            items = ast.Subscript(items, ast.Slice())
    return [Assignment(name, f"for {name} in {show(items)}:"), Body("do", loop=True)]


def _assign(sign: str, slot: str, *, begins_as: str = "") -> StatementGenerator:
    """The generator of what puts a value into a variable, or adds it there."""

    def generate(code: Expressions, block: Block) -> list[Piece]:
        if begins_as:
            code.begins_as(block, begins_as)
        name = code.variable(block)
        return [Assignment(name, f"{name} {sign} {show(code.slot(block, slot))}")]

    return generate


def _if(code: Expressions, block: Block) -> list[Piece]:
    pieces: list[Piece] = [f"if {show(code.slot(block, 'condition'))}:", Body("do")]
    for number in range(1, block.groups.get("also", 0) + 1):
        condition = show(code.slot(block, f"also_condition.{number}"))
        pieces += [f"elif {condition}:", Body(f"also_do.{number}")]
    if block.groups.get("otherwise"):
        pieces += ["else:", Body("otherwise_do.1")]
    return pieces


def _parts(function: str) -> StatementGenerator:
    """The generator of what gives the parts of a block, as functions, to one of nep_core."""

    def generate(code: Expressions, block: Block) -> list[Piece]:
        numbers = range(1, block.groups.get("part", 0) + 1)
        functions = [Function(code.part_name(), f"do.{number}") for number in numbers]
        chosen = code.api_call(function, *(ast.Name(part.name) for part in functions))
        return [*functions, Gap(), show(chosen)]

    return generate


def _wait_until(code: Expressions, block: Block) -> list[Piece]:
    condition: ast.expr = ast.Lambda(_NO_ARGUMENTS, code.slot(block, "condition"))
    limit = [code.slot(block, "seconds.1")] if block.groups.get("limit") else []
    return [show(code.api_call("wait_until", condition, *limit))]


def _set_item(code: Expressions, block: Block) -> list[Piece]:
    return [f"{show(_get(code, block))} = {show(code.slot(block, 'value'))}"]


def _insert(code: Expressions, block: Block) -> list[Piece]:
    items, value = code.slot(block, "list"), code.slot(block, "value")
    number = whole(code.slot(block, "number"))
    if code.choice(block, "end") == "start":
        return [show(method_call(items, "insert", [plus(number, -1), value]))]
    if known_whole(number) == 1:
        return [show(method_call(items, "append", [value]))]
    return [show(method_call(items, "insert", [plus(_minus(number), 1), value]))]


def _ask(code: Expressions, block: Block) -> list[Piece]:
    words = code.slots(block, "word", "answer")
    arguments = [code.slot(block, "question"), ast.List(words)]
    seconds = {"seconds": code.slot(block, "seconds")}
    asked = show(method_call(code.slot(block, "robot"), "ask", arguments, seconds))
    pieces: list[Piece] = [f"{ANSWER} = {asked}"]
    for number, word in enumerate(words, start=1):
        test = show(compare(ast.Name(ANSWER), ast.Eq(), word))
        pieces += [f"{'if' if number == 1 else 'elif'} {test}:", Body(f"do.{number}")]
    if block.groups.get("otherwise"):
        pieces += ["else:" if words else f"if not {ANSWER}:", Body("otherwise_do.1")]
    return pieces


def _wait_for_word(code: Expressions, block: Block) -> list[Piece]:
    others = code.slots(block, "other", "more")
    seconds = {"seconds": code.slot(block, "seconds")}
    arguments = [code.slot(block, "word"), *others]
    return [show(method_call(code.slot(block, "robot"), "wait_for_word", arguments, seconds))]


_ADD = _python("list.append(value)")

STATEMENTS: dict[str, StatementGenerator] = {
    "repeat": _loop("for _ in", "range(whole(times))"),
    "forever": _loop("while", "True"),
    "while": _loop("while", "condition"),
    "repeat_until": _loop("while", "not condition"),
    "until_state": _loop("for _ in", "until_state(state)"),
    "until_state_at_most": _loop("for _ in", "until_state(state, times)"),
    "count": _count,
    "for_each": _for_each,
    "leave_loop": lambda code, block: [Leave("break")],
    "next_round": lambda code, block: [Leave("continue")],
    "stop_rule": lambda code, block: [EndRule()],
    "if": _if,
    "together": _parts("together"),
    "one_of": _parts("one_of"),
    "in_turn": _parts("in_turn"),
    "wait_until": _wait_until,
    "set_variable": _assign("=", "value"),
    "change_variable": _assign("+=", "amount"),
    "append_text": _assign("+=", "text", begins_as="text"),
    "list_add": lambda code, block: [show(_ADD(code, block))],
    "list_set": _set_item,
    "list_insert": _insert,
    "list_remove": lambda code, block: [f"del {show(_get(code, block))}"],
    "ask": _ask,
    "wait_for_word": _wait_for_word,
    "note": lambda code, block: [*comment_lines(code.text(block, "text"))],
    "code_lines": _code_lines,
    "own_call": lambda code, block: [show(_own_call(code, block))],
    "own_return": lambda code, block: [GiveBack(f"return {show(code.slot(block, 'value'))}")],
}
