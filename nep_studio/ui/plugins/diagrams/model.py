"""The diagrams of a program as data: its state machines, behaviour trees and plans, in words."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import CALL, parameters, procedure_of
from nep_studio.blocks.program import Block, Project
from nep_studio.blocks.states import ANY, DONE, Arrow, Machine, machines_of
from nep_studio.blocks.text import field_text, sentence
from nep_studio.ui.running.stage import Plan
from nep_studio.ui.words import count_words, tr

Shape = Literal["state", "any", "root", "sign", "diamond", "leaf", "ellipse", "step"]
Kind = Literal["states", "tree", "plan"]
Key = tuple[Literal["box", "arrow"], str]
"""What is chosen on a diagram: a box by its key, or an arrow by its block."""

TREE = "tree.tree"
SIGNS = {"tree.sequence": "sequence", "tree.fallback": "fallback", "tree.parallel": "parallel"}
"""What is drawn in the square of a part with several others in it."""
DECORATORS = {
    "tree.while": "eye",
    "tree.retry": "rotate-cw",
    "tree.repeat": "repeat",
    "tree.time_limit": "hourglass",
    "tree.cool_down": "snowflake",
    "tree.delay": "clock",
    "tree.instead": "toggle-left",
}
"""The icon in the diamond of a part with one other in it."""
PARTS = "do"
"""The slot with the parts in a part."""


@dataclass(frozen=True)
class Item:
    """A box: ``key`` is a state, or the block of a part; ``block`` is what shows it on the canvas.

    ``small`` is a second line, or what stands beside a sign. ``hidden`` says how many parts are
    folded away below it. A ``plain`` state has no blocks of its own; one that is not ``reached``
    cannot be come to.
    """

    key: str
    block: str
    shape: Shape
    title: str = ""
    small: str = ""
    sign: str = ""
    is_first: bool = False
    is_plain: bool = False
    is_reached: bool = True
    can_fold: bool = False
    hidden: int = 0


@dataclass(frozen=True)
class Line:
    """What joins two boxes; one with words is an arrow, and ``key`` is its block."""

    key: str
    start: str
    end: str
    words: str = ""
    is_dashed: bool = False


@dataclass(frozen=True)
class Diagram:
    """One machine, tree or plan; ``key`` is its name, of a tree the block that begins it.

    The name of a machine may be empty; that of a plan is its goal.
    """

    kind: Kind
    key: str
    name: str
    items: tuple[Item, ...]
    lines: tuple[Line, ...]
    first: tuple[str, ...] = ()
    """What stands on top."""

    @property
    def title(self) -> str:
        """What it is called in the list of diagrams."""
        if self.kind == "tree":
            return tr("Tree: {name}", name=self.name)
        if self.kind == "plan":
            return tr("Plan: {goal}", goal=self.name)
        return tr("States of {machine}", machine=self.name) if self.name else tr("States")

    @property
    def id(self) -> tuple[Kind, str]:
        """Tells it from all others, also when others come and go."""
        return self.kind, self.key

    @cached_property
    def keys(self) -> dict[str, Key]:
        """Where on the diagram each block is."""
        found: dict[str, Key] = {i.block: ("box", i.key) for i in self.items if not i.is_plain}
        found.pop("", None)
        return found | {line.key: ("arrow", line.key) for line in self.lines if line.words}


def diagrams_of(
    project: Project, language: Language, folded: frozenset[str] = frozenset()
) -> tuple[Diagram, ...]:
    """All diagrams of a program: machines first; ``folded`` parts of trees show nothing below."""
    machines = [_of_machine(one, project, language) for one in machines_of(project, language)]
    trees = [_of_tree(hat, project, language, folded) for hat in _trees(project)]
    return (*machines, *trees)


# State machines


def _of_machine(machine: Machine, project: Project, language: Language) -> Diagram:
    reached = machine.reached
    items = [
        Item(
            state,
            block or _first_use(machine, state),
            "state",
            state,
            _first_line(block, project, language),
            is_first=state == machine.first,
            is_plain=not block,
            is_reached=state in reached,
        )
        for state, block in machine.states.items()
    ]
    if any(arrow.start == ANY for arrow in machine.arrows):
        items.append(Item(ANY, "", "any", tr("any rule")))
    lines = [
        Line(
            arrow.block,
            arrow.start,
            arrow.end,
            _trigger(arrow, project, language),
            is_dashed=not arrow.is_transition,
        )
        for arrow in machine.arrows
    ]
    first = [machine.first] if machine.first else []
    return Diagram("states", machine.name, machine.name, tuple(items), tuple(lines), (*first, ANY))


def _first_use(machine: Machine, state: str) -> str:
    """A block that leads to a state, or away from it, where it has none of its own."""
    to = [arrow.block for arrow in machine.arrows if arrow.end == state]
    away = [arrow.block for arrow in machine.arrows if arrow.start == state]
    return next(iter([*to, *away]), "")


def _first_line(block: str, project: Project, language: Language) -> str:
    """What a state does first."""
    if not block:
        return ""
    below = project.stack_of(block).body[1:2]
    return sentence(project, language, below[0]) if below else ""


def _trigger(arrow: Arrow, project: Project, language: Language) -> str:
    """What sets a transition off, in the words of its block."""
    block = project.blocks[arrow.block]
    match block.type:
        case "state.when":
            return tr("when {condition}", condition=_said(block, "condition", project, language))
        case "state.person":
            return tr("when {state}", state=_said(block, "trigger", project, language))
        case "state.told":
            message = _said(block, "message", project, language)
            return tr("when “{message}” is told", message=message)
        case "state.after":
            return tr("after {seconds} s", seconds=_said(block, "seconds", project, language))
        case other:
            return tr("when all is done") if other == DONE else tr("go to the state")


def _said(block: Block, key: str, project: Project, language: Language) -> str:
    """What stands in a slot, in words."""
    if key in block.inputs:
        return sentence(project, language, block.inputs[key])
    definition = language.definitions[block.type]
    slot = definition.slot(key, block.groups)
    assert slot is not None
    value = definition.value(block, key)
    said = field_text(project, language, block, slot, value, key)
    return said.replace("_", " ") if slot.kind.name == "state" else said


# Behaviour trees


def _trees(project: Project) -> Iterator[Block]:
    for page, stacks in project.pages.items():
        if project.kind_of_page(page) == "behaviour":
            firsts = (project.blocks[stack.body[0]] for stack in stacks)
            yield from (hat for hat in firsts if hat.type == TREE and not hat.disabled)


def _of_tree(hat: Block, project: Project, language: Language, folded: frozenset[str]) -> Diagram:
    items, lines = list[Item](), list[Line]()
    waiting = [hat.id]
    while waiting:
        block = project.blocks[waiting.pop()]
        parts = _parts(block, project)
        is_folded = block.id in folded
        hidden = sum(1 for _ in _within(parts, project)) if is_folded else 0
        items.append(_part(block, project, language, bool(parts), hidden))
        if not is_folded:
            lines += (Line(part, block.id, part) for part in parts)
            waiting += reversed(parts)
    name = _name(hat, language)
    return Diagram("tree", hat.id, name, tuple(items), tuple(lines), (hat.id,))


def _parts(block: Block, project: Project) -> list[str]:
    """The parts directly in a part of a tree; those that are switched off are none."""
    if block.type == TREE:
        inside = project.stack_of(block.id).body[1:]
    elif block.type in SIGNS or block.type in DECORATORS:
        inside = block.bodies.get(PARTS, [])
    else:
        inside = []
    return [part for part in inside if not project.blocks[part].disabled]


def _within(parts: list[str], project: Project) -> Iterator[str]:
    waiting = list(parts)
    while waiting:
        part = waiting.pop()
        yield part
        waiting += _parts(project.blocks[part], project)


def _part(block: Block, project: Project, language: Language, can_fold: bool, hidden: int) -> Item:
    words = sentence(project, language, block.id)
    more = count_words(hidden, "1 part is folded away", "{n} parts are folded away")
    small = f"{words} ({more})" if hidden else words
    match block.type:
        case type_ if type_ == TREE:
            name = _name(block, language)
            return Item(block.id, block.id, "root", name, can_fold=can_fold, hidden=hidden)
        case "tree.step":
            first = block.bodies.get(PARTS, [])[:1]
            does = sentence(project, language, first[0]) if first else ""
            return Item(block.id, block.id, "leaf", _said(block, "name", project, language), does)
        case "tree.check":
            condition = _said(block, "condition", project, language)
            return Item(block.id, block.id, "ellipse", condition)
        case "tree.sub_tree":
            name = _said(block, "name", project, language)
            return Item(block.id, block.id, "leaf", name, sign="list-tree")
        case type_ if type_ in SIGNS:
            shape: Shape = "sign"
            sign = SIGNS[block.type]
        case type_ if type_ in DECORATORS:
            shape, sign = "diamond", DECORATORS[block.type]
        case _:
            return Item(block.id, block.id, "leaf", words)
    return Item(block.id, block.id, shape, "", small, sign, can_fold=can_fold, hidden=hidden)


def _name(hat: Block, language: Language) -> str:
    return str(language.definitions[hat.type].value(hat, "name") or "")


# Plans


GOAL = "goal"
"""The box below the last step."""


def diagrams_of_plans(
    plans: Iterable[Plan], code: Code, project: Project, language: Language
) -> tuple[Diagram, ...]:
    """The plans of a program that runs, or has run, with this code: their steps as its blocks."""
    return tuple(_of_plan(plan, code, project, language) for plan in plans)


def statuses_of(plan: Plan) -> dict[str, str]:
    """How the boxes of a plan are; empty for those that have not begun."""
    done = plan.step - 1 if plan.step else 0
    if plan.status == "succeeded":
        done = len(plan.steps)
    found = {str(number): "succeeded" for number in range(1, done + 1)}
    if plan.status == "succeeded":
        found[GOAL] = plan.status
    elif plan.step and plan.status:
        found[str(plan.step)] = plan.status
    return found


def _of_plan(plan: Plan, code: Code, project: Project, language: Language) -> Diagram:
    keys = [str(number) for number in range(1, len(plan.steps) + 1)]
    items = []
    for key, step in zip(keys, plan.steps, strict=True):
        block = _defined_at(step.task, code)
        words = _step_words(block, list(step.values), project, language)
        title = words or " ".join([step.task.replace("_", " "), *map(str, step.values)])
        is_first = key == keys[0]
        items.append(Item(key, block, "step", title, f"{key} / {keys[-1]}", is_first=is_first))
    items.append(Item(GOAL, "", "ellipse", plan.goal))
    ends = [*keys[1:], GOAL]
    lines = [Line(f"{a}-{b}", a, b) for a, b in zip(keys, ends, strict=True)]
    return Diagram("plan", plan.goal, plan.goal, tuple(items), tuple(lines), (keys[0],))


def _defined_at(function: str, code: Code) -> str:
    """The block that defines a function of the program, or an empty text."""
    found = re.search(rf"^def {re.escape(function)}\(", code.text, re.MULTILINE)
    line = code.text.count("\n", 0, found.start()) + 1 if found is not None else 0
    return code.block_at(line) or ""


def _step_words(
    block: str, values: list[str | int | float | bool], project: Project, language: Language
) -> str:
    """What an own block says with these values; empty where it is not there any more."""
    header = project.blocks.get(block)
    own = project.procedures.get(procedure_of(header.type)) if header is not None else None
    call = language.of(project).definitions.get(f"{CALL}{own.id}") if own is not None else None
    if own is None or call is None or len(parameters(own)) != len(values):
        return ""
    given = {one.id: str(value) for one, value in zip(parameters(own), values, strict=True)}
    said = (p if isinstance(p, str) else given.get(getattr(p, "name", ""), "") for p in call.parts)
    return " ".join(word for word in said if word)
