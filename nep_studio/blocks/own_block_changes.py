"""What happens to the blocks that use an own block when its sentence changes.

A change leaves *misfits*: a field or a block in a slot that is no more, a block that gives a value
where it did not. They are looked for before the change, so that each can be put right.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from .connections import why_not_chained, why_not_plugged
from .language import Language
from .procedures import CALL, DEFINE, definitions_of, procedure_of, why_not_procedure
from .program import Block, Procedure, Project
from .uses import procedure_uses


@dataclass(frozen=True, slots=True)
class Misfit:
    """A block with a field that goes (``field``), or a block that must leave its place."""

    block: str
    field: str = ""


def misfits(procedure: Procedure, project: Project, language: Language) -> Iterator[Misfit]:
    """What would not fit any more if an own block became like this."""
    after = _after(procedure, language)
    for block in project.blocks.values():
        if procedure_of(block.type) != procedure.id:
            continue
        if _is_misplaced(block, project, after):
            yield Misfit(block.id)
        definition = after.definitions.get(block.type)
        if definition is None:
            continue
        for key, value in block.fields.items():
            slot = definition.slot(key, block.groups)
            if slot is None or slot.why_not(value) is not None:
                yield Misfit(block.id, key)
        for key, plugged in block.inputs.items():
            inner = project.blocks[plugged]
            if why_not_plugged(block, key, inner, after.definitions) is not None:
                yield Misfit(plugged)


def why_not_change(procedure: Procedure, project: Project, language: Language) -> str | None:
    """Why an own block cannot become like this as things are, or None when it can."""
    if (reason := why_not_procedure(procedure)) is not None:
        return reason
    if next(misfits(procedure, project, language), None) is not None:
        return "There are blocks that would not fit this own block any more."
    return None


def why_not_remove(procedure_id: str, project: Project) -> str | None:
    """Why an own block cannot leave the list, or None when it can."""
    types = (CALL + procedure_id, DEFINE + procedure_id)
    if any(block.type in types for block in project.blocks.values()):
        return "This own block is still used: delete the blocks that call or define it first."
    return None


def why_not_delete_procedure(project: Project, procedure_id: str) -> str | None:
    """Why an own block cannot be deleted with its definition: it is used elsewhere."""
    header = DEFINE + procedure_id
    used = [
        block_id
        for block_id in procedure_uses(project, procedure_id)
        if project.blocks[project.stack_of(block_id).body[0]].type != header
    ]
    if not used:
        return None
    places = "1 place" if len(used) == 1 else f"{len(used)} places"
    return f"This own block is used in {places}. Take those blocks out first."


def _after(procedure: Procedure, language: Language) -> Language:
    """The language as it will be once the own block is like this."""
    kept = {
        block_type: definition
        for block_type, definition in language.definitions.items()
        if procedure_of(block_type) != procedure.id
    }
    return replace(language, definitions={**kept, **definitions_of([procedure])})


def _is_misplaced(block: Block, project: Project, after: Language) -> bool:
    """Whether a block must leave its place because of what it will be."""
    definition = after.definitions.get(block.type)
    if definition is None:
        return False
    parent = project.parents[block.id]
    owner = project.blocks.get(parent.owner)
    if owner is not None and owner.inputs.get(parent.slot) == block.id:
        if procedure_of(owner.type) and owner.type not in after.definitions:
            return False
        return why_not_plugged(owner, parent.slot, block, after.definitions) is not None
    chain = project.chain_of(parent) or []
    if definition.is_value:
        return owner is not None or len(chain) > 1
    return why_not_chained(definition, first_in_stack=chain[0] == block.id) is not None
