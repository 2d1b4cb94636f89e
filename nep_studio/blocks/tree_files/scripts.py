"""The scripts of BehaviorTree.CPP as blocks: what is set, compared and reckoned with values.

``Reader`` makes blocks of a script, or gives None where blocks cannot say the same; ``written``
makes a script of blocks. Language: https://www.behaviortree.dev/docs/guides/scripting
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeVar

from ..arithmetic import number_text
from ..from_python.learning import Made
from ..program import Block
from ..slots import FieldValue

Value = tuple[FieldValue | None, Made | None]
"""What stands in a slot: what is typed there, or the block that is plugged in."""

NAME = re.compile(r"[A-Za-z_@][\w.@]*")
_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<text>'[^']*'|\"[^\"]*\")"
    r"|(?P<name>[A-Za-z_@][\w.@]*)|(?P<sign>&&|\|\||[:+\-*/=!<>]=|\.\.|[-+*/=!<>?:;()&|^~%]))"
)
_STATEMENT = re.compile(r"""(?:'[^']*'|"[^"]*"|[^;])+""")
_COMPARED = {
    "==": "equal",
    "!=": "not_equal",
    "<": "less",
    "<=": "less_or_equal",
    ">": "greater",
    ">=": "greater_or_equal",
}
_TURNED = {"equal": "not_equal", "not_equal": "equal"}
_RECKONED = {"+": "add", "-": "subtract", "*": "multiply", "/": "divide"}
_JOINED = {"&&": "and", "||": "or"}
_LEVELS: tuple[tuple[str, ...], ...] = (
    ("||",),
    ("&&",),
    ("==", "!="),
    ("<", "<=", ">", ">="),
    ("+", "-", ".."),
    ("*", "/"),
)
"""The signs between two values, from those that bind least."""
_DEEPEST = 40
_Read = TypeVar("_Read")


class _Unread(Exception):
    """A script says more than blocks can."""


@dataclass(slots=True)
class Reader:
    """Makes blocks of scripts.

    ``is_entry`` is whether a name is one of the values of a tree; another one in capitals, as C++
    gives to its enumerations, is a text, and ``tell_word`` is told of it. ``is_number`` is whether
    a value is a number, of which 0 is no.
    """

    is_entry: Callable[[str], bool]
    is_number: Callable[[str], bool]
    tell_word: Callable[[str], None]

    def statements(self, code: str) -> list[Made] | None:
        """The blocks that set what a script sets, or None."""
        return self._read(code, _Words.statements)

    def condition(self, code: str) -> Made | None:
        """The condition that a script is, or None."""
        return self._read(code, _Words.whole_condition)

    def _read(self, code: str, read: Callable[[_Words], _Read]) -> _Read | None:
        try:
            words = _Words(list(_tokens(code)), self)
            made = read(words)
        except _Unread:
            return None
        for word in words.enumerated:
            self.tell_word(word)
        return made


def assigned(code: str) -> Iterator[str]:
    """The names that a script sets."""
    for token, after in _pairs(code):
        if after in (":=", "=", "+=", "-=", "*=", "/=") and NAME.fullmatch(token):
            yield token


def numbered(code: str) -> Iterator[str]:
    """The names that a script sets to a number, or changes by one."""
    tokens = [token for token, _ in _pairs(code)]
    for name, sign, value in zip(tokens, tokens[1:], tokens[2:], strict=False):
        is_set = sign in (":=", "=") and (value[:1].isdigit() or value == "-")
        if is_set or sign in ("-=", "*=", "/="):
            yield name


def happens(code: str) -> Iterator[tuple[str, str]]:
    """What a script “needs” and “sets”, by name, in its order."""
    for statement in _STATEMENT.findall(code):
        yield from (("needs", name) for name in used(statement))
        yield from (("sets", name) for name in assigned(statement))


def used(code: str) -> Iterator[str]:
    """The names in a script whose values it needs."""
    for token, after in _pairs(code):
        is_name = NAME.fullmatch(token) and token not in ("true", "false")
        if is_name and after not in (":=", "="):
            yield token


def _pairs(code: str) -> Iterator[tuple[str, str]]:
    """The words of a script, each with the one behind it; none of what cannot be read."""
    try:
        yield from itertools.pairwise([*_tokens(code), ""])
    except _Unread:
        return


