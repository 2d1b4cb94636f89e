"""The values that an operation of a program had when it failed, read without running any code."""

from __future__ import annotations

import ast
import linecache
from itertools import islice
from types import FrameType, TracebackType

LONGEST = 40
"""Letters of a value in a sentence."""

_KINDS = {
    "int": "a number",
    "float": "a number",
    "str": "a text",
    "list": "a list",
    "tuple": "a list",
    "bool": "true or false",
    "NoneType": "nothing",
    "Robot": "a robot",
    "function": "a block",
    "method": "a block",
    "builtin_function_or_method": "a block",
}
OTHER_KIND = "something else"
_SIGNS: dict[type[ast.operator], str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.FloorDiv: "//",
    ast.Mod: "%",
    ast.Pow: "**",
}
_PLAIN = (int, float, str, bool, list, tuple, type(None))


class _Unknown(Exception):
    """A value that cannot be known without running code."""


def kind_of_type(name: str) -> str:
    """What a type of Python is called in plain words."""
    return _KINDS.get(name, OTHER_KIND)


def values_at(error: BaseException) -> dict[str, str]:
    """The parts of the operation that failed, by their places in sentences; {} when not known."""
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    try:
        return _values(_operation(trace), trace.tb_frame) if trace is not None else {}
    except (_Unknown, SyntaxError, ValueError, LookupError, RecursionError):
        return {}


def _operation(trace: TracebackType) -> ast.AST:
    """The expression (or the += statement) that failed."""
    code = trace.tb_frame.f_code
    place = next(islice(code.co_positions(), trace.tb_lasti // 2, None))
    line, last_line, begin, end = place
    if line is None or line != last_line or begin is None or end is None:
        raise _Unknown
    linecache.checkcache(code.co_filename)
    text = linecache.getline(code.co_filename, line, trace.tb_frame.f_globals).encode()
    node: ast.AST = ast.parse(text[begin:end].decode().strip()).body[0]
    return node.value if isinstance(node, ast.Expr) else node


def _values(node: ast.AST, frame: FrameType) -> dict[str, str]:
    match node:
        case ast.BinOp(left=left, op=sign, right=right):
            return _sides(left, right, frame) | {"sign": _SIGNS.get(type(sign), "?")}
        case ast.AugAssign(target=ast.Name() as left, op=sign, value=right):
            return _sides(left, right, frame) | {"sign": _SIGNS.get(type(sign), "?")}
        case ast.Compare(left=left, comparators=[right]):
            return _sides(left, right, frame)
        case ast.Subscript(value=items, slice=index):
            return _place(items, index, frame)
        case ast.Call(func=ast.Attribute(value=items, attr="pop"), args=[index]):
            return _place(items, index, frame)
    return {}


def _sides(left: ast.expr, right: ast.expr, frame: FrameType) -> dict[str, str]:
    first, second = _value(left, frame), _value(right, frame)
    return {
        "left": shown(first),
        "right": shown(second),
        "noun": kind_of_type(type(first).__name__),
        "result": kind_of_type(type(second).__name__),
    }


def _place(items: ast.expr, index: ast.expr, frame: FrameType) -> dict[str, str]:
    """Which item of what was asked for; counted from 1, as blocks do."""
    held, asked = _value(items, frame), _value(index, frame)
    if not isinstance(held, list | tuple | str) or type(asked) is not int:
        raise _Unknown
    number = {"number": str(asked + 1)} if asked >= 0 else {"number_from_end": str(-asked)}
    return {"name": ast.unparse(items), "count": str(len(held)), **number}


def _value(node: ast.expr, frame: FrameType) -> object:
    """What a simple expression holds; nothing of the program is run."""
    match node:
        case ast.Constant(value=value):
            return value
        case ast.Name(id=name):
            return _named(name, frame)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_number(operand, frame)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _number(left, frame) + _number(right, frame)
        case ast.BinOp(left=left, op=ast.Sub(), right=right):
            return _number(left, frame) - _number(right, frame)
        case ast.Call(func=ast.Name(id="int"), args=[inner], keywords=[]):
            return int(_number(inner, frame))
    raise _Unknown


def _number(node: ast.expr, frame: FrameType) -> int | float:
    value = _value(node, frame)
    if type(value) is int or type(value) is float:
        return value
    raise _Unknown


def _named(name: str, frame: FrameType) -> object:
    for names in (frame.f_locals, frame.f_globals):
        if name in names:
            value: object = names[name]
            if type(value) in _PLAIN:
                return value
    raise _Unknown


def shown(value: object) -> str:
    """A plain value on one line, clipped."""
    if isinstance(value, int) and not isinstance(value, bool) and value.bit_length() > LONGEST * 3:
        return "…"
    text = f'"{value[:LONGEST]}"' if isinstance(value, str) else repr(value)
    text = " ".join(text.split())
    return text if len(text) <= LONGEST + 2 else f"{text[:LONGEST]}…"
