"""Checks of each block by itself: unknown types, empty slots, choices that are not offered."""

from __future__ import annotations

from collections.abc import Iterator

from ..definitions import Definition
from ..language import Language
from ..program import Block, Project
from ..sentence import Slot
from ..text import sentence
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
    if definition.page != page:
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
    if kind == "variable" and project.variable(str(value)) is None:
        return ("no_variable", "no variable is chosen.", "Choose a variable, or make a new one.")
    if kind in ("state", "gesture", "robot") and not str(value).strip():
        return ("empty_slot", f"{slot.kind.noun} is missing.", "Choose or type one.")
    reason = language.why_not_choice(slot, value)
    return None if reason is None else ("unknown_choice", reason, "Choose another one.")