def _tokens(code: str) -> Iterator[str]:
    at, code = 0, code.rstrip()
    while at < len(code):
        found = _TOKEN.match(code, at)
        if found is None:
            raise _Unread
        at = found.end()
        yield found[0].strip()


class _Words:
    """The words of one script, read from the left."""

    def __init__(self, tokens: list[str], known: Reader) -> None:
        self._tokens = tokens
        self._known = known
        self._at = 0
        self._depth = 0
        self.enumerated: list[str] = []

    def statements(self) -> list[Made]:
        made = []
        while self._next():
            if not self._skip(";"):
                made.append(self._statement())
                if self._next() and not self._skip(";"):
                    raise _Unread
        if not made:
            raise _Unread
        return made

    def whole_condition(self) -> Made:
        condition = self._as_condition(self._choice())
        self._skip(";")
        if self._next():
            raise _Unread
        return condition

    def _next(self) -> str:
        return self._tokens[self._at] if self._at < len(self._tokens) else ""

    def _take(self) -> str:
        token = self._next()
        self._at += 1
        return token

    def _skip(self, token: str) -> bool:
        is_there = self._next() == token
        self._at += is_there
        return is_there

    def _statement(self) -> Made:
        key, sign = self._take(), self._take()
        if not NAME.fullmatch(key) or key in ("true", "false"):
            raise _Unread
        if sign in (":=", "="):
            value = self._choice()
        elif sign[:1] in _RECKONED and sign[1:] == "=":
            value = _two(
                "math.arithmetic", "operation", _RECKONED[sign[0]], _entry(key), self._choice()
            )
        else:
            raise _Unread
        return set_value(key, value)

    def _choice(self) -> Value:
        self._depth += 1
        if self._depth > _DEEPEST:
            raise _Unread
        value = self._pair(0)
        if self._skip("?"):
            made = Made("logic.choose", inputs={"condition": self._as_condition(value)})
            fill(made, "a", *self._choice())
            if not self._skip(":"):
                raise _Unread
            fill(made, "b", *self._choice())
            value = None, made
        self._depth -= 1
        return value

    def _pair(self, level: int) -> Value:
        if level == len(_LEVELS):
            return self._single()
        value = self._pair(level + 1)
        while self._next() in _LEVELS[level]:
            value = self._joined(self._take(), value, self._pair(level + 1))
        return value

    def _joined(self, sign: str, a: Value, b: Value) -> Value:
        if sign in _JOINED:
            made = Made("logic.junction", {"junction": _JOINED[sign]})
            made.inputs = {"a": self._as_condition(a), "b": self._as_condition(b)}
            return None, made
        if sign in _COMPARED:
            return _two("logic.compare", "comparison", _COMPARED[sign], a, b)
        if sign in _RECKONED:
            if any(isinstance(one, str) for one, _ in (a, b)):
                raise _Unread  # texts are joined by two dots
            return _two("math.arithmetic", "operation", _RECKONED[sign], a, b)
        made = Made("text.join", groups={"item": 2})
        for key, (value, plugged) in (("item.1", a), ("item.2", b)):
            fill(made, key, value if plugged or isinstance(value, str) else str(value), plugged)
        return None, made

    def _single(self) -> Value:
        token = self._take()
        if token == "(":
            value = self._choice()
            if not self._skip(")"):
                raise _Unread
            return value
        if token == "!":
            return None, turned(self._as_condition(self._deeper()))
        if token == "-":
            typed, plugged = self._deeper()
            if isinstance(typed, int | float):
                return -typed, None
            return _two("math.arithmetic", "operation", "subtract", (0, None), (typed, plugged))
        if token in ("true", "false"):
            return None, Made("logic.truth", {"truth": token})
        if NAME.fullmatch(token):
            return self._name(token)
        if token[:1] in ("'", '"'):
            return token[1:-1], None
        if token[:1].isdigit() or (token[:1] == "." and token[1:2].isdigit()):
            number = float(token)
            return (int(token) if token.isdigit() and len(token) < 16 else number), None
        raise _Unread

    def _deeper(self) -> Value:
        self._depth += 1
        if self._depth > _DEEPEST:
            raise _Unread
        value = self._single()
        self._depth -= 1
        return value

    def _name(self, name: str) -> Value:
        if self._known.is_entry(name) or not name.isupper():
            return _entry(name)
        self.enumerated.append(name)
        return name, None

    def _as_condition(self, value: Value) -> Made:
        typed, made = value
        if made is None:
            if isinstance(typed, str):
                raise _Unread
            return Made("logic.truth", {"truth": "true" if typed else "false"})
        if made.type in ("logic.compare", "logic.junction", "logic.not", "logic.truth"):
            return made
        if made.type != "tree.value":
            raise _Unread
        if self._known.is_number(str(made.fields["key"])):
            return Made("logic.compare", {"comparison": "not_equal", "b": 0}, {"a": made})
        truth = Made("logic.truth", {"truth": "true"})
        return Made("logic.compare", {"comparison": "equal"}, {"a": made, "b": truth})


