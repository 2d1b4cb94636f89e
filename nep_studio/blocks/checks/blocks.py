"""Checks of each block by itself: unknown types, empty slots, choices that are not offered."""

from __future__ import annotations

from collections.abc import Iterator

from ..arithmetic import number_of
from ..definitions import Definition
from ..language import Language
from ..procedures import procedure_of
from ..program import Block, Project
from ..sentence import Slot
from ..text import sentence
from ..values import FieldValue
from .problem import Problem


def check_blocks(project: Project, language: Language) -> Iterator[Problem]:
    """Problems of single blocks, on all pages; disabled blocks have none."""
    for page, stacks in project.pages.items():
        for stack in stacks:
            for block in project.within(stack.body, enabled=True):
                definition = language.definitions.get(block.type)
                if definition is None:
                    yield _unknown(page, block)
                    continue
                yield from _check_block(project, language, page, block, definition)


def _unknown(page: str, block: Block) -> Problem:
    if procedure_of(block.type):
        return Problem(
            "error",
            "unknown_own_block",
            page,
            block.id,
            "This block belongs to an own block that is not like this any more.",
            ("Take it out, or put another block in its place.",),
        )
    return Problem(
        "error",
        "unknown_block",
        page,
        block.id,
        f"This version does not know the block “{block.type}”. It is kept as it is.",
        ("Update NEP Studio.", "Is a block pack missing?", "Or take the block out."),
    )


def _check_block(
    project: Project, language: Language, page: str, block: Block, definition: Definition
) -> Iterator[Problem]:
    if definition.page != project.kind_of_page(page):
        yield Problem(
            "error",
            "wrong_page",
            page,
            block.id,
            f"This block belongs on the page {definition.page.title()}.",
            (f"Move it to the page {definition.page.title()}.",),
        )
    for key, slot in definition.keys(block.groups):
        plugged = project.blocks.get(block.inputs.get(key, ""))
        if slot.kind.name == "body" or (plugged is not None and not plugged.disabled):
            continue
        reason = _why_not_filled(project, language, block, definition, key, slot)
        if reason is not None:
            told = sentence(project, language, block.id)
            yield Problem("error", reason[0], page, block.id, f"“{told}”: {reason[1]}", reason[2:])


def _why_not_filled(
    project: Project,
    language: Language,
    block: Block,
    definition: Definition,
    key: str,
    slot: Slot,
) -> tuple[str, ...] | None:
    """The kind, the sentence and the checklist of what is wrong with a slot, or None."""
    value, kind = definition.value(block, key), slot.kind.name
    if kind == "boolean":
        return ("empty_slot", "a question is missing.", "Put a six-sided block into the slot.")
    if kind == "list":
        return ("empty_slot", "a list is missing.", "Put a list or a variable into the slot.")
    if kind == "variable" and project.variable(str(value)) is None:
        return ("no_variable", "no variable is chosen.", "Choose a variable, or make a new one.")
    if kind in ("state", "gesture", "robot") and not str(value).strip():
        return ("empty_slot", f"{slot.kind.noun} is missing.", "Choose or type one.")
    reason = language.why_not_choice(slot, value, block, key)
    if reason is not None:
        return ("unknown_choice", reason, "Choose another one.")
    return _why_not_number(definition, slot, value)


def _why_not_number(
    definition: Definition, slot: Slot, value: FieldValue | None
) -> tuple[str, ...] | None:
    """What is wrong with a number as it is typed, for what it is meant."""
    if slot.kind.name == "duration" and number_of(value) < 0:
        return ("negative", "a time cannot be less than 0 seconds.", "Write a time of 0 or more.")
    if "loop" not in definition.flags or slot.kind.name != "number":
        return None
    number = number_of(value)
    if slot.name == "times" and number < 0:
        return ("negative", "this cannot be done less than 0 times.", "Write 0 or more.")
    if slot.name == "step" and int(number) == 0:
        return ("no_step", "counting in steps of 0 never ends.", "Write a whole number but 0.")
    return None
