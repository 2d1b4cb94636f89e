"""What a person types, understood: the words of a language's blocks, and what fills their slots.

Words are found exactly, begun, or nearly so.
"""

from __future__ import annotations

import ast
import re
import warnings
from collections import defaultdict
from collections.abc import Container, Mapping
from dataclasses import dataclass, field

from nep_studio.blocks.arithmetic import typed_number
from nep_studio.blocks.definitions import Definition, Group, Part, Slot
from nep_studio.blocks.from_python.learning import Made
from nep_studio.blocks.from_python.naming import SourceNames
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.finding import folded
from nep_studio.blocks.slots import FieldValue

from ..deployment import can_be_stopped, names_used, robot_entries, rules
from ..from_python.values import ValueReader
from ..generate.names import python_name
from ..program import ALL_ROBOTS, Project
from ..text import sentence

# Typed sentences of languages that are written without spaces: where their words are.

_SIGNS = "\u3040-\u30ff\u3400-\u9fff\uff66-\uff9f"
_UNSPACED = re.compile(f"[{_SIGNS}]")
_RUN = re.compile(f'"[^"]*"|“[^”]*”|「[^」]*」|[{_SIGNS}]+|\\s+|[^{_SIGNS}\\s]+')
_SHORTEST_END = 2
"""Shorter words may be the end of another one: they are looked for behind other signs only."""


def is_unspaced(text: str) -> bool:
    """Whether a text has signs of a writing without spaces, such as Japanese."""
    return _UNSPACED.search(text) is not None


def spaced(typed: str, words: Container[str]) -> str:
    """A typed sentence with spaces between its words, as far as ``words`` tell them apart.

    In “NAOがこんにちはと言う” they are “NAO が こんにちは と言う”: a word behind a name or number,
    and the word at the end. The middle is what a person says, which is left alone.
    """
    if not is_unspaced(typed):
        return typed
    pieces: list[str] = []
    before = ""
    for run in _RUN.findall(typed):
        is_behind = bool(before) and not before.isspace()
        known = _UNSPACED.match(run) is not None
        pieces += _split(run, words, is_behind=is_behind) if known else [run]
        before = run
    return " ".join(piece.strip() for piece in pieces if piece.strip())


def _split(run: str, words: Container[str], *, is_behind: bool) -> list[str]:
    plain = folded(run)
    if len(plain) != len(run) or plain in words:
        return [run]
    lengths = range(len(run) - 1, 0, -1)
    first = next((n for n in lengths if plain[:n] in words), 0) if is_behind else 0
    rest = range(len(run) - first - 1, _SHORTEST_END - 1, -1)
    last = next((n for n in rest if plain[-n:] in words), 0)
    end = len(run) - last
    return [part for part in (run[:first], run[first:end], run[end:]) if part]


EXACT, BEGUN, ALIKE, NEAR = 10.0, 7.0, 6.0, 3.0
"""How much a typed word counts that is a word, begins one, means one, or is nearly one."""
WHOLE = 2.0
"""What a beginning counts more the more of the word it is, so that less is left to guess."""
NEAR_LETTERS = 4
"""Shorter words are nearly too many others."""
MOST_LANGUAGES = 8
"""So many vocabularies are kept: the languages that a person may change between, and more."""

_SYNONYMS = {
    "say": "speak talk tell speech voice",
    "says": "speak talk tell speech voice",
    "wait": "pause sleep delay",
    "repeat": "loop for times",
    "forever": "always endless loop",
    "walks": "go move step",
    "turns": "rotate spin",
    "plays": "perform do animation move dance",
    "takes": "go posture pose",
    "stop": "end halt quit exit",
    "stops": "end halt cancel",
    "set": "let assign make put",
    "change": "increase add count",
    "random": "dice chance",
    "lights": "led colour color eyes",
    "together": "parallel same",
    "if": "when condition",
    "join": "combine concatenate",
    "looks": "head gaze see",
    "human": "person",
    "else": "otherwise",
    "ask": "question",
}
"""Other words that people type for words of the English sentences."""


