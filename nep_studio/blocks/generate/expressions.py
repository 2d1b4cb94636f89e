"""Values as expression trees: what slots hold, what reporters give, and the calls of blocks."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Mapping

from ..definition_call import Call
from ..definitions import Definition
from ..errors import CodeRefused
from ..language import Language
from ..program import Block, Project, split_slot
from ..sentence import Slot
from ..values import FieldValue
from .names import NameTable, ProgramNames

DEEPEST_VALUE = 60
"""How deep values may be nested: CPython takes 200 parentheses, a block makes up to three."""

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
        self.variables: set[str] = set()
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
            return self._field(block, slot, definition.value(block, key))
        node = self.value(plugged)
        if slot.kind.name == "text" and self.definition(plugged).result != "text":
            return call("str", node)
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
        reason = self.language.why_not_choice(definition.slots[key], value)
        if reason is not None:
            raise CodeRefused(reason, block=block.id, checklist=("Choose another one.",))
        return str(value)

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
        self.variables.add(variable_id)
        return self.names.variables[variable_id]

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

    def _field(self, block: Block, slot: Slot, value: FieldValue | None) -> ast.expr:
        kind = slot.kind.name
        if kind == "robot":
            self.robots.add(str(value))
            return ast.Name(self.names.robots[str(value)])
        if kind == "variable":
            return ast.Name(self.variable(block))
        if kind == "boolean":
            return ast.Constant(False)
        if kind == "gesture":
            return ast.Constant(f"gesture_{value}")
        if kind == "choice":
            return ast.Constant(self.choice(block, slot.name))
        return constant(value)


def value_cost(block: Block) -> int:
    """How many levels a value block adds: the items of a join are in each other in Python."""
    return 1 + sum(block.groups.values())


def constant(value: FieldValue | None) -> ast.expr:
    """A constant of a field; a negative number is a sign and a number, or ``**`` binds wrongly."""
    if isinstance(value, int | float) and math.copysign(1, value) < 0:
        return ast.UnaryOp(ast.USub(), ast.Constant(-value))
    if value is None or isinstance(value, dict):
        raise TypeError(f"a field of kind {type(value).__name__} is no constant")
    return ast.Constant(value)


def call(name: str, /, *arguments: ast.expr, **keywords: ast.expr) -> ast.Call:
    """A call of a function by its name."""
    return ast.Call(ast.Name(name), list(arguments), _keywords(keywords))


def method_call(
    target: ast.expr, method: str, arguments: list[ast.expr], keywords: Mapping[str, ast.expr]
) -> ast.Call:
    """A call of a method."""
    return ast.Call(ast.Attribute(target, method), arguments, _keywords(keywords))


def whole(node: ast.expr) -> ast.expr:
    """Make sure that a number is whole: what is not known to be goes through int()."""
    number = node.operand if isinstance(node, ast.UnaryOp) else node
    if isinstance(number, ast.Constant) and isinstance(number.value, int):
        return node
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        return node  # random.randint, the only method among values
    return call("int", node)


def _keywords(keywords: Mapping[str, ast.expr]) -> list[ast.keyword]:
    return [ast.keyword(name, value) for name, value in keywords.items()]
