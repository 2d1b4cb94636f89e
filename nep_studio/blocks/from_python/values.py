"""Expressions in a Python text as values of blocks."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial

from nep_studio.blocks.code_text import CodeTextRefused, read_value
from nep_studio.blocks.definitions import Call, Definition, Slot
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import CALL, PARAMETER, parameters
from nep_studio.blocks.program import split_slot
from nep_studio.blocks.slots import TEXT_RESULTS, FieldValue, constant

from ..generate.expressions import call, known_whole
from ..generate.kinds import ANY, NUMBER, RESULT_KINDS, TABLE, TEXT, WHOLE, Seen, are, kinds_of
from .equal_forms import SAY, other_values
from .joined import TOLD, is_number
from .learning import (
    BODY,
    PART,
    SLOT,
    VARIABLE_NAME,
    Made,
    Pattern,
    beginning,
    learned,
    marked,
    position_of,
    word_pattern,
)
from .naming import SourceNames, is_junction, may_be, within

# Match Python with a learned pattern: what stands where the markers are.

_UNSAID = frozenset({"ctx", "type_comment", "kind", "type_ignores", "type_params"})
_SAID = {
    kind: sorted(set(kind._fields) - _UNSAID, key=lambda field: field not in ("op", "ops"))
    for kind in vars(ast).values()
    if isinstance(kind, type) and issubclass(kind, ast.AST)
}
"""The fields of each kind of nodes that say what it does; operators first, seen at a glance."""


def match(pattern: Pattern, nodes: Sequence[ast.AST]) -> Found | None:
    """What a pattern finds in as many nodes as it has, or None when they differ."""
    found = Found(pattern.keys)
    return found if found.lists(pattern.nodes, nodes) else None


@dataclass(slots=True)
class Found:
    """What stands where the markers of a pattern are; ``keys`` are its slots by position."""

    keys: tuple[str, ...]
    slots: dict[str, ast.expr] = field(default_factory=dict)
    words: dict[str, str] = field(default_factory=dict)
    bodies: dict[str, list[ast.stmt]] = field(default_factory=dict)
    parts: dict[str, str] = field(default_factory=dict)
    variable: str = ""

    def lists(self, wanted: Sequence[object], there: Sequence[object]) -> bool:
        """Whether nodes are as wanted, each in its turn."""
        if wanted and isinstance(wanted[-1], ast.Expr):
            name, above = wanted[-1].value, len(wanted) - 1
            if isinstance(name, ast.Name) and (body := marked(BODY, name.id)):
                if rest := list(there[above:]):
                    self.bodies[body] = rest  # type: ignore[assignment]
                is_there = bool(rest) or (above > 0 and len(there) == above)
                return is_there and all(map(self.one, wanted[:-1], there[:above]))
        return len(wanted) == len(there) and all(map(self.one, wanted, there))

    def one(self, wanted: object, there: object) -> bool:
        """Whether a node is as wanted; notes what stands where the markers are."""
        if isinstance(wanted, ast.Name):
            return self._name(wanted.id, there)
        if isinstance(wanted, ast.Constant):
            return self._constant(wanted.value, there)
        if isinstance(wanted, ast.Call) and (key := _whole_slot(wanted)):
            return isinstance(there, ast.expr) and self._slot(key, _without_int(there))
        if isinstance(wanted, ast.Lambda) and _is_number(there):
            return self.one(wanted.body, there)  # a number that is typed needs no lambda
        if type(wanted) is not type(there):
            return False
        if isinstance(wanted, list):
            return self.lists(wanted, there)  # type: ignore[arg-type]
        if not isinstance(wanted, ast.AST):
            return wanted == there
        if isinstance(wanted, ast.FunctionDef) and isinstance(there, ast.FunctionDef):
            return (
                not (there.returns or there.args.args)
                and self.lists(wanted.decorator_list, there.decorator_list)
                and self._part(wanted.name, there.name)
                and self.lists(wanted.body, there.body)
            )
        if isinstance(wanted, ast.If) and _is_elif(wanted) != _is_elif(there):
            return False
        for name in _SAID[type(wanted)]:
            if not self.one(getattr(wanted, name, None), getattr(there, name, None)):
                return False
        return True

    def _name(self, wanted: str, there: object) -> bool:
        if key := marked(SLOT, wanted):
            return isinstance(there, ast.expr) and self._slot(key, there)
        if not isinstance(there, ast.Name):
            return False
        if wanted == VARIABLE_NAME:
            is_same = self.variable in ("", there.id)
            self.variable = there.id
            return is_same
        return self._part(wanted, there.id) if marked(PART, wanted) else wanted == there.id

    def _part(self, wanted: str, there: str) -> bool:
        return self.parts.setdefault(wanted, there) == there

    def _slot(self, key: str, there: ast.expr) -> bool:
        known = self.slots.setdefault(key, there)
        return known is there or ast.dump(known) == ast.dump(there)

    def _constant(self, wanted: object, there: object) -> bool:
        marker = position_of(wanted)
        if marker is not None:
            position, added = marker
            number = known_whole(there) if isinstance(there, ast.expr) else None
            return number is not None and self._slot(self.keys[position], constant(number - added))
        if not isinstance(there, ast.Constant):
            return False
        words = word_pattern(wanted) if isinstance(wanted, str) else None
        if words is None or not isinstance(there.value, str):
            return type(wanted) is type(there.value) and wanted == there.value
        matched = words[0].fullmatch(there.value)
        if matched is None:
            return False
        for position, word in zip(words[1], matched.groups(), strict=True):
            if self.words.setdefault(self.keys[position], word) != word:
                return False
        return True


def _is_number(node: object) -> bool:
    """Whether a node is a number without a sign."""
    return isinstance(node, ast.Constant) and type(node.value) in (int, float)


def _has_rounds(made: Made) -> bool:
    """Put the last number of range(...) into a block that counts; False where it has no round.

    The block would then count down, or it is not known.
    """
    first, end, step = (made.fields.get(key) for key in ("first", "last", "step"))
    if made.inputs or not (type(first) is type(end) is type(step) is int) or not step:
        return False
    assert isinstance(first, int) and isinstance(end, int) and isinstance(step, int)
    made.fields["last"] = last = end - (1 if step > 0 else -1)
    return first <= last if step > 0 else first >= last


def _whole_slot(node: ast.Call) -> str:
    """The slot in ``int(slot)``, which is written only where the slot may give a fraction."""
    match node:
        case ast.Call(func=ast.Name(id="int"), args=[ast.Name(id=name)], keywords=[]):
            return marked(SLOT, name)
    return ""


_MADE = {
    "list": ("as_list",),
    "table": ("as_table",),
    "boolean": ("bool",),
    "checkbox": ("bool",),
    "robot": ("as_robot",),
}
_NEEDS = ("list", "table", "robot")
"""The kinds, beside numbers, of which a value is made where it may be another."""


def _without_int(node: ast.expr) -> ast.expr:
    match node:
        case ast.Call(func=ast.Name(id="int"), args=[inner], keywords=[]):
            return inner
    return node


def _is_elif(node: object) -> bool:
    """Whether what comes after an if is an elif, not an if inside an else."""
    if not isinstance(node, ast.If) or len(node.orelse) != 1:
        return False
    inner = node.orelse[0]
    return isinstance(inner, ast.If) and inner.col_offset == node.col_offset


# Read expressions: what goes into the field of a slot, and which block is plugged into it.

_DEEPEST, _DEEPEST_CODE = 150, 40
"""Values with others so deep in them stay Python; so deep in others, none stays so by itself: to
write it down takes as long as there is more in it, at each depth."""


class ValueReader:
    """Reads the expressions of one text."""

    def __init__(self, language: Language, names: SourceNames) -> None:
        self.language = language
        self.names = names
        self._learned = learned(language)
        self._by_call: dict[str, list[Definition]] = {}
        self._types: dict[str, str] = {}
        self._known: dict[int, tuple[ast.expr, list[tuple[Made, str]]]] = {}
        self._seen: Seen = {}
        self._depth = 0
        for definition in language.definitions.values():
            self._types.setdefault(definition.generator, definition.id)
            if definition.call is not None:
                self._by_call.setdefault(definition.call.name, []).append(definition)
        for definitions in self._by_call.values():  # what says more goes before what says less
            definitions.sort(key=lambda d: len(d.call.constants) if d.call else 0, reverse=True)

    def type_of(self, generator: str) -> str:
        """The type of the block that a generator makes, or an empty text."""
        return self._types.get(generator, "")

    def fill(
        self, made: Made, key: str, node: ast.expr, *, is_clear: bool = False, is_free: bool = False
    ) -> bool:
        """Put an expression into a slot of a block; False when it does not go there.

        ``is_clear``: a text must show that it is one; ``is_free``: a value of any kind will do.
        """
        slot = self.language.definitions[made.type].slots[split_slot(key)[0]]
        value = self.field(slot, node, made, key)
        if value is not None:
            made.fields[key] = value
            return True
        match node:
            case ast.List(elts=[]) if slot.kind.name == "list":
                return True
            case ast.Dict(keys=[]) if slot.kind.name == "table":
                return True
        plugged = None
        if slot.pluggable and is_free:
            found = self.blocks(within(node, self._made(slot)))
            plugged = next((made for made, result in found if result in slot.fits), None)
        elif slot.pluggable:
            plugged = self.plugged(slot, node, is_clear=is_clear)
        if plugged is None:
            return False
        made.inputs[key] = plugged
        made.written += plugged.written
        return True

    def field(self, slot: Slot, node: ast.expr, made: Made, key: str) -> FieldValue | None:
        """What the field of a slot holds so that it makes this expression, or None."""
        value = self._field(slot, node)
        if value is None or slot.why_not(value) is not None:
            return None
        if slot.kind.name == "choice":
            is_known = bool(slot.master) or self.language.why_not_choice(slot, value) is None
            return value if is_known else None
        return value

    def plugged(self, slot: Slot, node: ast.expr, *, is_clear: bool = False) -> Made | None:
        """The block that makes this expression in a slot, or None.

        Where the block makes a number, a list or a text of a value, the value alone is in it.
        """
        kind = slot.kind
        if not kind.becomes_text:
            inner = within(node, self._made(slot))
            needed = RESULT_KINDS[kind.name] if kind.name in _NEEDS else ANY
            needed = NUMBER if kind.is_number else needed
            is_truth = kind.name in ("boolean", "checkbox")
            if inner is node and not is_truth and not may_be(node, needed, self._seen):
                return None
            return next((made for made, result in self.blocks(inner) if result in kind.fits), None)
        inner, others = within(node, TOLD), kind.fits - TEXT_RESULTS
        if inner is node:
            is_text = kinds_of(node, self._seen) == TEXT
            is_text = is_text or (not is_clear and may_be(node, TEXT, self._seen))
            others = frozenset({"any"}) if is_text else frozenset()
            others |= TEXT_RESULTS
            found = sorted(self.blocks(node), key=_is_no_text)
            return next((made for made, result in found if result in others), None)
        return next((made for made, result in self.blocks(inner) if result in others), None)

    def _made(self, slot: Slot) -> tuple[str, ...]:
        """The functions that make a value what a slot needs."""
        return ("as_number",) if slot.kind.is_number else _MADE.get(slot.kind.name, ())

    def blocks(self, node: ast.expr) -> list[tuple[Made, str]]:
        """The value blocks that make an expression, with their results, the best first."""
        if is_junction(node):
            node = within(node, ("bool",))
        known = self._known.get(id(node))
        if known is None:
            self._depth += 1
            found = sorted(self._blocks(node), key=lambda made: made[0].written)
            known = self._known[id(node)] = node, found  # kept, so that its id stays its own
            self._depth -= 1
        return known[1]

    def call(self, definition: Definition, node: ast.Call) -> Made | None:
        """The block of a call, or None when the call is another one."""
        wanted = definition.call
        assert wanted is not None
        made = Made(definition.id)
        if wanted.on:
            func = node.func
            if not (isinstance(func, ast.Attribute) and self.fill(made, wanted.on, func.value)):
                return None
        elif not isinstance(node.func, ast.Name):
            return None
        given = {keyword.arg: keyword.value for keyword in node.keywords}
        for keyword, usual in wanted.constants.items():
            value = _constant(given.pop(keyword, ast.Pass()))
            if value != usual or type(value) is not type(usual):
                return None
        required = {name for name, key in wanted.keywords.items() if key not in wanted.optional}
        if len(node.args) != len(wanted.arguments) or not required <= given.keys():
            return None
        if not given.keys() <= wanted.keywords.keys() or len(given) + len(wanted.constants) < len(
            node.keywords
        ):
            return None
        if not all(map(partial(self.fill, made), wanted.arguments, self._as_given(node, wanted))):
            return None
        for name, argument in given.items():
            key = wanted.keywords[str(name)]
            if not self.fill(made, key, argument):
                return None
            is_unsaid = key in wanted.optional and key not in made.inputs
            if is_unsaid and made.fields.get(key) == definition.defaults[key]:
                return None  # the block would not write it
        return made if self._choose_masters(made) else None

    def _as_given(self, node: ast.Call, wanted: Call) -> list[ast.expr]:
        """The values of a call by their place; a robot tells a number itself."""
        match node.args:
            case [told, *more] if wanted.on and wanted.name == SAY:
                is_known = _constant(told) is not None or not is_number(told)
                return node.args if is_known else [call("str", told), *more]
        return node.args

    def called(self, node: ast.Call) -> Iterator[Made]:
        """The blocks of a call, whether they give a value or not."""
        func = node.func
        name = func.attr if isinstance(func, ast.Attribute) else getattr(func, "id", "")
        for definition in self._by_call.get(name, ()):
            if (made := self.call(definition, node)) is not None:
                yield made
        own = self.names.procedures.get(name) if isinstance(func, ast.Name) else None
        if own is not None and not node.keywords and len(node.args) == len(parameters(own)):
            made = Made(CALL + own.id)
            pairs = zip(parameters(own), node.args, strict=True)
            if all(self.fill(made, parameter.id, value) for parameter, value in pairs):
                yield made

    def made_from(self, pattern: Pattern, found: Found, *, is_other: bool = False) -> Made | None:
        """The block of a pattern with what was found in it but its bodies, or None.

        ``is_other``: it was found in another form of the text than it is written in.
        """
        made = Made(pattern.definition.id, dict(pattern.fields), groups=dict(pattern.groups))
        is_careful = bool(pattern.fractions) and not pattern.free and not is_other
        if is_careful and _are_whole(found, pattern.fractions):
            return None
        if not _may_be_table(pattern, found) or not _may_be_place(pattern, found):
            return None
        if not self.names.variables.keys().isdisjoint(found.parts.values()):
            return None  # the block has this name for itself
        is_join = pattern.definition.generator == "join"
        clear = frozenset() if is_join else pattern.clear
        for key, node in found.slots.items():
            is_free = key in pattern.free
            if not self.fill(made, key, node, is_clear=key in clear, is_free=is_free):
                return None
        if is_join and not self._is_clear_join(made, found, is_shown=bool(pattern.clear)):
            return None
        if pattern.is_range and not _has_rounds(made):
            return None
        for key, word in found.words.items():
            if pattern.definition.slots[split_slot(key)[0]].why_not(word) is not None:
                return None
            made.fields[key] = word
        if found.variable:
            if found.variable not in self.names.variables:
                return None
            made.fields["variable"] = self.names.variables[found.variable]
        return made if self._choose_masters(made) else None

    def _is_clear_join(self, made: Made, found: Found, *, is_shown: bool) -> bool:
        """Whether a part of a sum shows that it is a text: else it is a sum of numbers.

        Where ``is_shown`` is false, Python tells the first part as a text though it may be one.
        """
        told, clear = set[str](), set[str]()
        for key, node in found.slots.items():
            inner = within(node, TOLD)
            is_text = key not in made.inputs or kinds_of(node, self._seen) == TEXT
            is_text = is_text or (
                self.language.definitions[made.inputs[key].type].result in TEXT_RESULTS
            )
            if is_text or (inner is not node and kinds_of(inner) != TEXT):
                clear.add(key)
            elif inner is not node:
                told.add(key)
        return not told and bool(clear) == is_shown

    def _choose_masters(self, made: Made) -> bool:
        """Choose what a choice depends on where Python does not say it: the arm of a joint."""
        definition, known = self.language.definitions[made.type], self.language.known
        for key, value in list(made.fields.items()):
            slot = definition.slots[split_slot(key)[0]]
            if not slot.master or slot.master in made.fields:
                continue
            masters = list(known(definition.slots[slot.master].table))
            tables = {master: known(f"{slot.table}.{master}") for master in masters}
            fitting = [master for master in masters if value in tables[master]]
            if not fitting and any(tables.values()):
                return False
            default = definition.defaults.get(slot.master)
            if fitting:
                made.fields[slot.master] = default if default in fitting else fitting[0]
        return True

    def _blocks(self, node: ast.expr) -> Iterator[tuple[Made, str]]:
        if self._depth > 1 or not _is_deep(node):
            yield from self._plain_blocks(node)
        code = self.type_of("code_value")
        may_keep = bool(code) and self._depth <= _DEEPEST_CODE
        if may_keep and not isinstance(node, ast.Constant) and (text := _code(node)):
            made = Made(code, {"code": text}, written=1)
            yield made, self.language.definitions[code].result

    def _plain_blocks(self, node: ast.expr) -> Iterator[tuple[Made, str]]:
        definitions = self.language.definitions
        if isinstance(node, ast.Name):
            yield from self._named(node.id)
        if (typed := self._typed(node)) is not None:
            yield typed
        if isinstance(node, ast.Call):
            for made in self.called(node):
                if definitions[made.type].is_value:
                    yield made, definitions[made.type].result
        for form in (node, *other_values(node)):
            for pattern in self._learned.values.get(beginning(form), ()):
                found = match(pattern, [form])
                if found is None:
                    continue
                made_from = self.made_from(pattern, found, is_other=form is not node)
                if made_from is not None:
                    yield made_from, pattern.definition.result
        if isinstance(node, ast.JoinedStr) and (joined := self._f_string(node)) is not None:
            yield joined
        if (converted := self._converted(node)) is not None:
            yield converted

    def _typed(self, node: ast.expr) -> tuple[Made, str] | None:
        """The block in which a number or a text is typed that stands in Python, and its result."""
        value = _constant(node)
        generator = "text" if isinstance(value, str) else "number"
        block_type = self.type_of(generator)
        if value is None or isinstance(value, bool) or not block_type:
            return None
        definition = self.language.definitions[block_type]
        if definition.slots[generator].why_not(value) is not None:
            return None
        return Made(block_type, {generator: value}), definition.result

    def _f_string(self, node: ast.JoinedStr) -> tuple[Made, str] | None:
        """The join of the parts of an f-string, and its result; None where it says a format."""
        block_type, parts = self.type_of("join"), list(node.values)
        definition = self.language.definitions.get(block_type)
        if definition is None or len(parts) > definition.groups["item"].maximum:
            return None
        made = Made(block_type, groups={"item": max(len(parts), definition.minimum["item"])})
        for number, part in enumerate(parts, 1):
            is_plain = isinstance(part, ast.Constant) or (
                isinstance(part, ast.FormattedValue)
                and part.conversion == -1
                and part.format_spec is None
            )
            if not is_plain or not self._fill_told(made, f"item.{number}", part):
                return None
        return made, definition.result

    def _fill_told(self, made: Made, key: str, part: ast.expr) -> bool:
        """Put a part of an f-string into a slot for a text, where any value is told."""
        if not isinstance(part, ast.FormattedValue):
            return self.fill(made, key, part)
        slot, value = self.language.definitions[made.type].slots[split_slot(key)[0]], part.value
        told = ast.Call(ast.Name(TOLD[0]), [value], [])
        found = [self.plugged(slot, value), self.plugged(slot, told)]
        best = min((one for one in found if one), key=lambda one: one.written, default=None)
        if best is None:
            return False
        made.inputs[key] = best
        made.written += best.written
        return True

    def _converted(self, node: ast.expr) -> tuple[Made, str] | None:
        """The block of a text or a number that is made of the value in it, and its result."""
        made_by = {"text": TOLD, "number": ("as_number",), "robot": ("as_robot",)}
        for generator, names in made_by.items():
            inner, block_type = within(node, names), self.type_of(generator)
            if inner is node or not block_type:
                continue
            definition = self.language.definitions[block_type]
            fits = definition.slots[generator].fits
            fits = fits if generator == "robot" else fits - TEXT_RESULTS
            for made, result in self.blocks(inner):
                if result in fits:
                    whole = Made(block_type, inputs={generator: made}, written=made.written)
                    return whole, definition.result
        return None

    def _named(self, name: str) -> Iterator[tuple[Made, str]]:
        definitions = self.language.definitions
        if name in self.names.parameters:
            made = Made(PARAMETER + self.names.parameters[name])
            yield made, definitions[made.type].result
        elif name in self.names.variables and (getter := self.type_of("variable")):
            yield Made(getter, {"variable": self.names.variables[name]}), definitions[getter].result
        elif name in self.names.robots and (robot := self.type_of("robot")):
            yield Made(robot, {"robot": self.names.robots[name]}), definitions[robot].result

    def _field(self, slot: Slot, node: ast.expr) -> FieldValue | None:
        kind = slot.kind.name
        if isinstance(node, ast.Name):
            if kind == "robot":
                return self.names.robots.get(node.id)
            named = {"variable": self.names.variables, "rule": self.names.rules}.get(kind, {})
            return named.get(node.id)
        value = _constant(node)
        return None if value is None else slot.kind.from_python(value)


def _are_whole(found: Found, keys: Collection[str]) -> bool:
    """Whether all numbers that were found are surely whole ones."""
    return all(are(kinds_of(found.slots[key]), WHOLE) for key in keys if key in found.slots)


_PLACES_IN_TABLES = frozenset({"table_get", "table_set", "table_take"})


def _may_be_table(pattern: Pattern, found: Found) -> bool:
    """Whether ``x[key]`` is surely about a table, not about the item of a list."""
    if pattern.definition.generator not in _PLACES_IN_TABLES or pattern.free:
        return True
    table, key = found.slots["table"], found.slots["key"]
    return kinds_of(key) == TEXT or are(kinds_of(within(table, _MADE["table"])), TABLE)


def _may_be_place(pattern: Pattern, found: Found) -> bool:
    """Whether an index is that of a place from the start: one below 0 is from the end."""
    number = known_whole(found.slots["number"]) if "number" in found.slots else None
    is_index = any(isinstance(n, ast.Subscript) for one in pattern.nodes for n in ast.walk(one))
    return number is None or number > 0 or not is_index


def _is_no_text(made: tuple[Made, str]) -> tuple[int, bool]:
    """Sorts blocks with their results: those of texts first, unless more of it stays Python."""
    return made[0].written, made[1] not in TEXT_RESULTS


def _constant(node: ast.AST) -> str | int | float | bool | None:
    match node:
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as number)):
            is_said = not isinstance(number, bool) and (number != 0 or isinstance(number, float))
            return -number if is_said else None  # a block says -0
    if isinstance(node, ast.Constant) and isinstance(node.value, str | int | float):
        return node.value
    if isinstance(node, ast.JoinedStr):  # an f-string that says nothing but letters
        texts = [part.value for part in node.values if isinstance(part, ast.Constant)]
        return "".join(map(str, texts)) if len(texts) == len(node.values) else None
    return None


def _is_deep(node: ast.expr) -> bool:
    """Whether more values stand in each other than are read."""
    match node:
        case ast.expr(lineno=line, end_lineno=int(last), col_offset=begin, end_col_offset=int(end)):
            if line == last and end - begin < _DEEPEST:
                return False  # it has not as many letters
        case _:
            return False  # it is not of the text
    level: list[ast.AST] = [node]
    for _ in range(_DEEPEST):
        if not level:
            return False
        level = [child for one in level for child in ast.iter_child_nodes(one)]
    return bool(level)


@lru_cache(maxsize=4096)  # a text is read several times, and each value stands in others
def _code(node: ast.expr) -> str:
    """An expression as the text of a block, or an empty text where no block may hold it."""
    try:
        text = ast.unparse(node)
        read_value(text)
    except (CodeTextRefused, ValueError, RecursionError):
        return ""
    return text