@dataclass(frozen=True, slots=True)
class Entry:
    """A definition with its words, each with its place among the parts of the sentence."""

    definition: Definition
    words: tuple[tuple[str, int], ...]
    """Also those of parts that unfold."""
    choices: Mapping[str, tuple[tuple[str, str], ...]]
    """By slot, the values that can be chosen: the label without case and accents, and the value."""
    folded: Mapping[int, str]
    """The groups that are not there in a new block, by their places in the sentence."""


@dataclass(slots=True)
class Vocabulary:
    """The entries of a language, and which have a word or a choice that begins with ..."""

    entries: list[Entry] = field(default_factory=list)
    by_word: dict[str, set[int]] = field(default_factory=lambda: defaultdict(set))
    by_choice: dict[str, set[int]] = field(default_factory=lambda: defaultdict(set))
    meanings: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))

    def words_like(self, typed: str) -> dict[str, float]:
        """The words that a typed word may stand for, each with how well it does."""
        found = {word: ALIKE for word in self.meanings.get(typed, ())}
        is_glued = len(typed) > 1 and is_unspaced(typed)  # its words have no spaces between them
        for word in self.by_word:
            if word == typed:
                found[word] = EXACT
            elif word.startswith(typed) or (is_glued and typed in word):
                found[word] = max(found.get(word, 0), BEGUN + WHOLE * len(typed) / len(word))
        if not found and len(typed) >= NEAR_LETTERS:
            found = {word: NEAR for word in self.by_word if is_near(typed, word)}
        return found


def vocabulary(language: Language) -> Vocabulary:
    """The vocabulary of a language, made once for what it defines."""
    key = (id(language.definitions), len(language.definitions), id(language.choices))
    known = _KNOWN.get(key)
    now = tuple(language.definitions.values()), dict(language.choices)
    if known is None or known[0] != now:
        if len(_KNOWN) > MOST_LANGUAGES:
            _KNOWN.clear()
        known = _KNOWN[key] = (now, _made(language))
    return known[1]


_Known = tuple[tuple[Definition, ...], dict[str, Mapping[str, str]]]
_KNOWN: dict[tuple[int, ...], tuple[_Known, Vocabulary]] = {}


def is_near(typed: str, word: str) -> bool:
    """Whether a word becomes another one by one letter more, less, other, or by two exchanged."""
    if abs(len(typed) - len(word)) > 1 or typed[0] != word[0]:
        return False
    start = next((i for i, (a, b) in enumerate(zip(typed, word, strict=False)) if a != b), -1)
    if start < 0:
        return True
    rest, other = typed[start:], word[start:]
    exchanged = rest[:2] == other[1::-1] and rest[2:] == other[2:]
    return exchanged or rest[1:] == other[1:] or rest[1:] == other or rest == other[1:]


def _made(language: Language) -> Vocabulary:
    found = Vocabulary()
    for number, definition in enumerate(language.definitions.values()):
        # The words of a sentence, with the part of each; of what is repeated only what a new
        # block has
        words: list[tuple[str, int]] = []
        for place, part in enumerate(definition.parts):
            for text in _texts(part, definition):
                words += [(word, place) for word in split_words(text)]
        away = {
            place: part.name
            for place, part in enumerate(definition.parts)
            if isinstance(part, Group) and part.unfolds
        }
        entry = Entry(definition, tuple(words), _choices(definition, language), away)
        found.entries.append(entry)
        for word, _ in entry.words:
            found.by_word[word].add(number)
            for other in _SYNONYMS.get(word, "").split():
                found.meanings[other].add(word)
        for labels in entry.choices.values():
            for label, _ in labels:
                for word in label.split():
                    found.by_choice[word].add(number)
    return found


