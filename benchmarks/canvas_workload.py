"""The reference program of the canvas: stacks of exactly 100 blocks, at any size.

A stack is five times the same 20 blocks: set x to x + n, repeat > (if / else > say / change,
set y), say y, say a text. ``made`` needs nothing but a number; ``translated`` reads the same
program from Blockly's JSON, so that both editors are measured with the same blocks.
"""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.edits.placing import CreateBlocks
from nep_studio.blocks.edits.project import AddVariable
from nep_studio.blocks.language import Language
from nep_studio.blocks.places import NewStack
from nep_studio.blocks.program import Block, Project
from nep_studio.blocks.slots import FieldValue
from nep_studio.run.installation import load_language

STACK_BLOCKS = 100
UNIT_BLOCKS = 20
Node = dict[str, Any]
COLUMN, ROW = 420, 2000
MARGIN = 40
DRAG_STEPS = 120
VARIABLES = {"vx": "x", "vy": "y", "vs": "score"}
RESOURCES = Path(__file__).resolve().parent.parent / "resources"

TYPES = {
    "variables_set": "variable.set",
    "variables_get": "variable.get",
    "math_arithmetic": "math.arithmetic",
    "math_change": "variable.change",
    "math_number": "math.number",
    "controls_repeat_ext": "control.repeat",
    "controls_if": "control.if",
    "logic_compare": "logic.compare",
    "text_print": "robot.say",
    "text": "text.text",
}
"""The block of ours for each block of Blockly's."""

SLOTS = {
    ("variables_set", "VALUE"): "value",
    ("math_arithmetic", "A"): "a",
    ("math_arithmetic", "B"): "b",
    ("math_change", "DELTA"): "amount",
    ("controls_repeat_ext", "TIMES"): "times",
    ("controls_repeat_ext", "DO"): "do",
    ("controls_if", "IF0"): "condition",
    ("controls_if", "DO0"): "do",
    ("controls_if", "ELSE"): "otherwise_do.1",
    ("logic_compare", "A"): "a",
    ("logic_compare", "B"): "b",
    ("text_print", "TEXT"): "text",
}
"""Our slot for each input of Blockly's."""

BODIES = {"DO", "DO0", "ELSE"}
FIELDS = {"VAR": "variable", "NUM": "number", "TEXT": "text"}
OPERATIONS = {"ADD": ("operation", "add"), "LT": ("comparison", "less")}


def language() -> Language:
    """The block language of the program that is measured."""
    return load_language(RESOURCES / "blocks", RESOURCES / "robots" / "nao" / "robot.toml")


def made(blocks: int, words: Language) -> Project:
    """A program of so many blocks, a multiple of 100."""
    stacks, rest = divmod(blocks, STACK_BLOCKS)
    if rest:
        raise ValueError(f"{blocks} is not a multiple of {STACK_BLOCKS}")
    return translated(blockly(stacks), words)


def one_stack(statements: int, words: Language) -> Project:
    """A program with a single stack: a hat, then so many statements: say 0, say 1, say 2, ..."""
    project = _empty()
    say = words.definitions["robot.say"]
    hat = _block(words.definitions["event.started"], "hat", {})
    said = [_block(say, f"b{number}", {"text": str(number)}) for number in range(statements)]
    place = NewStack("behaviour", "s0", MARGIN, MARGIN, 0)
    CreateBlocks(tuple(b.id for b in (hat, *said)), (hat, *said), place).apply(project)
    return project


def translated(workspace: Node, words: Language) -> Project:
    """The program that Blockly's JSON describes."""
    project = _empty()
    for number, top in enumerate(workspace["blocks"]["blocks"]):
        blocks: list[Block] = []
        roots = tuple(_chain(top, words, blocks))
        place = NewStack("behaviour", f"s{number}", top["x"], top["y"], number)
        CreateBlocks(roots, tuple(blocks), place).apply(project)
    return project


def read_blockly(path: Path) -> Node:
    """A file of Blockly's JSON."""
    workspace: Node = json.loads(path.read_text(encoding="utf-8"))
    return workspace


def blockly(stacks: int) -> Node:
    """Blockly's JSON of a program of so many stacks."""
    columns = math.ceil(math.sqrt(stacks))
    tops = []
    for number in range(stacks):
        row, column = divmod(number, columns)
        tops.append({**_stack(number), "x": MARGIN + COLUMN * column, "y": MARGIN + ROW * row})
    variables = [{"name": name, "id": variable} for variable, name in VARIABLES.items()]
    return {"variables": variables, "blocks": {"languageVersion": 0, "blocks": tops}}


