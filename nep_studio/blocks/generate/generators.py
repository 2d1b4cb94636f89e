"""The generator functions of values and statements: the Python of blocks that are no plain call.

Most values are a line of Python with the names of slots in it. Statements give pieces in order:
lines, bodies (the chain of blocks in a slot, one step further in), and functions (a body of its
own, for what runs at the same time).
"""

from __future__ import annotations

import ast
from collections.abc import Sequence
from functools import reduce

from nep_studio.blocks.code_text import CodeText, read_lines, read_value
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.procedures import parameter_of, parameters, procedure_of
from nep_studio.blocks.program import Block, Parameter
from nep_studio.blocks.slots import constant

from .behaviour import BEHAVIOUR_STATEMENTS, BEHAVIOUR_VALUES
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
    is_told,
    known_whole,
    may_swap,
    method_call,
    refusing,
    show,
    takes_items,
)
from .kinds import (
    NUMBER,
    ROBOT,
    TABLE,
    TEXT,
    TRUTH,
    WHOLE,
    are,
    are_mixed,
    kinds_of,
    kinds_of_code,
    note,
    parameter_key,
    result_key,
)
from .lists import LIST_STATEMENTS, LIST_VALUES
from .names import API, MODULES
from .plans import FACT_LINES, FACT_VALUES
from .positions import index_of, is_length_of, one_less, one_more
from .tables import TABLE_STATEMENTS, TABLE_VALUES
from .templates import by_choice, python_of
from .trees import TREE_PARTS

# Values that are one line of Python.


_LINES = {
    "number": "number",
    "random_fraction": "random.random()",
    "constrain": "min(max(number, low), high)",
    "divisible": "number % divisor == 0",
    "choose": "a if condition else b",
    "human_state_is": "human_state() == state",
    "robot": "robot",
    "text": "text",
    "text_number": "number_in(text)",
    "colour": "colour",
    "colour_from": "colour_from(red, green, blue)",
    "colour_mix": "mix_colours(first, second, percent)",
    "list_length": "len(list)",
    "list_is_empty": "len(list) == 0",
    "list_find": "place_of(item, list)",
    "list_reversed": "list(reversed(list))",
    "list_copy": "list(list)",
    "table_length": "len(table)",
    "table_is_empty": "len(table) == 0",
    "table_values": "list(table.values())",
    "table_copy": "dict(table)",
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
            "remainder": "a % b",
            "floor_divide": "a // b",
            "power": "to_power(a, b)",
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
            "pow10": "to_power(10, number)",
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
        {"nearest": "to_nearest(number)", "up": "math.ceil(number)", "down": "math.floor(number)"},
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
    "truth": ("truth", {"true": "True", "false": "False"}),
    "text_case": (
        "case",
        {"upper": "text.upper()", "lower": "text.lower()", "title": "title_case(text)"},
    ),
}


# Values whose Python depends on what is known of the kinds of what they get: plain Python where
# it does what the block says, else a function of nep_core with the slots in the same order.


def _join(code: Expressions, block: Block) -> ast.expr:
    keys = [f"item.{number}" for number in range(1, block.groups.get("item", 0) + 1)]
    items = [code.slot(block, key) for key in keys]
    if (joined := code.f_string(items)) is not None:
        return joined
    if not any(map(_is_clear, items)) and not any(code.shows_text(block, key) for key in keys):
        items[0] = code.api_call("as_text", items[0])  # else it would be a sum of numbers
    total = reduce(lambda left, right: ast.BinOp(left, ast.Add(), right), items)
    code.require_flat(block, total)
    return total


def _is_clear(node: ast.expr) -> bool:
    return is_told(node) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def _junction(code: Expressions, block: Block) -> ast.expr:
    word = ast.And() if code.choice(block, "junction") == "and" else ast.Or()
    values = [code.slot(block, "a"), code.slot(block, "b"), *code.slots(block, "c", "more")]
    return ast.BoolOp(word, values)


