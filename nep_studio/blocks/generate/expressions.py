"""Values as expression trees: what slots hold, what reporters give, and the calls of blocks."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from nep_studio.blocks.arithmetic import ArithmeticRefused, calculate
from nep_studio.blocks.code_text import CodeTextRefused
from nep_studio.blocks.definitions import MOST_REPEATS, Call, Definition
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Block, Project, split_slot
from nep_studio.blocks.sharing import Sharing
from nep_studio.blocks.slots import JOINERS, TEXT_RESULTS, FieldValue, Kind, constant

from .kinds import (
    LIST,
    NUMBER,
    RESULT_KINDS,
    ROBOT,
    TABLE,
    TEXT,
    TRUTH,
    WHOLE,
    Kinds,
    are,
    kinds_of,
    note,
    variable_key,
)
from .names import VALUES, NameTable, ProgramNames

# Expression trees that blocks make often: constants, calls, whole numbers.


def call(name: str, /, *arguments: ast.expr, **keywords: ast.expr) -> ast.Call:
    """A call of a function by its name."""
    named = [ast.keyword(key, value) for key, value in keywords.items()]
    return ast.Call(ast.Name(name), list(arguments), named)


def method_call(
    target: ast.expr,
    method: str,
    arguments: list[ast.expr] | None = None,
    keywords: Mapping[str, ast.expr] | None = None,
) -> ast.Call:
    """A call of a method."""
    named = [ast.keyword(key, value) for key, value in (keywords or {}).items()]
    return ast.Call(ast.Attribute(target, method), arguments or [], named)


def known_whole(node: ast.expr) -> int | None:
    """The whole number that an expression is, when it is written there as such."""
    match node:
        case ast.Constant(value=int(value)) if type(value) is int:
            return value
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int(value))) if value:
            return -value
    return None


_TAKES = frozenset({"pop", "take_item"})
_DRAWS = _TAKES | {"random", "randint", "choice", "random_whole"}
_HARMLESS = frozenset(
    {
        *("len", "str", "abs", "min", "max", "round", "sorted", "list", "reversed", "bool"),
        *("floor", "ceil", "find", "upper", "lower", "replace", "split", "sqrt", "log", "log10"),
        *("dict", "values", "get"),
        *("exp", "radians", "degrees", "sin", "cos", "tan", "asin", "acos", "atan"),
        *VALUES - {"random_whole", "take_item"},
    }
)


def _effects(node: ast.expr) -> int:
    """What working out a value does besides: 0 nothing, 1 draws or takes, 2 perhaps anything."""
    found = 0
    for inner in ast.walk(node):
        if isinstance(inner, Verbatim):
            return 2
        if isinstance(inner, ast.Call):
            name = getattr(inner.func, "id", getattr(inner.func, "attr", ""))
            if name in _DRAWS:
                found = 1
            elif name not in _HARMLESS:
                return 2
    return found


def may_swap(first: ast.expr, second: ast.expr) -> bool:
    """Whether two values may be worked out in the other order, and give the same."""
    if isinstance(first, ast.Constant) or isinstance(second, ast.Constant):
        return True
    effects = _effects(first), _effects(second)
    if max(effects) == 1:  # the name of a list stands for it, whatever is taken out of it
        return isinstance(first, ast.Name) or isinstance(second, ast.Name)
    return max(effects) == 0


def takes_items(node: ast.expr) -> bool:
    """Whether working out a value takes an item off a list, which is told otherwise afterwards."""
    calls = (inner.func for inner in ast.walk(node) if isinstance(inner, ast.Call))
    return any(getattr(one, "id", getattr(one, "attr", "")) in _TAKES for one in calls)


def as_truth(node: ast.expr) -> ast.expr:
    """A value; what “and” and “or” give is a truth, whatever goes in."""
    is_other = isinstance(node, ast.BoolOp) and not are(kinds_of(node), TRUTH)
    return call("bool", node) if is_other else node


def compare(left: ast.expr, sign: ast.cmpop, right: ast.expr) -> ast.Compare:
    """A comparison of two values."""
    return ast.Compare(left, [sign], [right])


ANSWER, WORDS = INNER_NAMES = "answer", "expected_words"
"""What a robot was answered, and what may be answered, in the function that asks."""

VARIABLE_BLOCK, JOIN_BLOCK = "variable.get", "text.join"

DEEPEST_VALUE = 60
"""How deep values may be nested: CPython takes 200 parentheses, a block makes up to three."""

ValueGenerator = Callable[["Expressions", Block], ast.expr]


@contextmanager
def refusing(block: Block) -> Iterator[None]:
    """Refuse a block in which something is written that cannot be read."""
    try:
        yield
    except (ArithmeticRefused, CodeTextRefused) as refused:
        raise CodeRefused(
            refused.sentence, block=block.id, checklist=("Correct what is written in this block.",)
        ) from refused


class Expressions:
    """Makes the expression trees of one stack, and notes what they need to be there."""

    def __init__(
        self,
        project: Project,
        language: Language,
        names: ProgramNames,
        reporters: Mapping[str, ValueGenerator],
        kinds: Kinds,
    ) -> None:
        self.project = project
        self.language = language
        self.names = names
        self.reporters = reporters
        self.api: set[str] = set()
        self.modules: set[str] = set()
        self.robots: set[str] = set()
        self.variables: set[str] = set()
        """The ids of the variables that are used."""
        self.rules: Mapping[str, str] = {}
        """The names of the functions of rules, by the blocks with which these begin."""
        self.rules_named: dict[str, str] = {}
        """Those that are named here."""
        self.procedure = ""
        """The own block that is being written, or an empty text."""
        self.sharing = Sharing()
        """What other rules may change meanwhile."""
        self.gives_nothing = False
        """Whether it should give a value, but may come to its end without one: 0 then."""
        self.written_for: dict[str, int] = {}
        """The kinds that this was written for, by what is kept there."""
        self._kinds = kinds
        self._depth = 0
        self._parts = 0
        self._part_names: NameTable | None = None

    def definition(self, block: Block) -> Definition:
        """The definition of a block; a block of an unknown type is refused."""
        definition = self.language.definitions.get(block.type)
        if definition is None:
            raise CodeRefused(
                "This version does not know the block “{type}”.",
                block=block.id,
                checklist=("Update NEP Studio.", "Or take the block out of the program."),
                type=block.type,
            )
        return definition

    def slot(self, block: Block, key: str) -> ast.expr:
        """What is in a slot, made what the slot needs: a number, a list or a text."""
        plugged = self.plugged(block, key)
        definition = self.definition(block)
        kind = definition.slots[split_slot(key)[0]].kind
        if plugged is None:  # what is typed fits
            return self._field(block, key, kind, definition.value(block, key))
        return self.fitting(self.value(plugged), kind)

    def value_in(self, block: Block, key: str) -> ast.expr:
        """What is in a slot, of whatever kind: the block plugged into it, else its field."""
        plugged = self.plugged(block, key)
        if plugged is not None:
            return as_truth(self.value(plugged))
        definition = self.definition(block)
        slot = definition.slots[split_slot(key)[0]]
        return self._field(block, key, slot.kind, definition.value(block, key))

    def fitting(self, node: ast.expr, kind: Kind) -> ast.expr:
        """A value as a kind of slot needs it; what cannot be that is refused while it runs."""
        if kind.name != "boolean":
            node = as_truth(node)
        kinds = kinds_of(node)
        if kind.is_number:
            return node if are(kinds, NUMBER) else self.api_call("as_number", node)
        if kind.name == "list":
            return node if are(kinds, LIST) else self.api_call("as_list", node)
        if kind.name == "table":
            return node if are(kinds, TABLE) else self.api_call("as_table", node)
        if kind.name == "robot":
            return node if are(kinds, ROBOT) else self.api_call("as_robot", node)
        if kind.name == "checkbox":
            return node if are(kinds, TRUTH) else call("bool", node)
        if kind.becomes_text:
            return node if are(kinds, TEXT) else self.told(node)
        return node

    def values_in(self, block: Block, *keys: str, then: ast.expr | None = None) -> list[ast.expr]:
        """What is in slots that a function looks at itself; ``then`` is worked out after them.

        What does not fit is refused before anything is worked out that does something besides.
        """
        definition, made = self.definition(block), [self.value_in(block, key) for key in keys]
        after = [*made[1:], *([] if then is None else [then])]
        for number, key in enumerate(keys):
            if any(map(_effects, after[number:])):
                kind = definition.slots[split_slot(key)[0]].kind
                made[number] = self.fitting(made[number], kind)
        return made

    def told(self, node: ast.expr) -> ast.expr:
        """A value as a text."""
        kinds = kinds_of(node)
        is_whole = bool(kinds) and are(kinds, WHOLE)
        return call("str", node) if is_whole else self.api_call("as_text", node)

    def clear_text(self, block: Block, key: str) -> ast.expr:
        """What is in a slot as a text, where Python must show that it is one.

        Elsewhere a variable that holds nothing but texts may stand by itself.
        """
        return self.clear(block, key, self.slot(block, key))

    def clear(self, block: Block, key: str, node: ast.expr) -> ast.expr:
        """A text that is in a slot, so that Python shows that it is one."""
        if self.shows_text(block, key) or is_told(node) or self.knows_text(node):
            return node
        return self.api_call("as_text", node)

    def shows_text(self, block: Block, key: str) -> bool:
        """Whether everybody can see that a slot holds a text: it is typed, or a block of texts."""
        plugged = self.plugged(block, key)
        return plugged is None or is_clear_text(plugged, self.definition(plugged))

    def knows_text(self, node: ast.expr) -> bool:
        """Whether all that a value may be is a text, as its stack shows by itself."""
        is_shared = isinstance(node, ast.Name) and "." in node.id
        return kinds_of(node) == TEXT and not is_shared

    def may_swap(self, first: ast.expr, second: ast.expr) -> bool:
        """Whether two values may be worked out in the other order, and give the same."""
        return may_swap(first, second)

    def stays(self, node: ast.expr) -> bool:
        """Whether a value is the same when it is worked out again, after some time."""
        if not isinstance(node, ast.Name):
            return isinstance(node, ast.Constant)
        variables = self.names.variables.items()
        return not any(name == node.id and v in self.sharing.shared for v, name in variables)

    def kinds_at(self, key: str) -> int:
        """The kinds of what is kept somewhere; what is written is written for these."""
        kinds = self.written_for[key] = self._kinds.of(key)
        return kinds

    def _field(self, block: Block, key: str, kind: Kind, value: FieldValue | None) -> ast.expr:
        if kind.name == "robot":
            self.robots.add(str(value))
            return note(ast.Name(self.names.robots[str(value)]), ROBOT)
        if kind.name == "variable":
            return ast.Name(self.variable(block))
        if kind.name == "choice":
            return ast.Constant(self.choice(block, key))
        if kind.name == "rule":
            return ast.Name(self.rule(block, str(value)))
        if not kind.is_number or not isinstance(value, str):
            return kind.to_python(value)
        with refusing(block):
            arithmetic = calculate(value)
        if arithmetic.needs_math:
            self.modules.add("math")
        return arithmetic.node

    def plugged(self, block: Block, key: str) -> Block | None:
        """The block plugged into a slot, or None; a disabled one does not count."""
        return self.project.plugged(block, key)

    def choice(self, block: Block, key: str) -> str:
        """The value of a choice slot, which is one of its table."""
        definition = self.definition(block)
        value = definition.value(block, key)
        slot = definition.slots[split_slot(key)[0]]
        reason = self.language.why_not_choice(slot, value, block, key)
        if reason is not None:
            raise CodeRefused(reason, block=block.id, checklist=("Choose another one.",))
        return str(value)

    def chosen(self, block: Block, key: str) -> str | None:
        """The value of a choice slot; None where a block is plugged in, which gives it."""
        return None if self.plugged(block, key) is not None else self.choice(block, key)

    def text(self, block: Block, key: str) -> str:
        """What the field of a slot holds, as a text."""
        return str(self.definition(block).value(block, key))

    def slots(self, block: Block, first: str, group: str) -> list[ast.expr]:
        """What is in the slot of each part of a group."""
        count = block.groups.get(group, 0)
        return [self.slot(block, f"{first}.{number}") for number in range(1, count + 1)]

    def value(self, block: Block) -> ast.expr:
        """What a reporter block gives."""
        definition = self.definition(block)
        cost = value_cost(block)
        self._depth += cost
        if self._depth > DEEPEST_VALUE:
            raise _too_deep(block)
        if definition.call is not None:
            node: ast.expr = self.call(block, definition.call)
        else:
            node = self.reporters[definition.generator](self, block)
        self._depth -= cost
        if definition.generator not in _MAYBE_OTHERS and not isinstance(node, ast.BoolOp):
            result = RESULT_KINDS[definition.result]
            if not are(kinds_of(node), result):
                note(node, result)
        return node

    def require_flat(self, block: Block, node: ast.expr) -> None:
        """Refuse a value that is too long where its parts are in each other in Python."""
        level: list[ast.AST] = [node]
        for _ in range(2 * DEEPEST_VALUE):
            level = [child for one in level for child in ast.iter_child_nodes(one)]
        if level:
            raise _too_deep(block)

    def call(self, block: Block, made: Call) -> ast.Call:
        """The call that a block stands for."""
        arguments = [self.slot(block, key) for key in made.arguments]
        definition, keywords = self.definition(block), dict[str, ast.expr]()
        for name, key in made.keywords.items():
            is_usual = key in made.optional and self.plugged(block, key) is None
            if not is_usual or definition.value(block, key) != definition.defaults[key]:
                keywords[name] = self.slot(block, key)
        keywords |= {name: constant(value) for name, value in made.constants.items()}
        if not made.on:
            return self.api_call(made.name, *arguments, **keywords)
        return method_call(self.slot(block, made.on), made.name, arguments, keywords)

    def api_call(self, name: str, /, *arguments: ast.expr, **keywords: ast.expr) -> ast.Call:
        """A call of a function of nep_core, which is noted for the import."""
        self.api.add(name)
        return call(name, *arguments, **keywords)

    def variable(self, block: Block) -> str:
        """The Python name of the variable that a block is about."""
        variable_id = str(block.fields.get("variable", ""))
        if variable_id not in self.names.variables:
            raise CodeRefused(
                "No variable is chosen in this block.",
                block=block.id,
                checklist=("Choose a variable, or make a new one.",),
            )
        self.variables.add(variable_id)  # a variable that is used is there
        return self.names.variables[variable_id]

    def rule(self, block: Block, hat: str) -> str:
        """The name of the function of the rule that begins with a block."""
        if hat not in self.rules:
            raise CodeRefused(
                "The rule that this block stops is not there.",
                block=block.id,
                checklist=("Choose a rule in this block.", "Or take this block out."),
            )
        self.rules_named[hat] = self.rules[hat]
        return self.rules[hat]

    def f_string(self, parts: Sequence[ast.expr]) -> ast.JoinedStr | None:
        """Texts behind each other as an f-string; None where Python 3.11 cannot write that."""
        return f_string(parts)

    def has_two_names(self, variable: str) -> bool:
        """Whether a list or table may be changed under another name than this, at once too."""
        return not variable or self._kinds.has_lists_twice

    def list_changes(self, variable: str) -> bool:
        """Whether a list may change meanwhile; ``variable`` is "" for one without a name."""
        if self._kinds.has_lists_twice:  # what is done to one name is done to the other
            variable = ""
        return self.sharing.changes(variable)

    def named_list_changes(self, node: ast.expr) -> bool:
        """Whether a list or table that Python names may change meanwhile."""
        ids = {name: variable for variable, name in self.names.variables.items()}
        return self.list_changes(ids.get(node.id, "") if isinstance(node, ast.Name) else "")

    def kinds_of_variable(self, block: Block) -> int:
        """The kinds of what the variable of a block holds."""
        return self.kinds_at(variable_key(str(block.fields.get("variable", ""))))

    def part_name(self, text: str = "") -> str:
        """A name for a function inside the rule, after a text: else part_1, part_2, and so on."""
        self._parts += not text
        if self._part_names is None:
            self._part_names = NameTable({*self.names.taken(), *INNER_NAMES})
        return self._part_names.give(text or f"part_{self._parts}", "part")

    def inner_name(self, name: str) -> str:
        """One of INNER_NAMES as it is called here: always the same one, which nothing else has."""
        return NameTable(self.names.bare()).give(name, name)


def value_cost(block: Block) -> int:
    """How many levels a value block adds; the parts of a junction may be in each other."""
    return 1 if block.type == JOIN_BLOCK else 1 + sum(block.groups.values())


def _too_deep(block: Block) -> CodeRefused:
    return CodeRefused(
        "Blocks are plugged into blocks too deep: {deepest_value} levels at most.",
        block=block.id,
        checklist=("Set a variable to a part of this, and use the variable here.",),
        deepest_value=DEEPEST_VALUE,
    )


_MAYBE_OTHERS = frozenset({"own_parameter", "code_value"})


def is_clear_text(block: Block, definition: Definition) -> bool:
    """Whether a block gives a text as everybody can see: its outline and its Python say so."""
    return definition.result in TEXT_RESULTS and definition.generator not in _MAYBE_OTHERS


def is_told(node: ast.expr) -> bool:
    """Whether Python says itself that a value is told as a text."""
    match node:
        case ast.Call(func=ast.Name(id="str" | "as_text")):
            return True
    return False


# Print an expression tree as one line of Python.
#
# Only the nodes that blocks make are known. ``ast.parse(show(node))`` gives ``node`` again: that
# is a property test, and the reason why no text of a user can become code. ``ast.unparse`` is
# several times slower and prefers single quotes.

_LAMBDA, _OR, _AND, _NOT, _COMPARE, _SUM, _TERM, _SIGN, _POWER, _ATOM, _TARGET = range(11)

_BINARY: dict[type[ast.operator], tuple[str, int]] = {
    ast.Add: (" + ", _SUM),
    ast.Sub: (" - ", _SUM),
    ast.Mult: (" * ", _TERM),
    ast.Div: (" / ", _TERM),
    ast.FloorDiv: (" // ", _TERM),
    ast.Mod: (" % ", _TERM),
    ast.Pow: (" ** ", _POWER),
}
_COMPARISON: dict[type[ast.cmpop], str] = {
    ast.Eq: " == ",
    ast.NotEq: " != ",
    ast.Lt: " < ",
    ast.LtE: " <= ",
    ast.Gt: " > ",
    ast.GtE: " >= ",
    ast.In: " in ",
    ast.NotIn: " not in ",
}


class Verbatim(ast.expr):
    """Python that a person wrote, printed as it is; ``is_closed`` needs no parentheses."""

    def __init__(self, text: str, *, is_closed: bool) -> None:
        super().__init__()
        self.text = text
        self.is_closed = is_closed


def show(node: ast.expr, least: int = _LAMBDA) -> str:
    """Print an expression; it is put in parentheses when it binds weaker than ``least``."""
    text, strength = _PRINTERS[type(node)](node)
    return text if strength >= least else f"({text})"


def literal(value: object) -> str:
    """Print a constant; texts in double quotes unless that takes more escapes.

    ``repr`` escapes whatever is not printable: line breaks of every kind, control characters,
    marks that turn the direction of writing, and halves of characters.
    """
    text = repr(value)
    if text[0] == "'" and '"' not in text:
        return f'"{text[1:-1]}"'
    return text


def _constant(node: ast.Constant) -> tuple[str, int]:
    value = node.value
    if isinstance(value, int | float) and (not math.isfinite(value) or math.copysign(1, value) < 0):
        raise ValueError(f"{value} must be written with a sign of its own")
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return literal(value), _ATOM if is_number else _TARGET  # a dot after a number is its point


def _call(node: ast.Call) -> tuple[str, int]:
    arguments = [show(argument) for argument in node.args]
    arguments += [f"{keyword.arg}={show(keyword.value)}" for keyword in node.keywords]
    return f"{show(node.func, _TARGET)}({', '.join(arguments)})", _TARGET


def _binary(node: ast.BinOp) -> tuple[str, int]:
    sign, strength = _BINARY[type(node.op)]
    if strength == _POWER:  # binds to the right, and a sign may stand right of it
        return f"{show(node.left, _ATOM)}{sign}{show(node.right, _SIGN)}", _POWER
    right: list[str] = []
    first: ast.expr = node
    while isinstance(first, ast.BinOp) and _BINARY[type(first.op)][1] == strength:
        right.append(f"{_BINARY[type(first.op)][0]}{show(first.right, strength + 1)}")
        first = first.left  # a long sum is nested to the left: no recursion
    return f"{show(first, strength)}{''.join(reversed(right))}", strength


def f_string(parts: Sequence[ast.expr]) -> ast.JoinedStr | None:
    """Texts behind each other as an f-string; None where Python 3.11 cannot write that.

    None also where all of them are typed: those are no f-string. F-strings in it become one.
    """
    flat = [inner for part in parts for inner in _inner_parts(part)]
    values: list[ast.expr] = []
    for part in flat if len(flat) <= MOST_REPEATS else map(_braced, parts):
        last = values[-1] if values else None
        if isinstance(part, ast.Constant) and isinstance(last, ast.Constant):
            values[-1] = ast.Constant(str(last.value) + str(part.value))
        elif not isinstance(part, ast.Constant) or part.value:
            values.append(part)
    is_typed = all(isinstance(value, ast.Constant) for value in values)
    if is_typed or any(_part_of_f_string(value) is None for value in values):
        return None
    return ast.JoinedStr(values)


def _inner_parts(part: ast.expr) -> list[ast.expr]:
    return part.values if isinstance(part, ast.JoinedStr) else [_braced(part)]


def _braced(part: ast.expr) -> ast.expr:
    """A text as a part of an f-string; braces tell a whole number as str() does."""
    match part:
        case ast.Constant(value=str()) | ast.FormattedValue():
            return part
        case ast.Call(func=ast.Name(id="str"), args=[inner]) if are(kinds_of(inner), WHOLE):
            part = inner
    return ast.FormattedValue(part, -1)


def _joined(node: ast.JoinedStr) -> tuple[str, int]:
    shown = [_part_of_f_string(part) for part in node.values]
    parts = [part for part in shown if part is not None]
    if len(parts) < len(shown):
        raise ValueError("Python 3.11 cannot write this as an f-string")
    return f'f"{"".join(parts)}"', _TARGET


def _part_of_f_string(part: ast.expr) -> str | None:
    """A part of an f-string in double quotes; None where it cannot be written there.

    Until Python 3.12 no quote of the same sort, backslash or comment sign is inside the braces.
    """
    if isinstance(part, ast.Constant):  # with a single quote in it, repr takes double ones
        pieces = [repr(f"'{piece}")[2:-1] for piece in str(part.value).split('"')]
        return '\\"'.join(pieces).replace("{", "{{").replace("}", "}}")
    assert isinstance(part, ast.FormattedValue)
    if any(map(_is_open, ast.walk(part.value))):
        return None
    text = show(part.value)
    has_both = '"' in text and "'" in text
    if has_both or text.startswith("{") or "\\" in text or "#" in text:
        return None
    return "{" + text.replace('"', "'") + "}"


def _is_open(node: ast.AST) -> bool:
    """Whether a sign in it may end the value inside the braces: “:”, “!” or “=”."""
    if isinstance(node, Verbatim) and not node.is_closed:
        return any(sign in node.text for sign in ":!=")
    return isinstance(node, ast.Lambda)


def _unary(node: ast.UnaryOp) -> tuple[str, int]:
    if isinstance(node.op, ast.Not):
        return f"not {show(node.operand, _NOT)}", _NOT
    return f"-{show(node.operand, _SIGN)}", _SIGN


def _junction(node: ast.BoolOp) -> tuple[str, int]:
    word, strength = (" and ", _AND) if isinstance(node.op, ast.And) else (" or ", _OR)
    return word.join([show(value, strength + 1) for value in node.values]), strength


def _compare(node: ast.Compare) -> tuple[str, int]:
    text = show(node.left, _SUM)
    for sign, right in zip(node.ops, node.comparators, strict=True):
        text += _COMPARISON[type(sign)] + show(right, _SUM)
    return text, _COMPARE


def _choose(node: ast.IfExp) -> tuple[str, int]:
    test, body = show(node.test, _OR), show(node.body, _OR)
    return f"{body} if {test} else {show(node.orelse)}", _LAMBDA


def _dict(node: ast.Dict) -> tuple[str, int]:
    entries = zip(node.keys, node.values, strict=True)
    shown = [f"{show(key)}: {show(value)}" for key, value in entries if key is not None]
    return f"{{{', '.join(shown)}}}", _TARGET


def _slice(node: ast.Slice) -> tuple[str, int]:
    low = show(node.lower) if node.lower is not None else ""
    high = show(node.upper) if node.upper is not None else ""
    return f"{low}:{high}", _LAMBDA


_PRINTERS: dict[type[ast.expr], Callable[..., tuple[str, int]]] = {
    ast.Constant: _constant,
    ast.Name: lambda node: (node.id, _TARGET),
    ast.Attribute: lambda node: (f"{show(node.value, _TARGET)}.{node.attr}", _TARGET),
    ast.Call: _call,
    ast.List: lambda node: (f"[{', '.join(map(show, node.elts))}]", _TARGET),
    ast.Subscript: lambda node: (f"{show(node.value, _TARGET)}[{show(node.slice)}]", _TARGET),
    ast.BinOp: _binary,
    ast.UnaryOp: _unary,
    ast.BoolOp: _junction,
    ast.Compare: _compare,
    ast.Lambda: lambda node: (f"lambda: {show(node.body)}", _LAMBDA),
    ast.IfExp: _choose,
    ast.Dict: _dict,
    ast.JoinedStr: _joined,
    ast.Slice: _slice,
    Verbatim: lambda node: (node.text, _TARGET if node.is_closed else _LAMBDA),
}


# The pieces of which the Python of a statement block is made, in order.


@dataclass(frozen=True, slots=True)
class Body:
    """The chain of blocks in a slot; CPython limits how deep loops and ``is_with`` are nested.

    One that is tried, or done when that fails, is in a ``guard``, which CPython counts as it does
    two loops. ``first`` is a line above the blocks, or an empty text.
    """

    slot: str
    loop: bool = False
    is_with: bool = False
    guard: bool = False
    first: str = ""


@dataclass(frozen=True, slots=True)
class Function:
    """A function without arguments whose body is the chain of blocks in a slot.

    ``decorator`` stands above it; without one, it is called below.
    """

    name: str
    slot: str
    decorator: str = ""


@dataclass(frozen=True, slots=True)
class Assignment:
    """A line that assigns to a variable."""

    variable: str
    line: str


@dataclass(frozen=True, slots=True)
class Leave:
    """A line that leaves a loop or its round."""

    line: str


@dataclass(frozen=True, slots=True)
class EndRule:
    """The end of the rule: a function of its own inside it cannot just return."""

    line: str = "return"


@dataclass(frozen=True, slots=True)
class GiveBack:
    """A line that gives the value of an own block."""

    line: str


@dataclass(frozen=True, slots=True)
class Written:
    """Lines that a person wrote, with the program's variables to which they assign.

    ``inside_texts`` are the lines, from 1, that begin inside a text: no margin goes before them.
    """

    lines: tuple[str, ...]
    inside_texts: frozenset[int]
    assigned: frozenset[str]


@dataclass(frozen=True, slots=True)
class Gap:
    """An empty line, to keep apart what does not belong together."""


Piece = str | Body | Function | Assignment | Leave | EndRule | GiveBack | Written | Gap
StatementGenerator = Callable[[Expressions, Block], Sequence[Piece]]


# Comments: those of blocks are without the sign and the space behind it.


def comment_lines(text: str) -> Iterator[str]:
    """A text as comments of Python; lines without words stay between others."""
    lines = [visible_line(line) for line in text.splitlines()]
    yield from map(comment_line, "\n".join(lines).strip("\n").split("\n") if any(lines) else ())


def comment_line(text: str) -> str:
    """A line as a comment of Python. One that begins with the sign is one of signs, as “####”."""
    return f"#{text}" if not text or text.lstrip().startswith("#") else f"# {text}"


def comment_text(comment: str) -> str:
    """What a comment of Python says: what ``comment_line`` makes it of."""
    text = visible_line(comment[1:])
    return text if text.lstrip().startswith("#") else text.removeprefix(" ")


def visible_line(text: str) -> str:
    """A line with spaces for control characters, which could end a comment; none at its end."""
    return "".join(c if c.isprintable() or c in JOINERS else " " for c in text).rstrip()
