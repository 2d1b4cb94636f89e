"""The reporter that a person drags out of a block: of its variable, or of its parameter."""

from __future__ import annotations

from ..edits import AddProcedure
from ..language import Language
from ..procedures import procedure_of
from ..program import Project
from .copying import Clip, clip_of


def reporter_of(project: Project, language: Language, block_id: str, slot: str) -> Clip | None:
    """A clip of the reporter for what is in a field of a block, or None when there is none.

    For a field of kind variable it gives the variable, for a parameter of an own block's header
    the parameter.
    """
    block = project.blocks[block_id]
    definition = language.definitions.get(block.type)
    there = definition.slot(slot, block.groups) if definition is not None else None
    if definition is None or there is None:
        return None
    if there.kind.name == "variable":
        variable = project.variable(str(definition.value(block, slot)))
        getter = _getter(language)
        if variable is None or not getter:
            return None
        clip = clip_of(language, getter, variable=variable.id)
        clip.project.variables.append(variable)
        return clip
    if there.kind.name == "parameter":
        return _parameter(project, language, there.table)
    return None


def _parameter(project: Project, language: Language, block_type: str) -> Clip | None:
    if block_type not in language.definitions:
        return None
    clip = clip_of(language, block_type)
    procedure = project.procedures[procedure_of(block_type)]
    AddProcedure(procedure, 0).apply(clip.project)
    return clip


def _getter(language: Language) -> str:
    """The type of the block that gives the value of a variable."""
    getters = (d.id for d in language.definitions.values() if d.generator == "variable")
    return next(getters, "")