_SAME: dict[str, ast.cmpop] = {"equal": ast.Eq(), "not_equal": ast.NotEq()}
_ORDER: dict[str, tuple[ast.cmpop, str]] = {
    "less": (ast.Lt(), "is_less"),
    "less_or_equal": (ast.LtE(), "is_at_most"),
    "greater": (ast.Gt(), "is_more"),
    "greater_or_equal": (ast.GtE(), "is_at_least"),
}


def _compare(code: Expressions, block: Block) -> ast.expr:
    comparison = code.choice(block, "comparison")
    a, b = code.slot(block, "a"), code.slot(block, "b")
    first, second = kinds_of(a), kinds_of(b)
    if comparison in _ORDER:
        sign, function = _ORDER[comparison]
        if any(are(first, kind) and are(second, kind) for kind in (NUMBER, TEXT)):
            return compare(a, sign, b)
        return code.api_call(function, a, b)
    is_equal = comparison == "equal"
    if are(first, TRUTH) and first and isinstance(b, ast.Constant) and type(b.value) is bool:
        return a if b.value is is_equal else ast.UnaryOp(ast.Not(), a)
    if not are_mixed(first, second):
        return compare(a, _SAME[comparison], b)
    same = code.api_call("is_same", a, b)
    return same if is_equal else ast.UnaryOp(ast.Not(), same)


def _not(code: Expressions, block: Block) -> ast.expr:
    asked = code.slot(block, "a")
    match asked:
        case ast.Compare(left, [ast.In()], [right]):
            return compare(left, ast.NotIn(), right)
    return ast.UnaryOp(ast.Not(), asked)


def _random_integer(code: Expressions, block: Block) -> ast.expr:
    low, high = code.slot(block, "low"), code.slot(block, "high")
    ends = known_whole(low), known_whole(high)
    if ends[0] is None or ends[1] is None or ends[0] > ends[1]:
        return code.api_call("random_whole", low, high)
    code.modules.add("random")
    drawn = method_call(ast.Name("random"), "randint", [low, high])
    return note(drawn, kinds_of(low) | kinds_of(high))


def _text_length(code: Expressions, block: Block) -> ast.expr:
    if code.shows_text(block, "text"):
        return call("len", code.slot(block, "text"))
    text = code.value_in(block, "text")
    return call("len", text) if code.knows_text(text) else code.api_call("length_of", text)


def _text_is_empty(code: Expressions, block: Block) -> ast.expr:
    if code.shows_text(block, "text"):
        return compare(code.slot(block, "text"), ast.Eq(), ast.Constant(""))
    text = code.value_in(block, "text")
    if code.knows_text(text):
        return compare(text, ast.Eq(), ast.Constant(""))
    length = code.api_call("length_of", text)
    return compare(length, ast.Eq(), ast.Constant(0))


def _text_contains(code: Expressions, block: Block) -> ast.expr:
    text, part = code.clear_text(block, "text"), code.slot(block, "part")
    if code.may_swap(text, part):
        return compare(part, ast.In(), text)
    return code.api_call("has_part", text, part)


def _text_find(code: Expressions, block: Block) -> ast.expr:
    part, text = code.slot(block, "part"), code.slot(block, "text")
    if code.may_swap(part, text):
        return ast.BinOp(method_call(text, "find", [part]), ast.Add(), ast.Constant(1))
    return code.api_call("place_in_text", part, text)


def _text_replace(code: Expressions, block: Block) -> ast.expr:
    text, new, part = (code.slot(block, key) for key in ("text", "new", "part"))
    if isinstance(part, ast.Constant) and part.value:
        return method_call(text, "replace", [part, new])
    return code.api_call("replace_part", text, new=new, part=part)


def _letter(code: Expressions, block: Block) -> ast.expr:
    text = code.slot(block, "text")
    (number,) = code.values_in(block, "number", then=text)
    is_text = code.shows_text(block, "text") or code.knows_text(text)
    index = index_of(number, text)
    if is_length_of(number, text):
        index = constant(-1)
    if index is not None and is_text and code.may_swap(number, text):
        return note(ast.Subscript(text, index), TEXT)
    return code.api_call("letter_of", number, text)


