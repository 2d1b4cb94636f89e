"""Checks of rules: nothing starts, two rules for the same thing, blocks under no rule."""

from __future__ import annotations

from collections.abc import Iterator

from ..definitions import Definition
from ..deployment import GESTURE_STATE, rules
from ..language import Language
from ..program import Block, Project
from ..text import sentence
from .problem import Problem, page_of


def check_rules(project: Project, language: Language) -> Iterator[Problem]:
    """Problems of how stacks begin."""
    chains = list(rules(project, language))
    if not chains:
        yield Problem(
            "error",
            "no_rule",
            "behaviour",
            "",
            "Nothing starts this program: it has no “when” block.",
            ("Drag a “when” block from the palette onto the page Behaviour.",),
        )
    yield from _same_trigger(project, language, chains)
    yield from _loose(project, language)


def _same_trigger(
    project: Project, language: Language, chains: list[list[str]]
) -> Iterator[Problem]:
    first: dict[str, str] = {}
    for chain in chains:
        hat = project.blocks[chain[0]]
        if first.setdefault(_trigger(language, hat), hat.id) != hat.id:
            yield Problem(
                "warning",
                "same_trigger",
                page_of(project, hat.id),
                hat.id,
                f"Two rules begin with “{sentence(project, language, hat.id)}”. Both will run.",
                ("Put the blocks of both rules under one.", "Or let one wait for something else."),
            )


def _trigger(language: Language, hat: Block) -> str:
    """What a rule waits for; a gesture is the human state that its node tells."""
    definition = language.definitions[hat.type]
    for slot in definition.slots.values():
        if slot.kind.name == "gesture":
            return f"{GESTURE_STATE}{definition.value(hat, slot.name)}"
        if slot.kind.name == "state":
            return f"{definition.value(hat, slot.name)}{_goal_name(definition, hat)}"
    values = [str(definition.value(hat, key)) for key, _ in definition.keys(hat.groups)]
    return f"block {hat.type} {values}"


def _goal_name(definition: Definition, hat: Block) -> str:
    """What tells goals that begin alike from each other, and from rules: their name."""
    return f" goal {definition.value(hat, 'name')}" if "name" in definition.slots else ""


def _loose(project: Project, language: Language) -> Iterator[Problem]:
    for page, stack in project.stacks_of_kind("behaviour"):
        first = project.blocks[stack.body[0]]
        definition = language.definitions.get(first.type)
        if definition is not None and definition.shape != "hat" and definition.page == "behaviour":
            yield Problem(
                "info",
                "loose_block",
                page,
                first.id,
                f"“{sentence(project, language, first.id)}” is under no “when” block "
                "and will not run.",
                ("Drag it under a “when” block, or leave it here for later.",),
            )