def split_words(text: str) -> list[str]:
    """The words of a text without case, accents, and signs around them."""
    return [
        word for word in (w.strip("“”\"'.,:;()?!、。「」") for w in folded(text).split()) if word
    ]


def _texts(part: Part, definition: Definition) -> list[str]:
    if isinstance(part, str):
        return [part]
    if isinstance(part, Group) and (definition.minimum.get(part.name, 0) or part.unfolds):
        return [inner for inner in part.parts if isinstance(inner, str)]
    return []


def _choices(definition: Definition, language: Language) -> dict[str, tuple[tuple[str, str], ...]]:
    tables = {}
    repeated = {group.name for group in definition.groups.values() if not group.unfolds}
    for slot in definition.slots.values():
        has_table = slot.kind.table or slot.kind.name == "choice"
        if has_table and slot.group not in repeated and not slot.master:
            offered = language.choices_of(slot).items()
            labels = ((f"{label} {value}".replace("_", " "), value) for value, label in offered)
            tables[slot.name] = tuple((folded(label), value) for label, value in labels)
    return tables


# What typed words mean in a slot: a number, a choice, a variable, a text, a small expression.

_TYPED_SIGNS = str.maketrans({"×": "*", "÷": "/", "−": "-", "≤": "<", "≥": ">", "≠": "!"})  # noqa: RUF001 signs that people type
_LONGER_SIGNS = (("≤", "<="), ("≥", ">="), ("≠", "!="), ("^", "**"))
_OPERATORS = re.compile(r"[-+*/%<>=×÷−≤≥≠^]|\b(and|or|not)\b")  # noqa: RUF001 signs that people type


# How sure a filling is, beside what words of the sentence count (EXACT to NEAR).

