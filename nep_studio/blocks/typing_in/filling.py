"""What typed words mean in a slot: a number, a choice, a variable, a text, a small expression."""

from __future__ import annotations

import ast
import re
import warnings
from dataclasses import dataclass, field

from nep_studio.blocks.from_python.learning import Made
from nep_studio.blocks.slots import FieldValue

from ..deployment import robot_entries, robots_used
from ..from_python.names import SourceNames
from ..from_python.values import ValueReader
from ..generate.names import python_name
from ..language import Language
from ..operations.finding import folded
from ..program import ALL_ROBOTS, Project
from ..sentence import Slot
from .vocabulary import Entry

_NUMBER = re.compile(r"[-+]?([0-9]+([.,][0-9]*)?|[.,][0-9]+)")
_TYPED_SIGNS = str.maketrans({"×": "*", "÷": "/", "−": "-", "≤": "<", "≥": ">", "≠": "!"})  # noqa: RUF001 signs that people type
_LONGER_SIGNS = (("≤", "<="), ("≥", ">="), ("≠", "!="), ("^", "**"))
_OPERATORS = re.compile(r"[-+*/%<>=×÷−≤≥≠^]|\b(and|or|not)\b")  # noqa: RUF001 signs that people type


@dataclass(slots=True)
class Filling:
    """What goes into a slot, how sure that is, and variables (by name) that have to be made."""

    value: FieldValue | Made
    quality: float
    new_variable: str = ""


@dataclass(slots=True)
class Filler:
    """Understands typed words for one language and project."""

    language: Language
    project: Project
    robots: dict[str, str] = field(default_factory=dict)
    variables: dict[str, str] = field(default_factory=dict)
    reader: ValueReader | None = None

    def __post_init__(self) -> None:
        for entry in robot_entries(self.project, self.language):
            self.robots[folded(entry.name)] = entry.name
        for name in robots_used(self.project, self.language):
            self.robots[folded(name)] = name
        self.robots |= {"all robots": ALL_ROBOTS, "all": ALL_ROBOTS}
        self.variables = {folded(v.name): v.id for v in self.project.variables}

    def fill(self, entry: Entry, slot: Slot, text: str) -> Filling | None:
        """What a slot of a block takes from a text, or None."""
        plain = folded(text.strip())
        kind = slot.kind.name
        if kind in ("choice", "gesture"):
            return _choice(entry, slot, plain) or self._free_gesture(slot, plain)
        if kind == "robot":
            name = self.robots.get(plain)
            return Filling(name, 6) if name is not None else None
        if kind == "variable":
            return self._variable(plain, text.strip())
        if slot.kind.words:
            return self._checked(slot, slot.kind.words.get(plain, plain), 5)
        return self._value(slot, text.strip(), plain)

    def expression(self, text: str) -> tuple[Made, str] | None:
        """The value block that a small expression is, with its result; or None."""
        tree = _parsed(text)
        if tree is None or isinstance(tree, ast.Name | ast.Constant):
            return None
        if not self._knows_all(tree):
            return None
        found = self._reader().blocks(tree)
        return next(((made, result) for made, result in found if not _has_code(made)), None)

    def _value(self, slot: Slot, text: str, plain: str) -> Filling | None:
        if slot.kind.pluggable and plain in self.variables:
            getter = self._reader().type_of("variable")
            result = self.language.definitions[getter].result if getter else ""
            if result in slot.kind.fits:
                return Filling(Made(getter, {"variable": self.variables[plain]}), 5)
        if slot.kind.pluggable and _OPERATORS.search(text) and not _NUMBER.fullmatch(text):
            found = self.expression(text)
            if found is not None and found[1] in slot.kind.fits:
                return Filling(found[0], 6)
        number = number_in(text)
        if slot.kind.is_number:
            return self._checked(slot, number, 5) if number is not None else None
        if number is not None and slot.why_not(number) is None:
            return Filling(number, 4)
        unquoted = text[1:-1] if is_quoted(text) else text
        return self._checked(slot, unquoted, 3 if is_quoted(text) else 2)

    def _variable(self, plain: str, text: str) -> Filling | None:
        if plain in self.variables:
            return Filling(self.variables[plain], 6)
        if " " in text or not python_name(text, "").isidentifier() or number_in(text) is not None:
            return None
        return Filling("", 2, new_variable=text)

    def _free_gesture(self, slot: Slot, plain: str) -> Filling | None:
        if slot.kind.name == "gesture" and plain and not self.language.choices_of(slot):
            return Filling(plain.replace(" ", "_"), 2)
        return None

    def _checked(self, slot: Slot, value: FieldValue, quality: float) -> Filling | None:
        return Filling(value, quality) if slot.why_not(value) is None else None

    def _reader(self) -> ValueReader:
        if self.reader is None:
            names = SourceNames(
                variables={python_name(v.name, "variable"): v.id for v in self.project.variables}
            )
            self.reader = ValueReader(self.language, names)
        return self.reader

    def _knows_all(self, tree: ast.expr) -> bool:
        known = self._reader().names.variables
        return all(node.id in known for node in ast.walk(tree) if isinstance(node, ast.Name))


def number_in(text: str) -> int | float | None:
    """The number that a text is, with a point or a comma, or None."""
    if not _NUMBER.fullmatch(text):
        return None
    plain = text.replace(",", ".")
    value = float(plain)
    return int(value) if value.is_integer() and "." not in plain else value


def is_quoted(text: str) -> bool:
    """Whether a text stands in quotes."""
    return len(text) > 1 and text[0] in "\"'“„«" and text[-1] in "\"'”“»"


def _choice(entry: Entry, slot: Slot, plain: str) -> Filling | None:
    best: Filling | None = None
    for label, value in entry.choices.get(slot.name, ()):
        quality = _likeness(plain, label)
        if quality and (best is None or quality > best.quality):
            best = Filling(value, quality)
    return best


def _likeness(plain: str, label: str) -> float:
    if label == plain or label.startswith(f"{plain} "):
        return 8.0
    words = label.split()
    if all(any(word.startswith(typed) for word in words) for typed in plain.split()):
        return 4.0 + 2.0 * len(plain) / max(len(label), 1)
    return 0.0


def _parsed(text: str) -> ast.expr | None:
    for sign, python in _LONGER_SIGNS:
        text = text.replace(sign, python)
    text = re.sub(r"(?<![<>=!])=(?!=)", "==", text.translate(_TYPED_SIGNS))
    if len(text) > 300:
        return None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def _has_code(made: Made) -> bool:
    waiting = [made]
    while waiting:
        made = waiting.pop()
        if made.type.startswith("code."):
            return True
        waiting += made.inner()
    return False
