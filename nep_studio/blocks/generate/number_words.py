"""The generator functions of blocks about numbers, texts and colours."""

from __future__ import annotations

import ast

from ..program import Block
from .expressions import Expressions, ValueGenerator
from .list_words import plus_one
from .nodes import call, compare, known_whole, method_call, plus, whole

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


def _random_fraction(code: Expressions, block: Block) -> ast.expr:
    return code.module_call("random", "random")


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


def _text_length(code: Expressions, block: Block) -> ast.expr:
    return call("len", code.slot(block, "text"))


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


def _text_number(code: Expressions, block: Block) -> ast.expr:
    return call("float", code.slot(block, "text"))


def _colour(code: Expressions, block: Block) -> ast.expr:
    return code.slot(block, "colour")


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
    "random_fraction": _random_fraction,
    "of_list": _of_list,
    "random_item": _random_item,
    "number_is": _number_is,
    "divisible": _divisible,
    "choose": _choose,
    "text_length": _text_length,
    "text_is_empty": _text_is_empty,
    "text_contains": _text_contains,
    "text_find": _text_find,
    "letter": _letter,
    "text_case": _text_case,
    "text_replace": _text_replace,
    "text_number": _text_number,
    "colour": _colour,
    "colour_from": _colour_from,
    "colour_mix": _colour_mix,
}