def _emotion(code: Expressions, block: Block) -> ast.expr:
    chosen = code.chosen(block, "emotion")
    state: ast.expr = ast.Constant(f"emotion_{chosen}")
    if chosen is None:
        state = code.api_call("emotion_state", code.slot(block, "emotion"))
    return code.api_call("was_seen", state, ast.Constant(EMOTION_S))


EMOTION_S = 3
"""How long a person looks so after a node has told it."""


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
    arguments = [_argument(code, block, parameter) for parameter in parameters(procedure)]
    made = call(code.names.procedures[procedure_id], *arguments)
    return note(made, code.kinds_at(result_key(procedure_id)))


def _argument(code: Expressions, block: Block, parameter: Parameter) -> ast.expr:
    """A value for an own block: its slot needs its kind, also where it is yes or no."""
    value = code.slot(block, parameter.id)
    is_truth = parameter.kind != "boolean" or are(kinds_of(value), TRUTH)
    return value if is_truth else call("bool", value)


def _own_parameter(code: Expressions, block: Block) -> ast.expr:
    if procedure_of(block.type) != code.procedure:
        raise CodeRefused(
            "This value is known only inside the definition of its own block.",
            block=block.id,
            checklist=("Move it under the “define” block that it comes from.",),
        )
    parameter = parameter_of(block.type)
    name = ast.Name(code.names.parameters[f"{code.procedure}.{parameter}"])
    return note(name, code.kinds_at(parameter_key(code.procedure, parameter)))


def _variable(code: Expressions, block: Block) -> ast.expr:
    return note(ast.Name(code.variable(block)), code.kinds_of_variable(block))


def _code_value(code: Expressions, block: Block) -> ast.expr:
    with refusing(block):
        read = read_value(code.text(block, "code"))
    note_names(code, read)
    return note(Verbatim(read.lines[0], is_closed=read.is_closed), kinds_of_code(read.lines[0]))


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
            code.variables.add(variable_id)  # a variable that is used is there
    code.robots.update(robot for robot, name in code.names.robots.items() if name in read.read)
    code.api.update(API & read.read - read.made - code.names.outside)
    code.modules.update(MODULES & read.read - read.made)


_NO_ARGUMENTS = ast.arguments([], [], None, [], [], None, [])


_ARITHMETIC = by_choice(*_CHOSEN["arithmetic"])


def _arithmetic(code: Expressions, block: Block) -> ast.expr:
    """Squares and cubes are no larger than other products: nothing has to look at them first."""
    made = _ARITHMETIC(code, block)
    match made:
        case ast.Call(func=ast.Name(id="to_power"), args=[base, ast.Constant(value=2 | 3)]) if (
            known_whole(base) is None  # ten to the power of a number is a block by itself
        ):
            return ast.BinOp(base, ast.Pow(), made.args[1])
    return made


REPORTERS: dict[str, ValueGenerator] = {
    **{name: python_of(text) for name, text in _LINES.items()},
    **{name: by_choice(slot, texts) for name, (slot, texts) in _CHOSEN.items()},
    "variable": _variable,
    "join": _join,
    "junction": _junction,
    "not": _not,
    "compare": _compare,
    "arithmetic": _arithmetic,
    "random_integer": _random_integer,
    "text_length": _text_length,
    "text_is_empty": _text_is_empty,
    "text_contains": _text_contains,
    "text_find": _text_find,
    "text_replace": _text_replace,
    "letter": _letter,
    "emotion": _emotion,
    **LIST_VALUES,
    **TABLE_VALUES,
    **BEHAVIOUR_VALUES,
    "own_call": _own_call,
    "own_parameter": _own_parameter,
    "code_value": _code_value,
    **FACT_VALUES,
}


# Statements.

ANSWER = "answer"
"""The name of what a robot was answered, in the function that asks."""
WORDS = "expected_words"
"""The name of what may be answered, where it has to be worked out."""


def _loop(word: str, text: str) -> StatementGenerator:
    """The generator of a loop around the blocks in slot ``do``."""
    value = python_of(text)
    return lambda code, block: [f"{word} {show(value(code, block))}:", Body("do", loop=True)]