def _stack(number: int) -> Node:
    """The first block of a stack with the others below it."""
    units = STACK_BLOCKS // UNIT_BLOCKS
    return _linked([b for n in range(units) for b in _Unit(number * units + n).statements()])


class _Unit:
    """The 20 blocks that repeat, numbered one after the other."""

    def __init__(self, step: int) -> None:
        self._step = step
        self._ids = itertools.count(step * UNIT_BLOCKS)

    def statements(self) -> list[Node]:
        """Four statements with what is inside them."""
        step = self._step
        set_x = self._node("variables_set", VAR="vx") | _inputs(VALUE=self._of_x("ADD", step))
        fork = self._node("controls_if") | {"extraState": {"hasElse": True}}
        less = self._of_x("LT", step * 3)
        told = self._print(f"step {step}")
        change = self._node("math_change", VAR="vs") | _inputs(DELTA=self._number(1))
        fork |= _inputs(IF0=less, DO0=told, ELSE=change)
        set_y = self._node("variables_set", VAR="vy") | _inputs(VALUE=self._number(step))
        repeat = self._node("controls_repeat_ext")
        repeat |= _inputs(TIMES=self._number(10), DO=_linked([fork, set_y]))
        say_y = self._node("text_print") | _inputs(TEXT=self._node("variables_get", VAR="vy"))
        return [set_x, repeat, say_y, self._print("hello world")]

    def _of_x(self, operation: str, value: int) -> Node:
        kind = "math_arithmetic" if operation == "ADD" else "logic_compare"
        owner = self._node(kind, OP=operation)
        return owner | _inputs(A=self._node("variables_get", VAR="vx"), B=self._number(value))

    def _print(self, text: str) -> Node:
        return self._node("text_print") | _inputs(TEXT=self._node("text", TEXT=text))

    def _number(self, value: int) -> Node:
        return self._node("math_number", NUM=value)

    def _node(self, kind: str, **fields: str | int) -> Node:
        node: Node = {"type": kind, "id": f"b{next(self._ids)}"}
        if not fields:
            return node
        values = {k: {"id": v} if k == "VAR" else v for k, v in fields.items()}
        return node | {"fields": values}


def _inputs(**inputs: Node) -> Node:
    return {"inputs": {name: {"block": inner} for name, inner in inputs.items()}}


def _linked(chain: list[Node]) -> Node:
    """The first block of a chain, each with the next one in it, as Blockly writes them."""
    below: Node | None = None
    for block in reversed(chain):
        below = {**block, "next": {"block": below}} if below else block
    if below is None:
        raise ValueError("a chain has at least one block")
    return below


def _chain(first: Node, words: Language, blocks: list[Block]) -> Iterator[str]:
    """Translate a block and those below it, with all that is inside; give their ids."""
    node: Node | None = first
    while node is not None:
        yield _translate(node, words, blocks)
        node = node.get("next", {}).get("block")


def _translate(node: Node, words: Language, blocks: list[Block]) -> str:
    kind = node["type"]
    fields = dict(_field(name, value) for name, value in node.get("fields", {}).items())
    block = _block(words.definitions[TYPES[kind]], node["id"], fields)
    if node.get("extraState", {}).get("hasElse"):
        block.groups["otherwise"] = 1
    for name, inner in node.get("inputs", {}).items():
        slot = SLOTS[kind, name]
        if name in BODIES:
            block.bodies[slot] = list(_chain(inner["block"], words, blocks))
        else:
            block.inputs[slot] = _translate(inner["block"], words, blocks)
    blocks.append(block)
    return block.id


def _field(name: str, value: Any) -> tuple[str, FieldValue]:
    if name == "OP":
        return OPERATIONS[value]
    return FIELDS[name], value["id"] if name == "VAR" else value


def _block(definition: Definition, block_id: str, fields: dict[str, FieldValue]) -> Block:
    """A block as the editor makes it: what is not said here has its default."""
    block = definition.new_block(block_id)
    block.fields.update(fields)
    return block


def _empty() -> Project:
    project = Project("Workload")
    for position, (variable, name) in enumerate(VARIABLES.items()):
        AddVariable(variable, name, position).apply(project)
    return project


def drag_path() -> list[tuple[float, float]]:
    """How far from where it was taken a dragged stack is at each of 120 steps: over neighbours."""
    return [(6.0 * step, 40.0 * math.sin(step / 10)) for step in range(1, DRAG_STEPS + 1)]
