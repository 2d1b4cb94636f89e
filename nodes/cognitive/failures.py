"""What went wrong in a user's program, in plain words, with its line and what to try."""

from __future__ import annotations

import ast
import linecache
import logging
import re
import traceback
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice
from types import FrameType, TracebackType
from typing import Any

from faults import Fault, Text, Words, fault_of, filled, told
from faults.files import read_toml
from nep_core.errors import NepError, NodeStartError
from nep_core.program.values import spoken_language
from nep_core.program.variables import variables_in
from nodes.resources import resource_folder

log = logging.getLogger(__name__)

# The values that an operation of a program had when it failed, read without running any code.

LONGEST = 40
"""Letters of a value in a sentence."""

_KINDS = {
    "int": "a number",
    "float": "a number",
    "str": "a text",
    "list": "a list",
    "tuple": "a list",
    "dict": "a table",
    "bool": "true or false",
    "NoneType": "nothing",
    "Robot": "a robot",
    **dict.fromkeys(("function", "method", "builtin_function_or_method"), "a block"),
}
OTHER_KIND = "something else"
_SIGNS: dict[type[ast.operator], str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "//", ast.Mod: "%",
    ast.Pow: "**",
}  # fmt: skip
_PLAIN = (int, float, str, bool, list, tuple, dict, type(None))


class _Unknown(Exception):
    """A value that cannot be known without running code."""


def kind_of_type(name: str) -> Text:
    """What a type of Python is called in plain words."""
    return Text(_KINDS.get(name, OTHER_KIND))