def _repeat(code: Expressions, block: Block) -> list[Piece]:
    times = code.slot(block, "times")
    if not are(kinds_of(times), WHOLE):
        times = code.api_call("to_nearest", times)
    return [f"for _ in {show(call('range', times))}:", Body("do", loop=True)]


def _count(code: Expressions, block: Block) -> list[Piece]:
    first, last, step = (code.slot(block, key) for key in ("first", "last", "step"))
    low, high, by = known_whole(first), known_whole(last), known_whole(step)
    if by == 0:
        raise CodeRefused(
            "Counting in steps of 0 never ends.",
            block=block.id,
            checklist=("Make the step 1, or any number that is not zero.",),
        )
    way = code.choice(block, "way")
    if way == "either" and low is not None and high is not None:
        way = "up" if low <= high else "down"
    if way == "either" or by is None or not all(_is_whole(end) for end in (first, last)):
        ends = (first, last) if by == 1 else (first, last, step)
        counted = code.api_call(_COUNTS[code.choice(block, "way")], *ends)
    else:
        counted = _range(first, last, abs(by) if way == "up" else -abs(by))
    name = code.variable(block)
    return [Assignment(name, f"for {name} in {show(counted)}:"), Body("do", loop=True)]


_COUNTS = {"either": "count_from", "up": "count_up", "down": "count_down"}


def _is_whole(node: ast.expr) -> bool:
    return bool(kinds_of(node)) and are(kinds_of(node), WHOLE)


def _range(first: ast.expr, last: ast.expr, step: int) -> ast.Call:
    """The numbers up to a last one, or down to it: Python says the one where it ends before."""
    ends = [first, one_more(last) if step > 0 else one_less(last)]
    if step == 1 and known_whole(first) == 0:
        del ends[0]
    return call("range", *ends, *([] if step == 1 else [constant(step)]))


def _for_each(code: Expressions, block: Block) -> list[Piece]:
    items, name = code.slot(block, "list"), code.variable(block)
    held = code.plugged(block, "list")
    if (lent := _lent(code, items)) is not None:
        items = lent
    elif held is not None and not _is_new_list(items):
        variable = str(held.fields.get("variable", ""))
        if code.list_changes(variable):  # the items that it had when the loop began
            items = ast.Subscript(items, ast.Slice())
    return [Assignment(name, f"for {name} in {show(items)}:"), Body("do", loop=True)]


def _lent(code: Expressions, items: ast.expr) -> ast.expr | None:
    """A text or a table through whose letters or names a loop goes without a list of them."""
    match items:
        case ast.Call(func=ast.Name(id="list"), args=[inner]) if code.knows_text(inner):
            return inner
        case ast.Call(func=ast.Name(id="list"), args=[inner]) if kinds_of(inner) == TABLE:
            return None if code.named_list_changes(inner) else inner
    return None


_NEW_LISTS = frozenset(
    {
        *("sorted", "sorted_items", "list", "split", "list_with", "items_between", "parts_of"),
        *("fact", "the_plan"),
    }
)


def _is_new_list(items: ast.expr) -> bool:
    """Whether a list was made just now, so that nobody else can change it."""
    match items:
        case ast.List() | ast.Subscript(slice=ast.Slice()):
            return True
        case ast.Call(func=ast.Name(id=name)) | ast.Call(func=ast.Attribute(attr=name)):
            return name in _NEW_LISTS
    return False


def _assign(sign: str, slot: str) -> StatementGenerator:
    """The generator of what puts a value into a variable, or adds it there."""

    def generate(code: Expressions, block: Block) -> list[Piece]:
        name = code.variable(block)
        return [Assignment(name, f"{name} {sign} {show(code.slot(block, slot))}")]

    return generate


def _change(code: Expressions, block: Block) -> Sequence[Piece]:
    """What is added is worked out first, and only then what the variable holds by then."""
    name, amount = code.variable(block), code.slot(block, "amount")
    held: ast.expr = note(ast.Name(name), code.kinds_of_variable(block))
    if may_swap(amount, held):
        if not kinds_of(held) & TRUTH:  # a text or a list refuses a number
            less = _less(amount)
            sign, amount = ("+=", amount) if less is None else ("-=", less)
            return [Assignment(name, f"{name} {sign} {show(amount)}")]
        held, amount = amount, code.api_call("as_number", held)
    elif not are(kinds_of(held), NUMBER):
        held = code.api_call("as_number", held)
    return [Assignment(name, f"{name} = {show(ast.BinOp(amount, ast.Add(), held))}")]


