"""Whether a block that was read from a file fits its definition and the blocks around it."""

from __future__ import annotations

from .connections import (
    why_no_body,
    why_no_field,
    why_no_groups,
    why_not_chained,
    why_not_plugged,
)
from .language import Language
from .program import Block, Project


def why_not_language(project: Project, block: Block, language: Language) -> str | None:
    """Why a block cannot be as the file says; a block of an unknown type always can."""
    definition = language.definitions.get(block.type)
    if definition is None:
        return None
    return (
        why_no_groups(block, definition)
        or _why_not_fields(block, language)
        or _why_not_inputs(project, block, language)
        or _why_not_bodies(block, language)
        or _why_not_in_its_chain(project, block, language)
    )


def _why_not_fields(block: Block, language: Language) -> str | None:
    for key, value in block.fields.items():
        if (reason := why_no_field(block, key, value, language)) is not None:
            return f"“{key}”: {reason}"
    return None


def _why_not_inputs(project: Project, block: Block, language: Language) -> str | None:
    for key, plugged in block.inputs.items():
        reason = why_not_plugged(block, key, project.blocks[plugged], language.definitions)
        if reason is not None:
            return f"“{key}”: {reason}"
    return None


def _why_not_bodies(block: Block, language: Language) -> str | None:
    for key in block.bodies:
        if (reason := why_no_body(block, key, language.definitions)) is not None:
            return reason
    return None


def _why_not_in_its_chain(project: Project, block: Block, language: Language) -> str | None:
    definition = language.definitions[block.type]
    parent = project.parents[block.id]
    if parent.slot and project.blocks[parent.owner].inputs.get(parent.slot) == block.id:
        return None
    chain = project.chain_of(parent) or []
    is_top = not parent.slot and chain[0] == block.id
    if definition.is_value and is_top and len(chain) > 1:
        return "A block that gives a value goes into a slot: nothing goes below it."
    return why_not_chained(definition, first_in_stack=is_top)
