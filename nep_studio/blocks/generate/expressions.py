"""Values as expression trees: what slots hold, what reporters give, and the calls of blocks."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Callable, Mapping

from ..arithmetic import ArithmeticRefused, calculate
from ..definition_call import Call
from ..definitions import Definition
from ..errors import CodeRefused
from ..language import Language
from ..program import Block, Project, split_slot
from ..sentence import Slot
from ..values import FieldValue
from .names import NameTable, ProgramNames
from .nodes import call, constant, method_call

VARIABLE_BLOCK = "variable.get"

DEEPEST_VALUE = 60
"""How deep values may be nested: CPython takes 200 parentheses, a block makes up to three."""

_ARITHMETIC = frozenset({"number", "angle", "slider", "duration"})
_TEXTS = frozenset({"text", "lines"})
_COSTS = {"list.find": 10}
"""Blocks whose Python says an inner value twice cost more: what doubles must not go deep."""

ValueGenerator = Callable[["Expressions", Block], ast.expr]


class Expressions:
    """Makes the expression trees of one stack, and notes what they need to be there."""

    def __init__(
        self,
        project: Project,
        language: Language,
        names: ProgramNames,
        reporters: Mapping[str, ValueGenerator],
    ) -> None:
        self.project = project
        self.language = language
        self.names = names
        self.reporters = reporters
        self.api: set[str] = set()
        self.modules: set[str] = set()
        self.robots: set[str] = set()
        self.variables: dict[str, set[str]] = defaultdict(set)
        """The variables that are used, each with what it must begin as: "list", "text"."""
        self.procedure = ""
        """The own block that is being written, or an empty text."""
        self._depth = 0
        self._parts = 0
        self._part_names: NameTable | None = None

    def definition(self, block: Block) -> Definition:
        """The definition of a block; a block of an unknown type is refused."""
        definition = self.language.definitions.get(block.type)
        if definition is None:
            raise CodeRefused(
                f"This version does not know the block “{block.type}”.",
                block=block.id,
                checklist=("Update NEP Studio.", "Or take the block out of the program."),
            )
        return definition

    def slot(self, block: Block, key: str) -> ast.expr:
        """What is in a slot: the block plugged into it, else its field."""
        definition = self.definition(block)
        slot = definition.slots[split_slot(key)[0]]
        plugged = self.plugged(block, key)
        if plugged is None:
            return self._field(block, slot, key, definition.value(block, key))
        node = self.value(plugged)
        if slot.kind.name in _TEXTS and self.definition(plugged).result not in ("text", "colour"):
            return call("str", node)
        if slot.kind.name == "list" and plugged.type == VARIABLE_BLOCK:
            self.begins_as(plugged, "list")
        return node

    def plugged(self, block: Block, key: str) -> Block | None:
        """The block plugged into a slot, or None; a disabled one does not count."""
        block_id = block.inputs.get(key)
        plugged = self.project.blocks[block_id] if block_id else None
        return None if plugged is None or plugged.disabled else plugged

    def choice(self, block: Block, key: str) -> str:
        """The value of a choice slot, which is one of its table."""
        definition = self.definition(block)
        value = definition.value(block, key)
        slot = definition.slots[split_slot(key)[0]]
        reason = self.language.why_not_choice(slot, value, block, key)
        if reason is not None:
            raise CodeRefused(reason, block=block.id, checklist=("Choose another one.",))
        return str(value)

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
            raise CodeRefused(
                f"Blocks are plugged into blocks too deep: {DEEPEST_VALUE} levels at most.",
                block=block.id,
                checklist=("Set a variable to a part of this, and use the variable here.",),
            )
        node: ast.expr
        if definition.call is not None:
            node = self.call(block, definition.call)
        else:
            node = self.reporters[definition.generator](self, block)
        self._depth -= cost
        return node

    def call(self, block: Block, made: Call) -> ast.Call:
        """The call that a block stands for."""
        arguments = [self.slot(block, key) for key in made.arguments]
        keywords = {
            name: self.slot(block, key)
            for name, key in made.keywords.items()
            if key not in made.optional or not self._is_default(block, key)
        }
        if not made.on:
            return self.api_call(made.name, *arguments, **keywords)
        return method_call(self.slot(block, made.on), made.name, arguments, keywords)

    def api_call(self, name: str, /, *arguments: ast.expr, **keywords: ast.expr) -> ast.Call:
        """A call of a function of nep_core, which is noted for the import."""
        self.api.add(name)
        return call(name, *arguments, **keywords)

    def module_value(self, module: str, name: str) -> ast.expr:
        """A value of a module of the standard library, noted for the import."""
        self.modules.add(module)
        return ast.Attribute(ast.Name(module), name)

    def module_call(self, module: str, name: str, *arguments: ast.expr) -> ast.Call:
        """A call of a function of a module of the standard library, noted for the import."""
        self.modules.add(module)
        return method_call(ast.Name(module), name, list(arguments), {})

    def variable(self, block: Block) -> str:
        """The Python name of the variable that a block is about."""
        variable_id = str(block.fields.get("variable", ""))
        if variable_id not in self.names.variables:
            raise CodeRefused(
                "No variable is chosen in this block.",
                block=block.id,
                checklist=("Choose a variable, or make a new one.",),
            )
        self.variables[variable_id]  # a variable that is used is there
        return self.names.variables[variable_id]

    def begins_as(self, block: Block, kind: str) -> None:
        """Note that the variable of a block must begin as an empty list or text."""
        self.variable(block)
        self.variables[str(block.fields["variable"])].add(kind)

    def part_name(self) -> str:
        """A name for a function inside the rule: part_1, part_2, and so on."""
        self._parts += 1
        if self._part_names is None:
            self._part_names = NameTable(self.names.taken())
        return self._part_names.give(f"part_{self._parts}", "part")

    def _is_default(self, block: Block, key: str) -> bool:
        definition = self.definition(block)
        return self.plugged(block, key) is None and (
            definition.value(block, key) == definition.defaults[key]
        )

    def _field(self, block: Block, slot: Slot, key: str, value: FieldValue | None) -> ast.expr:
        kind = slot.kind.name
        if kind == "robot":
            self.robots.add(str(value))
            return ast.Name(self.names.robots[str(value)])
        if kind == "variable":
            return ast.Name(self.variable(block))
        if kind == "boolean":
            return ast.Constant(False)
        if kind == "list":
            return ast.List([])
        if kind in _ARITHMETIC and isinstance(value, str):
            return self._arithmetic(block, value)
        if kind == "gesture":
            return ast.Constant(f"gesture_{value}")
        if kind == "choice":
            return ast.Constant(self.choice(block, key))
        return constant(value)

    def _arithmetic(self, block: Block, text: str) -> ast.expr:
        try:
            arithmetic = calculate(text)
        except ArithmeticRefused as refused:
            raise CodeRefused(
                str(refused), block=block.id, checklist=("Correct what is written in this block.",)
            ) from refused
        if arithmetic.needs_math:
            self.modules.add("math")
        return arithmetic.node


def value_cost(block: Block) -> int:
    """How many levels a value block adds: the items of a join are in each other in Python."""
    return _COSTS.get(block.type, 1) + sum(block.groups.values())