CHOSEN = 8.0
"""What a choice begins with, or is: it was meant, more than any begun word (BEGUN)."""
CHOICE_BEGUN, CHOICE_WHOLE = 4.0, 2.0
"""The beginnings of a choice's words, and more the more of it was typed: together less than a
begun word of a sentence, since many choices begin alike."""
NAMED = 6.0
"""A robot, a variable or an expression that is there can hardly mean anything else."""
FITTING = 5.0
"""A value of the kind that the slot wants, such as a number; a variable among other values."""
OTHER_NUMBER = 4.0
"""A number in a slot that takes other values too."""
QUOTED, FREE = 3.0, 2.0
"""A text: in quotes it was meant as one; without, it may be anything, and so may a new name."""
LONGEST_EXPRESSION = 300
"""Longer ones are pasted, not typed, and could take long to read."""


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
        for name in names_used(self.project, self.language, "robot"):
            self.robots[folded(name)] = name
        self.robots |= {"all robots": ALL_ROBOTS, "all": ALL_ROBOTS}
        self.variables = {folded(v.name): v.id for v in self.project.variables}

    def fill(self, entry: Entry, slot: Slot, text: str) -> Filling | None:
        """What a slot of a block takes from a text, or None."""
        plain = folded(text.strip())
        found, held = self._typed(entry, slot, text, plain), self._held(slot, plain)
        if found is None or held is None:
            return found or held
        return max(found, held, key=lambda filling: filling.quality)

    def _typed(self, entry: Entry, slot: Slot, text: str, plain: str) -> Filling | None:
        """What stands for itself."""
        kind = slot.kind.name
        if kind in ("choice", "gesture"):
            best: Filling | None = None
            for label, value in entry.choices.get(slot.name, ()):
                quality = _likeness(plain, label)
                if quality and (best is None or quality > best.quality):
                    best = Filling(value, quality)
            return best or self._free_gesture(slot, plain)
        if kind == "robot":
            name = self.robots.get(plain)
            return Filling(name, NAMED) if name is not None else None
        if kind == "rule":
            return self._rule(plain)
        if kind == "variable":
            return self._variable(plain, text.strip())
        if kind == "clock":
            return self._checked(slot, slot.kind.read(text), NAMED)
        if slot.kind.words:
            return self._checked(slot, slot.kind.words.get(plain, plain), FITTING)
        return self._value(slot, text.strip(), plain)

    def expression(self, text: str) -> tuple[Made, str] | None:
        """The value block that a small expression is, with its result; or None."""
        tree = _parsed(text)
        if tree is None or isinstance(tree, ast.Name | ast.Constant):
            return None
        known = self._reader().names.variables
        if not all(node.id in known for node in ast.walk(tree) if isinstance(node, ast.Name)):
            return None
        found = self._reader().blocks(tree)
        return next(((made, result) for made, result in found if not _has_code(made)), None)

    def _held(self, slot: Slot, plain: str) -> Filling | None:
        """The block of the variable that is called so."""
        getter = self._reader().type_of("variable") if plain in self.variables else ""
        if not getter or self.language.definitions[getter].result not in slot.fits:
            return None
        return Filling(Made(getter, {"variable": self.variables[plain]}), FITTING)

    def _value(self, slot: Slot, text: str, plain: str) -> Filling | None:
        number = number_in(text)
        if slot.pluggable and _OPERATORS.search(text) and number is None:
            found = self.expression(text)
            if found is not None and found[1] in slot.fits:
                return Filling(found[0], NAMED)
        if slot.kind.is_number:
            return self._checked(slot, number, FITTING) if number is not None else None
        if number is not None and slot.why_not(number) is None:
            return Filling(number, OTHER_NUMBER)
        unquoted = text[1:-1] if is_quoted(text) else text
        return self._checked(slot, unquoted, QUOTED if is_quoted(text) else FREE)

    def _variable(self, plain: str, text: str) -> Filling | None:
        if plain in self.variables:
            return Filling(self.variables[plain], NAMED)
        if " " in text or not python_name(text, "").isidentifier() or number_in(text) is not None:
            return None
        return Filling("", FREE, new_variable=text)

    def _rule(self, plain: str) -> Filling | None:
        """The rule whose first block says this, or begins with it."""
        best: Filling | None = None
        for chain in rules(self.project, self.language):
            if not can_be_stopped(self.project, self.language, chain[0]):
                continue
            quality = _likeness(plain, folded(sentence(self.project, self.language, chain[0])))
            # its words are meant as they would be in a sentence of their own
            quality += BEGUN * plain.count(" ") if quality else 0.0
            if quality and (best is None or quality > best.quality):
                best = Filling(chain[0], quality)
        return best

    def _free_gesture(self, slot: Slot, plain: str) -> Filling | None:
        if slot.kind.name == "gesture" and plain and not self.language.choices_of(slot):
            return Filling(plain.replace(" ", "_"), FREE)
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


def number_in(text: str) -> int | float | None:
    """The number that a text is, with a point or a comma, or None."""
    number = typed_number(text)
    return None if isinstance(number, str) else number


def is_quoted(text: str) -> bool:
    """Whether a text stands in quotes."""
    return len(text) > 1 and text[0] in "\"'“„«" and text[-1] in "\"'”“»"


def _likeness(plain: str, label: str) -> float:
    if label == plain or label.startswith(f"{plain} "):
        return CHOSEN
    words = label.split()
    if all(any(word.startswith(typed) for word in words) for typed in plain.split()):
        return CHOICE_BEGUN + CHOICE_WHOLE * len(plain) / max(len(label), 1)
    return 0.0


def _parsed(text: str) -> ast.expr | None:
    for sign, python in _LONGER_SIGNS:
        text = text.replace(sign, python)
    text = re.sub(r"(?<![<>=!])=(?!=)", "==", text.translate(_TYPED_SIGNS))
    if len(text) > LONGEST_EXPRESSION:
        return None
    try:
        with warnings.catch_warnings(action="ignore"):
            return ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def _has_code(made: Made) -> bool:
    return made.type.startswith("code.") or any(map(_has_code, made.inner()))
