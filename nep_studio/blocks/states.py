"""The state machines of a program as data: which states they have, and what leads where."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from .language import Language
from .program import Block, Project

BEGINS = "state.begins"
GO = "state.go"
DONE = "state.done"
TRANSITIONS = ("state.when", "state.person", "state.told", "state.after", DONE)
"""The blocks that lead from a state to another one, each at the top of a stack."""
MODE = "mode"
"""The kind of a slot in which a block names a state of the program."""
ANY = ""
"""Where an arrow begins that any rule may take; no state has an empty name."""


@dataclass(frozen=True)
class Arrow:
    """What leads from a state to another one, and the block that says so.

    ``start`` is ANY where a rule goes to the state; one that a state itself goes to is no
    transition either: ``is_transition`` is whether the block is one of TRANSITIONS.
    """

    block: str
    start: str
    end: str
    is_transition: bool = True


@dataclass(frozen=True)
class Machine:
    """A state machine; most programs have one, whose name is empty.

    ``states`` are in the order in which the program names them, each with the block with which
    it begins, or "". ``first`` is the state in which the program begins, or "".
    """

    name: str
    states: dict[str, str]
    arrows: tuple[Arrow, ...]
    first: str = ""

    @property
    def reached(self) -> frozenset[str]:
        """The states that the program can come to."""
        found = {self.first} if self.first else set()
        found |= {arrow.end for arrow in self.arrows if arrow.start == ANY}
        waiting = list(found)
        while waiting:
            state = waiting.pop()
            new = {arrow.end for arrow in self.arrows if arrow.start == state} - found
            found |= new
            waiting += new
        return frozenset(found)


def machines_of(project: Project, language: Language) -> tuple[Machine, ...]:
    """All state machines of a program, in the order in which it names them.

    Blocks that are switched off do not count, nor do states that are only worked out by a value.
    """
    found: dict[str, _Reading] = {}
    for page, stacks in project.pages.items():
        if project.kind_of_page(page) != "behaviour":
            continue
        for stack in stacks:
            for block in project.within(stack.body, enabled=True):
                machine = machine_of(project, language, block)
                if machine is not None:
                    found.setdefault(machine, _Reading()).take(project, language, block, machine)
    return tuple(
        Machine(name, one.states, tuple(one.arrows), one.first)
        for name, one in found.items()
        if one.states
    )


def machine_of(project: Project, language: Language, block: Block) -> str | None:
    """The state machine that a block is about; None where it is about none, or a value says."""
    definition = language.definitions.get(block.type)
    if definition is None or MODE not in definition.kinds:
        return None
    if not block.groups.get("machine"):
        return ""
    return _name(project, language, block, "machine.1")


def modes_of(project: Project, language: Language, block: Block) -> Iterator[tuple[str, str]]:
    """The keys of the slots in which a block names states, each with the name."""
    definition = language.definitions.get(block.type)
    if definition is None or MODE not in definition.kinds:
        return
    for key, slot in definition.keys(block.groups):
        if slot.kind.name == MODE and (name := _name(project, language, block, key)):
            yield key, name


def _name(project: Project, language: Language, block: Block, key: str) -> str | None:
    """The name that stands in a slot; None where a block says it."""
    if project.plugged(block, key) is not None:
        return None
    return str(language.definitions[block.type].value(block, key) or "")


class _Reading:
    """What is known of one machine so far."""

    def __init__(self) -> None:
        self.states: dict[str, str] = {}
        self.arrows: list[Arrow] = []
        self.first = ""

    def take(self, project: Project, language: Language, block: Block, machine: str) -> None:
        """Take in what a block says of it."""
        names = dict(modes_of(project, language, block))
        for name in names.values():
            self.states.setdefault(name, "")
        state, target = names.get("state"), names.get("target")
        if block.type == BEGINS and state:
            self.states[state] = self.states[state] or block.id
            if block.groups.get("first") and not self.first:
                self.first = state
        elif block.type in TRANSITIONS and state and target:
            self.arrows.append(Arrow(block.id, state, target))
        elif block.type == GO and state:
            start = _where(project, language, block, machine)
            self.arrows.append(Arrow(block.id, start, state, is_transition=False))


def _where(project: Project, language: Language, block: Block, machine: str) -> str:
    """The state whose blocks a block is among; ANY in all other rules, and on the way."""
    hat = project.blocks[project.stack_of(block.id).body[0]]
    if hat.type != BEGINS or machine_of(project, language, hat) != machine:
        return ANY
    return dict(modes_of(project, language, hat)).get("state", ANY)
