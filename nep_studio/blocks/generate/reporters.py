"""The generator functions of reporters and booleans that are more than one call."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from nep_studio.blocks.program import Block
from nep_studio.blocks.slots import constant

from .expressions import (
    Body,
    Expressions,
    Function,
    Gap,
    Piece,
    StatementGenerator,
    ValueGenerator,
    call,
    compare,
    known_whole,
    method_call,
    plus,
    show,
    whole,
)
from .statements import LIST_REPORTERS, OWN_REPORTERS, plus_one

# The generator functions of blocks about numbers, texts and colours.

_OF_MATH = {"root": "sqrt", "ln": "log", "log10": "log10", "exp": "exp"}
_TESTS: dict[str, tuple[int | None, ast.cmpop, int]] = {
    "even": (2, ast.Eq(), 0),
    "odd": (2, ast.Eq(), 1),
    "whole": (1, ast.Eq(), 0),
    "positive": (None, ast.Gt(), 0),
    "negative": (None, ast.Lt(), 0),
}


def _function(code: Expressions, block: Block) -> ast.expr:
    name, number = code.choice(block, "function"), code.slot(block, "number")
    if name == "absolute":
        return call("abs", number)
    if name == "minus":
        return ast.UnaryOp(ast.USub(), number)
    if name == "pow10":
        return ast.BinOp(ast.Constant(10), ast.Pow(), number)
    return code.module_call("math", _OF_MATH[name], number)


def _trigonometry(code: Expressions, block: Block) -> ast.expr:
    radians = code.module_call("math", "radians", code.slot(block, "angle"))
    return code.module_call("math", code.choice(block, "function"), radians)


def _arc(code: Expressions, block: Block) -> ast.expr:
    radians = code.module_call("math", code.choice(block, "function"), code.slot(block, "number"))
    return code.module_call("math", "degrees", radians)


def _constant(code: Expressions, block: Block) -> ast.expr:
    name = code.choice(block, "constant")
    if name in ("pi", "e"):
        return code.module_value("math", name)
    if name == "golden":
        root = code.module_call("math", "sqrt", ast.Constant(5))
        return ast.BinOp(ast.BinOp(ast.Constant(1), ast.Add(), root), ast.Div(), ast.Constant(2))
    root = code.module_call("math", "sqrt", ast.Constant(2))
    return root if name == "root2" else ast.BinOp(root, ast.Div(), ast.Constant(2))


def _round(code: Expressions, block: Block) -> ast.expr:
    way, number = code.choice(block, "way"), code.slot(block, "number")
    if way == "nearest":
        return call("round", number)
    return code.module_call("math", "ceil" if way == "up" else "floor", number)


def _constrain(code: Expressions, block: Block) -> ast.expr:
    at_least = call("max", code.slot(block, "number"), code.slot(block, "low"))
    return call("min", at_least, code.slot(block, "high"))


def _of_list(code: Expressions, block: Block) -> ast.expr:
    name, items = code.choice(block, "function"), code.slot(block, "list")
    if name in ("sum", "min", "max"):
        return call(name, items)
    return code.module_call("statistics", name, items)


def _random_item(code: Expressions, block: Block) -> ast.expr:
    return code.module_call("random", "choice", code.slot(block, "list"))


def _number_is(code: Expressions, block: Block) -> ast.expr:
    number = code.slot(block, "number")
    divisor, sign, wanted = _TESTS[code.choice(block, "property")]
    left = number if divisor is None else _rest(number, ast.Constant(divisor))
    return compare(left, sign, ast.Constant(wanted))


def _divisible(code: Expressions, block: Block) -> ast.expr:
    rest = _rest(code.slot(block, "number"), code.slot(block, "divisor"))
    return compare(rest, ast.Eq(), ast.Constant(0))


def _rest(number: ast.expr, divisor: ast.expr) -> ast.expr:
    return ast.BinOp(number, ast.Mod(), divisor)


def _choose(code: Expressions, block: Block) -> ast.expr:
    return ast.IfExp(code.slot(block, "condition"), code.slot(block, "a"), code.slot(block, "b"))


def _text_is_empty(code: Expressions, block: Block) -> ast.expr:
    return compare(code.slot(block, "text"), ast.Eq(), ast.Constant(""))


def _text_contains(code: Expressions, block: Block) -> ast.expr:
    return compare(code.slot(block, "part"), ast.In(), code.slot(block, "text"))


def _text_find(code: Expressions, block: Block) -> ast.expr:
    return plus_one(method_call(code.slot(block, "text"), "find", [code.slot(block, "part")]))


def _letter(code: Expressions, block: Block) -> ast.expr:
    index = plus(whole(code.slot(block, "number")), -1)
    if (known := known_whole(index)) is not None and known < 0:
        index = ast.Constant(0)
    return ast.Subscript(code.slot(block, "text"), index)


def _text_case(code: Expressions, block: Block) -> ast.expr:
    return method_call(code.slot(block, "text"), code.choice(block, "case"))


def _text_replace(code: Expressions, block: Block) -> ast.expr:
    changed = [code.slot(block, "part"), code.slot(block, "new")]
    return method_call(code.slot(block, "text"), "replace", changed)


def _colour_from(code: Expressions, block: Block) -> ast.expr:
    parts = [code.slot(block, part) for part in ("red", "green", "blue")]
    return code.api_call("colour_from", *parts)


def _colour_mix(code: Expressions, block: Block) -> ast.expr:
    parts = [code.slot(block, part) for part in ("first", "second", "percent")]
    return code.api_call("mix_colours", *parts)


NUMBER_REPORTERS: dict[str, ValueGenerator] = {
    "number_function": _function,
    "trigonometry": _trigonometry,
    "arc": _arc,
    "constant": _constant,
    "round": _round,
    "constrain": _constrain,
    "random_fraction": lambda code, block: code.module_call("random", "random"),
    "of_list": _of_list,
    "random_item": _random_item,
    "number_is": _number_is,
    "divisible": _divisible,
    "choose": _choose,
    "text_length": lambda code, block: call("len", code.slot(block, "text")),
    "text_is_empty": _text_is_empty,
    "text_contains": _text_contains,
    "text_find": _text_find,
    "letter": _letter,
    "text_case": _text_case,
    "text_replace": _text_replace,
    "text_number": lambda code, block: call("float", code.slot(block, "text")),
    "colour": lambda code, block: code.slot(block, "colour"),
    "colour_from": _colour_from,
    "colour_mix": _colour_mix,
}


_OPERATIONS: dict[str, ast.operator] = {
    "add": ast.Add(),
    "subtract": ast.Sub(),
    "multiply": ast.Mult(),
    "divide": ast.Div(),
    "power": ast.Pow(),
    "remainder": ast.Mod(),
    "floor_divide": ast.FloorDiv(),
}
_COMPARISONS: dict[str, ast.cmpop] = {
    "equal": ast.Eq(),
    "not_equal": ast.NotEq(),
    "less": ast.Lt(),
    "less_or_equal": ast.LtE(),
    "greater": ast.Gt(),
    "greater_or_equal": ast.GtE(),
}


def _arithmetic(code: Expressions, block: Block) -> ast.expr:
    operation = _OPERATIONS[code.choice(block, "operation")]
    return ast.BinOp(code.slot(block, "a"), operation, code.slot(block, "b"))


def _random_integer(code: Expressions, block: Block) -> ast.expr:
    low, high = whole(code.slot(block, "low")), whole(code.slot(block, "high"))
    return code.module_call("random", "randint", low, high)


def _join(code: Expressions, block: Block) -> ast.expr:
    items = code.slots(block, "item", "item")
    joined = items[0]
    for item in items[1:]:
        joined = ast.BinOp(joined, ast.Add(), item)
    return joined


def _compare(code: Expressions, block: Block) -> ast.expr:
    sign = _COMPARISONS[code.choice(block, "comparison")]
    return ast.Compare(code.slot(block, "a"), [sign], [code.slot(block, "b")])


def _junction(code: Expressions, block: Block) -> ast.expr:
    word = ast.And() if code.choice(block, "junction") == "and" else ast.Or()
    values = [code.slot(block, "a"), code.slot(block, "b"), *code.slots(block, "c", "more")]
    return ast.BoolOp(word, values)


def _human_state_is(code: Expressions, block: Block) -> ast.expr:
    return ast.Compare(code.api_call("human_state"), [ast.Eq()], [code.slot(block, "state")])


REPORTERS: dict[str, ValueGenerator] = {
    "number": lambda code, block: code.slot(block, "number"),
    "text": lambda code, block: code.slot(block, "text"),
    "variable": lambda code, block: ast.Name(code.variable(block)),
    "arithmetic": _arithmetic,
    "random_integer": _random_integer,
    "join": _join,
    "compare": _compare,
    "junction": _junction,
    "not": lambda code, block: ast.UnaryOp(ast.Not(), code.slot(block, "a")),
    "truth": lambda code, block: ast.Constant(code.choice(block, "truth") == "true"),
    "human_state_is": _human_state_is,
    **LIST_REPORTERS,
    **NUMBER_REPORTERS,
    **OWN_REPORTERS,
}


# The generator functions of robot blocks that are more than one call.

ANSWER = "answer"
"""The name of what a robot was answered, in the function that asks."""


def field_text(code: Expressions, block: Block, key: str) -> str:
    """What the field of a slot holds, as a text."""
    return str(code.definition(block).value(block, key))


def _numbers(block: Block, group: str) -> Iterator[int]:
    yield from range(1, block.groups.get(group, 0) + 1)


def _ask(code: Expressions, block: Block) -> list[Piece]:
    words = code.slots(block, "word", "answer")
    arguments = [code.slot(block, "question"), ast.List(words)]
    seconds = {"seconds": code.slot(block, "seconds")}
    asked = show(method_call(code.slot(block, "robot"), "ask", arguments, seconds))
    pieces: list[Piece] = [f"{ANSWER} = {asked}"]
    for number, word in enumerate(words, start=1):
        test = show(ast.Compare(ast.Name(ANSWER), [ast.Eq()], [word]))
        pieces += [f"{'if' if number == 1 else 'elif'} {test}:", Body(f"do.{number}")]
    if block.groups.get("otherwise"):
        pieces += ["else:" if words else f"if not {ANSWER}:", Body("otherwise_do.1")]
    return pieces


def _wait_for_word(code: Expressions, block: Block) -> list[Piece]:
    others = code.slots(block, "other", "more")
    seconds = {"seconds": code.slot(block, "seconds")}
    arguments = [code.slot(block, "word"), *others]
    return [show(method_call(code.slot(block, "robot"), "wait_for_word", arguments, seconds))]


def _parts(code: Expressions, block: Block, name: str) -> list[Piece]:
    functions = [Function(code.part_name(), f"do.{number}") for number in _numbers(block, "part")]
    chosen = code.api_call(name, *(ast.Name(function.name) for function in functions))
    return [*functions, Gap(), show(chosen)]


def _until_state(code: Expressions, block: Block) -> list[Piece]:
    turns = code.api_call("until_state", code.slot(block, "state"))
    return [f"for _ in {show(turns)}:", Body("do", loop=True)]


def _until_state_at_most(code: Expressions, block: Block) -> list[Piece]:
    turns = code.api_call("until_state", code.slot(block, "state"), code.slot(block, "times"))
    return [f"for _ in {show(turns)}:", Body("do", loop=True)]


def _on_robot(method: str, *arguments: str) -> ValueGenerator:
    """The generator of a question to a robot: constants, and "{slot}" for what is in a slot."""

    def generate(code: Expressions, block: Block) -> ast.expr:
        given = [
            code.slot(block, argument[1:-1]) if argument.startswith("{") else constant(argument)
            for argument in arguments
        ]
        return method_call(code.slot(block, "robot"), method, given, {})

    return generate


def _emotion(code: Expressions, block: Block) -> ast.expr:
    state = ast.Constant(f"emotion_{code.choice(block, 'emotion')}")
    return code.api_call("was_seen", state, ast.Constant(EMOTION_S))


EMOTION_S = 3
"""How long a person looks so after a node has told it."""

ROBOT_STATEMENTS: dict[str, StatementGenerator] = {
    "ask": _ask,
    "wait_for_word": _wait_for_word,
    "one_of": lambda code, block: _parts(code, block, "one_of"),
    "in_turn": lambda code, block: _parts(code, block, "in_turn"),
    "until_state": _until_state,
    "until_state_at_most": _until_state_at_most,
}

ROBOT_REPORTERS: dict[str, ValueGenerator] = {
    "sees_face_of": _on_robot("sees", "face", "{name}"),
    "sees_mark": _on_robot("sees", "mark", "{number}"),
    "seen_face": _on_robot("seen_name", "face"),
    "seen_mark": _on_robot("seen_name", "mark"),
    "emotion": _emotion,
}