def _less(amount: ast.expr) -> ast.expr | None:
    """How much is taken away by an amount that says so."""
    return amount.operand if isinstance(amount, ast.UnaryOp) else None


def _append(code: Expressions, block: Block) -> Sequence[Piece]:
    name, text = code.variable(block), code.slot(block, "text")
    held = note(ast.Name(name), code.kinds_of_variable(block))
    is_no_list = are(kinds_of(held), NUMBER | TEXT | TRUTH | ROBOT)
    if not code.may_swap(text, held) or (takes_items(text) and not is_no_list):
        # The text first, then what the variable holds by then: with or without what was taken
        value: ast.expr = code.api_call("append_text", text, held)
    elif are(kinds_of(held), TEXT):
        return [Assignment(name, f"{name} += {show(code.clear(block, 'text', text))}")]
    else:
        shown = code.clear(block, "text", text)
        value = ast.BinOp(code.api_call("as_text", held), ast.Add(), shown)
    return [Assignment(name, f"{name} = {show(value)}")]


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


def _each_robot(code: Expressions, block: Block) -> list[Piece]:
    """The blocks inside are a function, which nep_core calls for each robot."""
    function = Function(code.part_name(), "do")
    robots = code.slot(block, "robot")
    called = code.api_call("for_each_robot", robots, ast.Name(function.name))
    return [function, Gap(), show(called)]


def _wait_until(code: Expressions, block: Block) -> list[Piece]:
    condition: ast.expr = ast.Lambda(_NO_ARGUMENTS, code.slot(block, "condition"))
    limit = [code.slot(block, "seconds.1")] if block.groups.get("limit") else []
    return [show(code.api_call("wait_until", condition, *limit))]


def _try(code: Expressions, block: Block) -> list[Piece]:
    """What was begun is ended before what is done instead, as at the end of a rule by an error."""
    end = show(code.api_call("end_actions"))
    return [
        "try:",
        Body("do", guard=True),
        f"except {ERROR}:",
        Body("otherwise", guard=True, first=end),
    ]


ERROR = "Exception"
"""What is caught: not what ends a rule or the program."""


def _ask(code: Expressions, block: Block) -> list[Piece]:
    words = code.slots(block, "word", "answer")
    possible: ast.expr = ast.List(words)
    pieces: list[Piece] = []
    if not all(map(code.stays, words)):  # they are worked out once
        pieces = [f"{WORDS} = {show(possible)}"]
        possible = ast.Name(WORDS)
        words = [ast.Subscript(possible, ast.Constant(number)) for number in range(len(words))]
    arguments = [code.slot(block, "question"), possible]
    seconds = {"seconds": code.slot(block, "seconds")}
    asked = show(method_call(code.slot(block, "robot"), "ask", arguments, seconds))
    pieces.append(f"{ANSWER} = {asked}")
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


STATEMENTS: dict[str, StatementGenerator] = {
    **TREE_PARTS,
    "repeat": _repeat,
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
    "each_robot": _each_robot,
    "one_of": _parts("one_of"),
    "in_turn": _parts("in_turn"),
    "wait_until": _wait_until,
    **BEHAVIOUR_STATEMENTS,
    "try": _try,
    "set_variable": _assign("=", "value"),
    "change_variable": _change,
    "append_text": _append,
    **LIST_STATEMENTS,
    **TABLE_STATEMENTS,
    "ask": _ask,
    "wait_for_word": _wait_for_word,
    "note": lambda code, block: [*comment_lines(code.text(block, "text"))],
    "code_lines": _code_lines,
    "own_call": lambda code, block: [show(_own_call(code, block))],
    "own_return": lambda code, block: [GiveBack(f"return {show(code.slot(block, 'value'))}")],
    **FACT_LINES,
}