def _entry(key: str) -> Value:
    return None, Made("tree.value", {"key": key})


def _two(kind: str, choice: str, chosen: str, a: Value, b: Value) -> Value:
    made = Made(kind, {choice: chosen})
    fill(made, "a", *a)
    fill(made, "b", *b)
    return None, made


def turned(condition: Made) -> Made:
    """The condition that is yes when another one is no."""
    sign = condition.fields.get("comparison") if condition.type == "logic.compare" else None
    if sign in _TURNED:
        condition.fields["comparison"] = _TURNED[str(sign)]
        return condition
    return Made("logic.not", inputs={"a": condition})


def fill(made: Made, key: str, value: FieldValue | None, plugged: Made | None) -> None:
    """Put what is typed, or a block, into a slot; the slot keeps its own otherwise."""
    if plugged is not None:
        made.inputs[key] = plugged
    elif value is not None:
        made.fields[key] = value


def set_value(key: str, value: Value) -> Made:
    """The block that sets a value of the tree."""
    made = Made("tree.set", {"key": key})
    fill(made, "value", *value)
    return made


# Blocks as scripts.


@dataclass(slots=True)
class Writer:
    """Makes scripts of blocks; ``value`` and ``plugged`` are what stands in a slot of a block."""

    value: Callable[[Block, str], object]
    plugged: Callable[[Block, str], Block | None]

    def written(self, block: Block) -> str | None:
        """The script of a block that gives a value, or None."""
        kind = block.type
        if kind == "tree.value":
            return self.key(block)
        if kind == "logic.truth":
            return str(self.value(block, "truth"))
        if kind == "logic.not":
            asked = self.slot(block, "a")
            return None if asked is None else f"!({plain(asked)})"
        if kind == "logic.compare":
            return self._two(block, _sign(_COMPARED, self.value(block, "comparison")))
        if kind == "math.arithmetic":
            return self._two(block, _sign(_RECKONED, self.value(block, "operation")))
        if kind == "logic.junction" and not block.groups.get("more"):
            return self._two(block, _sign(_JOINED, self.value(block, "junction")))
        if kind == "text.join" and block.groups.get("item") == 2:
            return self._two(block, "..", "item.1", "item.2")
        if kind == "logic.choose":
            parts = [self.slot(block, key) for key in ("condition", "a", "b")]
            return None if None in parts else f"({parts[0]} ? {parts[1]} : {parts[2]})"
        return None

    def slot(self, block: Block, key: str) -> str | None:
        """The script of what stands in a slot, or None."""
        plugged = self.plugged(block, key)
        if plugged is not None:
            return self.written(plugged)
        typed = self.value(block, key)
        if isinstance(typed, int | float) and not isinstance(typed, bool):
            return number_text(typed) if typed >= 0 else f"-{number_text(-typed)}"
        if not isinstance(typed, str) or "'" in typed or "\\" in typed or not typed.isprintable():
            return None
        return f"'{typed}'"

    def key(self, block: Block) -> str | None:
        """The name of a value, if a script can have it."""
        key = str(self.value(block, "key"))
        return key if NAME.fullmatch(key) else None

    def _two(self, block: Block, sign: str | None, *keys: str) -> str | None:
        a, b = (self.slot(block, key) for key in keys or ("a", "b"))
        return None if None in (a, b, sign) else f"({a} {sign} {b})"


def plain(script: str) -> str:
    """A script without the brackets around all of it."""
    if not script.startswith("("):
        return script
    depth = 0
    for at, letter in enumerate(re.sub(r"'[^']*'", lambda text: "x" * len(text[0]), script)):
        depth += (letter == "(") - (letter == ")")
        if depth == 0:
            return script[1:-1] if at == len(script) - 1 else script
    return script


def _sign(signs: dict[str, str], chosen: object) -> str | None:
    return next((sign for sign, choice in signs.items() if choice == chosen), None)