def values_at(error: BaseException) -> dict[str, Words]:
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
    line, last_line, begin, end = next(islice(code.co_positions(), trace.tb_lasti // 2, None))
    if line is None or line != last_line or begin is None or end is None:
        raise _Unknown
    linecache.checkcache(code.co_filename)
    text = linecache.getline(code.co_filename, line, trace.tb_frame.f_globals).encode()
    node: ast.AST = ast.parse(text[begin:end].decode().strip()).body[0]
    return node.value if isinstance(node, ast.Expr) else node


def _values(node: ast.AST, frame: FrameType) -> dict[str, Words]:
    match node:
        case (
            ast.BinOp(left=left, op=sign, right=right)
            | ast.AugAssign(target=ast.Name() | ast.Attribute() as left, op=sign, value=right)
        ):
            return _sides(left, right, frame) | {"sign": _SIGNS.get(type(sign), "?")}
        case ast.Compare(left=left, comparators=[right]):
            return _sides(left, right, frame)
        case (
            ast.Subscript(value=items, slice=index)
            | ast.Delete(targets=[ast.Subscript(value=items, slice=index)])
            | ast.Call(func=ast.Attribute(value=items, attr="pop"), args=[index])
        ):
            return _place(items, index, frame)
        case ast.Call(func=ast.Name(id="max" | "min"), args=[held]):
            return {"table": _in_words(held)} if isinstance(_value(held, frame), dict) else {}
    return {}


def _sides(left: ast.expr, right: ast.expr, frame: FrameType) -> dict[str, Words]:
    first, second = _value(left, frame), _value(right, frame)
    return {
        "left": shown(first),
        "right": shown(second),
        "noun": kind_of_type(type(first).__name__),
        "result": kind_of_type(type(second).__name__),
    }


def _place(items: ast.expr, index: ast.expr, frame: FrameType) -> dict[str, Words]:
    """Which item of what was asked for; counted from 1, as blocks do."""
    held, asked = _value(items, frame), _value(index, frame)
    if isinstance(held, dict):
        return {"name": _in_words(items), "value": shown(asked)}
    if isinstance(asked, str):
        return {"value": shown(asked)}
    if not isinstance(held, list | tuple | str) or type(asked) is not int:
        raise _Unknown
    number = {"number": str(asked + 1)} if asked >= 0 else {"number_from_end": str(-asked)}
    return {"name": _in_words(items), "count": str(len(held)), **number}


def _in_words(node: ast.expr) -> str:
    """What a list is called: a variable by the words of its name, as it has them in the blocks."""
    match node:
        case ast.Name(id=name) | ast.Attribute(value=ast.Name(), attr=name):
            return name.replace("_", " ").strip()
    return ast.unparse(node)


def _value(node: ast.expr, frame: FrameType) -> object:
    """What a simple expression holds; nothing of the program is run."""
    match node:
        case ast.Constant(value=value):
            return value
        case ast.Name(id=name):
            return _named(name, frame)
        case ast.Subscript(value=items, slice=index):
            return _kept(_value(items, frame), _value(index, frame))
        case ast.Attribute(value=ast.Name(id=owner), attr=name):
            return _of_program(owner, name, frame)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_number(operand, frame)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _number(left, frame) + _number(right, frame)
        case ast.BinOp(left=left, op=ast.Sub(), right=right):
            return _number(left, frame) - _number(right, frame)
        case ast.Call(func=ast.Name(id="int"), args=[inner], keywords=[]):
            return int(_number(inner, frame))
    raise _Unknown


def _kept(items: Any, key: object) -> object:
    """What a list or a table has at a place; LookupError where there is nothing."""
    if type(items) not in (list, tuple, dict) or type(key) not in (str, int, float, bool):
        raise _Unknown
    if type(found := items[key]) in _PLAIN:
        return found
    raise _Unknown


def _number(node: ast.expr, frame: FrameType) -> int | float:
    value = _value(node, frame)
    if type(value) is int or type(value) is float:
        return value
    raise _Unknown


def _named(name: str, frame: FrameType) -> object:
    for names in (frame.f_locals, frame.f_globals):
        if name in names and type(names[name]) in _PLAIN:
            return names[name]
    raise _Unknown


def _of_program(owner: str, name: str, frame: FrameType) -> object:
    """What a variable of the whole program holds."""
    held = variables_in(frame.f_globals.get(owner))
    if name in held and type(held[name]) in _PLAIN:
        return held[name]
    raise _Unknown


def shown(value: object) -> str:
    """A plain value on one line, clipped."""
    if isinstance(value, int) and not isinstance(value, bool) and value.bit_length() > LONGEST * 3:
        return "…"
    text = f'"{value[:LONGEST]}"' if isinstance(value, str) else repr(value)
    text = " ".join(text.split())
    return text if len(text) <= LONGEST + 2 else f"{text[:LONGEST]}…"


# The sentences for what can go wrong in a program, with places for values, and what to try.

LOOK = "Look at the block that is marked: what does it get?"
SHOW_VALUES = "Run again and watch the values of the variables."
CONVERT = "Turn the text into a number, or the number into a text, with a block that does that."
ASK_LENGTH = "Ask first how many items there are, and take only those."
ASK_EMPTY = "Ask first whether the list is empty."
CHECK_LIST = "Check what the list holds at that moment."
CHECK_NUMBER = "Check the number: the first item is number 1."
GIVE_FIRST = "Give the variable a value where the program starts."
ASK_FIRST = "Ask first whether the table has it."
TAKE_OTHERWISE = "Or take the block that says what to give if it is not there."
USE_NAME = "Use a text or a number as the name of what is kept."
CHECK_NAME = "Check the spelling of the name."
TEST_ZERO = "Ask with an “if” whether it is zero before you divide."
CHECK_RANGE = "Check that the first number is not larger than the second."
TYPE_NUMBER = "Write digits only, with a dot where it is not whole."
STOP_GROWING = "Look for a loop that makes the number larger and larger."
CHECK_END = "Look for an own block that runs itself and never stops to do so."
CHECK_CODE = "Check the Python that was written by hand in this line."
NO_NAN = "Check the calculation that the number comes from."


@dataclass(frozen=True)
class Explanation:
    """What to say about an error: of this type, if what Python says about it is like ``pattern``.

    A place in the sentence is a group of the pattern, or a value of the line that failed; where
    that is not known, a later sentence is taken.
    """

    error: type[BaseException]
    pattern: str
    sentence: str
    steps: tuple[str, ...]


_FORMATS = r"format|not all arguments converted"
"""What Python says of a text before %, which puts values into a text there."""

_SUMS = r"unsupported operand|can only concatenate|can't multiply sequence"

SENTENCES = (
    Explanation(
        ZeroDivisionError, "", "A number was divided by zero.", (LOOK, TEST_ZERO, SHOW_VALUES)
    ),
    Explanation(
        NameError,
        r"'(?P<name>\w+)'",
        'Something called "{name}" was used before it had a value.',
        (GIVE_FIRST, CHECK_NAME),
    ),
    Explanation(
        AttributeError,
        r"'(?:Variables|Kept)' object has no attribute '(?P<name>\w+)'",
        'Something called "{name}" was used before it had a value.',
        (GIVE_FIRST, CHECK_NAME),
    ),
    Explanation(
        IndexError,
        "string index out of range",
        "The text “{name}” has {count} letters, and letter {number} was asked for.",
        (CHECK_NUMBER, ASK_LENGTH),
    ),
    Explanation(
        IndexError,
        "string index out of range",
        "A letter was asked for that the text does not have.",
        (CHECK_NUMBER, ASK_LENGTH),
    ),
    Explanation(
        IndexError,
        "",
        "The list “{name}” has {count} items, and item {number} was asked for.",
        (CHECK_NUMBER, CHECK_LIST, ASK_LENGTH),
    ),
    Explanation(
        IndexError,
        "",
        "The list “{name}” has {count} items, and item {number_from_end} from the end was asked "
        "for.",
        (CHECK_NUMBER, CHECK_LIST, ASK_LENGTH),
    ),
    Explanation(
        IndexError,
        "empty (list|sequence|range)",
        "Something was taken from an empty list.",
        (ASK_EMPTY, CHECK_LIST),
    ),
    Explanation(
        IndexError,
        "",
        "An item was asked for that the list does not have.",
        (CHECK_NUMBER, CHECK_LIST, ASK_LENGTH),
    ),
    Explanation(
        KeyError,
        "",
        "The table “{name}” has nothing at {value}.",
        (ASK_FIRST, TAKE_OTHERWISE),
    ),
    Explanation(
        KeyError,
        "(?P<text>.+)",
        "Nothing is kept under the name {text}.",
        (CHECK_NAME, "Keep something under this name first."),
    ),
    Explanation(
        TypeError,
        _SUMS,
        "This cannot be worked out: {left} {sign} {right}. On the left is {noun}, on the right "
        "{result}.",
        (LOOK, CONVERT),
    ),
    Explanation(
        TypeError,
        _FORMATS,
        "This cannot be worked out: {left} {sign} {right}. On the left is {noun}, on the right "
        "{result}.",
        (LOOK, CONVERT),
    ),
    Explanation(
        ValueError,
        _FORMATS,
        "This cannot be worked out: {left} {sign} {right}. On the left is {noun}, on the right "
        "{result}.",
        (LOOK, CONVERT),
    ),
    Explanation(
        TypeError,
        r"unsupported operand .*: '(?P<noun>\w+)' and '(?P<result>\w+)'",
        "This cannot be worked out: on the left is {noun}, on the right {result}.",
        (LOOK, CONVERT),
    ),
    Explanation(
        TypeError,
        r"can only concatenate (?P<noun>\w+) \(not \"(?P<result>\w+)\"\)",
        "This cannot be worked out: on the left is {noun}, on the right {result}.",
        (LOOK, CONVERT),
    ),
    Explanation(
        TypeError,
        "not supported between",
        "It cannot be told which is larger, {left} or {right}: one is {noun}, the other {result}.",
        (LOOK, CONVERT),
    ),
    Explanation(
        TypeError,
        r"not supported between instances of '(?P<noun>\w+)' and '(?P<result>\w+)'",
        "It cannot be told which is larger: one is {noun}, the other {result}.",
        (LOOK, CONVERT),
    ),
    Explanation(
        TypeError,
        r"unhashable type: '(?P<noun>\w+)'",
        "Nothing can be kept under {noun}.",
        (LOOK, USE_NAME),
    ),
    Explanation(
        TypeError,
        "not subscriptable|support item|indices must be integers",
        "There is no table here that could have {value}.",
        (LOOK, "Put a table into this place."),
    ),
    Explanation(
        TypeError,
        r"(list|string|tuple) indices must be integers.* not '?str",
        "A table belongs here, and this is something else.",
        (LOOK, "Put a table into this place."),
    ),
    Explanation(
        TypeError,
        r"'(?P<noun>\w+)' object is not (iterable|subscriptable|reversible)|"
        r"object of type '(?P<result>\w+)' has no len|"
        r"object (does not|doesn't) support item",
        "A list belongs here, and this is something else.",
        (LOOK, "Put a list into this place."),
    ),
    Explanation(
        TypeError,
        r"argument .* must be .*number.*not|must be real number, not (?P<noun>\w+)|"
        r"cannot be interpreted as an integer|bad operand type|doesn't define __round__",
        "A number belongs here, and this is something else.",
        (LOOK, CONVERT),
    ),
    Explanation(
        TypeError,
        r"(?P<name>\w+)\(\) (missing|takes|got)",
        "“{name}” did not get the values that it needs.",
        (LOOK, "Fill every place of this block."),
    ),
    Explanation(
        TypeError,
        r"'(?P<noun>\w+)' object is not callable",
        "This was used like a block, but it is {noun}.",
        (CHECK_NAME, CHECK_CODE),
    ),
    Explanation(
        TypeError,
        "",
        "Texts and numbers were mixed where only one kind fits ({said}).",
        (LOOK, CONVERT),
    ),
    Explanation(
        ValueError,
        r"(?:could not convert string to float|invalid literal for int.*): '(?P<text>.*)'",
        "The text “{text}” is not a number.",
        (TYPE_NUMBER, "Ask with an “if” what the text is, before it is turned into a number."),
    ),
    Explanation(
        ValueError,
        "math domain error|expected a (positive|nonnegative) (input|number)|expected a number",
        "This has no result for that number, such as the root of a number below zero.",
        (LOOK, SHOW_VALUES),
    ),
    Explanation(
        ValueError,
        "empty range",
        "No number lies between the two: the first is larger than the second.",
        (CHECK_RANGE, SHOW_VALUES),
    ),
    Explanation(
        ValueError,
        r"range\(\) arg 3 must not be zero|slice step cannot be zero",
        "Counting in steps of zero never ends.",
        ("Make the step 1, or any number that is not zero.",),
    ),
    Explanation(
        ValueError,
        "empty separator",
        "A text is parted at a mark, and this mark is empty.",
        (LOOK,),
    ),
    Explanation(
        ValueError,
        "is not in list|not in tuple|x not in list",
        "The list does not have what was looked for.",
        ("Ask first whether the list has it.", CHECK_LIST),
    ),
    Explanation(
        ValueError,
        r"empty sequence|is empty",
        "The table “{table}” is empty: no value in it is the largest or the smallest.",
        ("Ask first whether the table is empty.", SHOW_VALUES),
    ),
    Explanation(
        ValueError,
        r"empty (sequence|iterable|list|data|range)|is empty|at least (one|two)|no median",
        "There is no result for a list that has too few items.",
        (ASK_EMPTY, CHECK_LIST),
    ),
    Explanation(
        ValueError,
        "NaN|integer string conversion",
        "A number cannot be written: it is too long, or it is no number at all.",
        (STOP_GROWING, NO_NAN),
    ),
    Explanation(ValueError, "", "A value did not fit: {said}.", (LOOK, SHOW_VALUES)),
    Explanation(
        AttributeError,
        r"'(?P<noun>\w+)' object has no attribute '(?P<name>\w+)'",
        "This has no “{name}”: it is {noun}.",
        (CHECK_NAME, LOOK),
    ),
    Explanation(OverflowError, "", "A number became too large.", (STOP_GROWING, SHOW_VALUES)),
    Explanation(RecursionError, "", "The program called itself too many times.", (CHECK_END,)),
    Explanation(
        MemoryError,
        "",
        "The program needs more memory than there is.",
        ("Look for a loop that makes a list or a text longer and longer.",),
    ),
    Explanation(
        ModuleNotFoundError,
        r"'(?P<name>[\w.]+)'",
        "The Python package “{name}” is not installed.",
        (CHECK_NAME, "Install it for the Python that runs the program."),
    ),
    Explanation(
        ImportError,
        r"cannot import name '(?P<name>\w+)'",
        "“{name}” cannot be imported: there is nothing of that name.",
        (CHECK_NAME,),
    ),
    Explanation(
        FileNotFoundError,
        r"'(?P<text>.*)'",
        "There is no file “{text}”.",
        ("Check the name of the file, and the folder that it is in.",),
    ),
    Explanation(
        PermissionError,
        r"'(?P<text>.*)'",
        "The file “{text}” may not be used.",
        ("Choose another folder, such as Documents.", "Close other programs that use the file."),
    ),
    Explanation(SystemExit, "", "The program ended itself with: {said}.", (CHECK_CODE,)),
    Explanation(SyntaxError, "", "The program is not Python that can run: {said}.", (CHECK_CODE,)),
)
"""The first that fits is said."""

OTHER = Explanation(BaseException, "", "{error}: {said}.", (LOOK, SHOW_VALUES))
"""For everything else."""


class ProgramFailed(NepError):
    """The user's program ended with an error."""

    title = "The program stopped with an error"


def failure_of(error: BaseException) -> Fault:
    """What a person should read about an error of a program."""
    if isinstance(error, NepError):
        return error.fault
    values = values_at(error)
    fitting = (_filled(told, error, values) for told in (*SENTENCES, OTHER))
    return next(failure for failure in fitting if failure is not None)


def _filled(told: Explanation, error: BaseException, values: Mapping[str, Words]) -> Fault | None:
    """A sentence with its values; None when it is of another error, or a value is not known."""
    said = re.search(told.pattern, _words(error)) if isinstance(error, told.error) else None
    if said is None:
        return None
    known: dict[str, Words] = {"error": type(error).__name__, "said": _words(error).rstrip(".")}
    known |= {**values, **_groups(said)}
    if isinstance(error, NameError) and error.name:
        known["name"] = error.name
    places = re.findall(r"\{(\w+)\}", told.sentence)
    if not known.keys() >= set(places):
        return None
    code = f"python:{type(error).__name__}"
    return fault_of(
        told.sentence, code=code, checklist=told.steps, **{name: known[name] for name in places}
    )


def _words(error: BaseException) -> str:
    """What Python says about an error, on one line."""
    if isinstance(error, SyntaxError):
        return error.msg
    if isinstance(error, SystemExit):
        return str(error.code)
    return " ".join(str(error).split()) or type(error).__name__


def _groups(said: re.Match[str]) -> dict[str, Words]:
    """The values in what Python says; names of its types become words."""
    return {
        name: kind_of_type(text) if name in ("noun", "result") else text
        for name, text in said.groupdict().items()
        if text is not None
    }


def line_of(error: BaseException, file: str) -> int:
    """The line of ``file`` in which the error happened, from 1; 0 when it was elsewhere."""
    if isinstance(error, SyntaxError) and error.filename == file:
        return error.lineno or 0
    frames = reversed(traceback.extract_tb(error.__traceback__))
    return next((frame.lineno or 0 for frame in frames if frame.filename == file), 0)


# The words of errors in the language in which the program tells values.


def in_spoken_language(text: Words, /, **values: object) -> str:
    """Return the words of a text, or of a template and its values; in English where none are."""
    if isinstance(text, Text):
        return told(text, in_spoken_language)
    return filled(_messages(spoken_language()).get(text, text), values, in_spoken_language)


@lru_cache(maxsize=2)
def _messages(language: str) -> dict[str, str]:
    """The sentences of a language by the English ones; none for English."""
    if language == "en":
        return {}
    try:
        table = read_toml(resource_folder() / "translations" / f"{language}.toml")
    except (OSError, ValueError, RecursionError, NodeStartError):
        log.warning("the words of %s cannot be read", language, exc_info=True)
        return {}
    return {**table.get("window", {}), **table.get("messages", {})}
