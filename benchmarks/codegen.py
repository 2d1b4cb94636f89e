"""Code generation for 5,000 blocks: the whole program, and again after an edit of one stack.

The blocks are those of the reference workload (50 stacks of exactly 100: set x to x + n, repeat >
if / else > say / change, say); a hat and a cap stand in place of one say, so that the stacks run.
The reference is ``ast.unparse`` of the same program, which does no more than print it.
All times are CPU time.
"""

from __future__ import annotations

import ast
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from nep_studio.blocks.checks import check
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import CreateBlocks
from nep_studio.blocks.edits.project import AddVariable
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.generate.program import ProgramGenerator, generate_program
from nep_studio.blocks.places import NewStack
from nep_studio.blocks.program import Block, Project
from nep_studio.blocks.slots import FieldValue
from nep_studio.run.installation import load_language

STACKS = 50
ROUNDS = 15
WHOLE_GOAL_MS = 60.0
EDIT_GOAL_MS = 10.0
RESOURCES = Path(__file__).resolve().parent.parent / "resources"


@dataclass
class Made:
    """A block of the workload with the blocks inside it."""

    type: str
    fields: dict[str, FieldValue] = field(default_factory=dict)
    inputs: dict[str, Made] = field(default_factory=dict)
    bodies: dict[str, list[Made]] = field(default_factory=dict)
    groups: dict[str, int] = field(default_factory=dict)


def run() -> list[dict[str, Any]]:
    """Rows of CPU milliseconds, medians."""
    language = load_language(RESOURCES / "blocks", RESOURCES / "robots" / "nao" / "robot.toml")
    project = workload(STACKS)
    assert len(project.blocks) == STACKS * 100
    text = generate_program(project, language).text
    tree = ast.parse(text)
    data = to_bytes(project)
    generator = ProgramGenerator(project, language)
    edited = next(b.id for b in project.blocks.values() if b.fields.get("text") == "step 3")
    steps = iter(range(10**6))

    def edit_one_stack() -> None:
        SetField(edited, "text", f"changed {next(steps)}").apply(project)
        generator.generate()

    unparse = cpu_ms(lambda: ast.unparse(tree))
    whole = cpu_ms(lambda: generate_program(project, language))
    edit = cpu_ms(edit_one_stack)
    return [
        goal_row("whole program", whole, unparse, WHOLE_GOAL_MS),
        goal_row("after an edit of one stack", edit, unparse, EDIT_GOAL_MS),
        row("load", cpu_ms(lambda: from_bytes(data, "workload.nep", language))),
        row("save", cpu_ms(lambda: to_bytes(project))),
        row("all checks", cpu_ms(lambda: check(project, language))),
    ]


def row(name: str, value: float) -> dict[str, Any]:
    """A figure without a goal."""
    return {"name": f"code, 5,000 blocks: {name}", "value": round(value, 2), "unit": "ms CPU"}


def goal_row(name: str, value: float, reference: float, goal: float) -> dict[str, Any]:
    """A figure that must stay below ``goal`` ms."""
    return {
        **row(name, value),
        "reference": round(reference, 2),
        "ratio": round(value / reference, 3),
        "goal": f"under {goal:g} ms",
        "ok": value < goal,
    }


def cpu_ms(work: Callable[[], object]) -> float:
    """The median CPU time of one run of ``work``, in ms."""
    times = []
    for _ in range(ROUNDS):
        start = time.process_time()
        work()
        times.append((time.process_time() - start) * 1000)
    return statistics.median(times)


def workload(stacks: int) -> Project:
    """A project of so many stacks of exactly 100 blocks."""
    project = Project("Workload")
    for position, name in enumerate(("x", "y", "score")):
        AddVariable(f"v{position + 1}", name, position).apply(project)
    for position in range(stacks):
        blocks: list[Block] = []
        roots = tuple(_add(project, blocks, made) for made in stack())
        place = NewStack("behaviour", project.new_id("s"), 40, 40 + position, position)
        CreateBlocks(roots, tuple(blocks), place).apply(project)
    return project


def stack() -> list[Made]:
    """A hat, five times 20 blocks without the last 2, and a cap."""
    units = [block for step in range(5) for block in unit(step)]
    return [Made("event.started"), *units[:-1], Made("control.stop_program")]


def unit(step: int) -> list[Made]:
    """20 blocks: set x, repeat > (if / else > say / change, set y), say y, say a text."""
    total = Made("math.arithmetic", {"operation": "add"}, {"a": get("v1"), "b": number(step)})
    less = Made("logic.compare", {"comparison": "less"}, {"a": get("v1"), "b": number(step)})
    change = Made("variable.change", {"variable": "v3"}, {"amount": number(1)})
    fork = Made(
        "control.if",
        inputs={"condition": less},
        bodies={"do": [say(text(f"step {step}"))], "otherwise_do.1": [change]},
        groups={"also": 0, "otherwise": 1},
    )
    set_y = Made("variable.set", {"variable": "v2"}, {"value": number(step)})
    return [
        Made("variable.set", {"variable": "v1"}, {"value": total}),
        Made("control.repeat", {}, {"times": number(10)}, {"do": [fork, set_y]}),
        say(get("v2")),
        say(text("hello world")),
    ]


def say(value: Made) -> Made:
    return Made("robot.say", {}, {"text": value})


def get(variable: str) -> Made:
    return Made("variable.get", {"variable": variable})


def number(value: int) -> Made:
    return Made("math.number", {"number": value})


def text(value: str) -> Made:
    return Made("text.text", {"text": value})


def _add(project: Project, blocks: list[Block], made: Made) -> str:
    """Make a block and those inside it; give its id."""
    block = Block(project.new_id("b"), made.type, made.fields, groups=made.groups)
    block.inputs = {slot: _add(project, blocks, inner) for slot, inner in made.inputs.items()}
    block.bodies = {
        slot: [_add(project, blocks, inner) for inner in chain]
        for slot, chain in made.bodies.items()
    }
    blocks.append(block)
    return block.id
