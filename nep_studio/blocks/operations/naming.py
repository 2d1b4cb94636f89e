"""What the names in a clip stand for in another project: its variables and own blocks there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from msgspec.structs import replace

from ..editor import Editor
from ..edits import AddProcedure
from ..language import Language
from ..procedures import CALL, DEFINE, header_of, parameter_of, parameters, procedure_of, title
from ..program import Block, Procedure, Project
from .copying import Clip, variable_keys


@dataclass(slots=True)
class Names:
    """Ids in the project by those in the clip; parameters by "own block.parameter" of the clip.

    ``made`` are the ids of own blocks that the project did not have.
    """

    variables: dict[str, str] = field(default_factory=dict)
    procedures: dict[str, str] = field(default_factory=dict)
    parameters: dict[str, str] = field(default_factory=dict)
    made: list[str] = field(default_factory=list)


def names_for(editor: Editor, clip: Clip) -> Names:
    """Find the variables and own blocks of a clip by their names, and make those that lack."""
    names = Names()
    known = {variable.name: variable.id for variable in editor.project.variables}
    for variable in clip.project.variables:
        there = known.get(variable.name)
        names.variables[variable.id] = there or editor.add_variable(variable.name)
    for procedure in clip.project.procedures.values():
        found = _procedure_for(editor, clip.project, procedure, names)
        names.procedures[procedure.id] = found.id
        for old, new in zip(parameters(procedure), parameters(found), strict=True):
            names.parameters[f"{procedure.id}.{old.id}"] = new.id
    return names


def renewed(language: Language, block: Block, ids: Mapping[str, str], names: Names) -> Block:
    """A block of a clip with other ids, for the project."""
    new = block.copy()
    new.id = ids[block.id]
    new.type = _type(block.type, names)
    keys = _keys(block, names)
    new.fields = {keys.get(key, key): value for key, value in new.fields.items()}
    new.inputs = {keys.get(key, key): ids[plugged] for key, plugged in block.inputs.items()}
    new.bodies = {key: [ids[i] for i in chain] for key, chain in block.bodies.items()}
    for key in variable_keys(new, language.definitions):
        named = str(new.fields.get(key, ""))
        if named in names.variables:
            new.fields[key] = names.variables[named]
    return new


def _procedure_for(
    editor: Editor, source: Project, procedure: Procedure, names: Names
) -> Procedure:
    """The own block that says the same; a new one when there is none, or when it has a header
    already and the clip brings another.
    """
    there = editor.project.procedures.values()
    same = next((p for p in there if _signature(p) == _signature(procedure)), None)
    brings_header = bool(header_of(source, procedure.id))
    if same is not None and not (brings_header and header_of(editor.project, same.id)):
        return same
    new = replace(procedure, id=editor.project.new_id("p"))
    titles = {title(p) for p in there}
    if title(new) in titles:
        new = _told_apart(new, titles)
    editor.apply(AddProcedure(new, len(editor.project.procedures)))
    names.made.append(new.id)
    return new


def _signature(procedure: Procedure) -> tuple[object, ...]:
    kinds = tuple(parameter.kind for parameter in parameters(procedure))
    return title(procedure), kinds, procedure.gives_value


def _told_apart(procedure: Procedure, titles: set[str]) -> Procedure:
    """The own block with a number behind its first word that makes its title a new one."""
    place = next(i for i, part in enumerate(procedure.parts) if isinstance(part, str))
    number, parts = 2, list(procedure.parts)
    while True:
        parts[place] = f"{procedure.parts[place]} {number}"
        changed = replace(procedure, parts=tuple(parts))
        if title(changed) not in titles:
            return changed
        number += 1


def _type(block_type: str, names: Names) -> str:
    old = procedure_of(block_type)
    if old not in names.procedures:
        return block_type
    prefix, _, parameter = block_type.partition(f".{old}")
    new = f"{prefix}.{names.procedures[old]}"
    if not parameter:
        return new
    return f"{new}.{names.parameters.get(f'{old}.{parameter_of(block_type)}', parameter[1:])}"


def _keys(block: Block, names: Names) -> dict[str, str]:
    """The slots of a call or a header by those they had in the clip."""
    if not block.type.startswith((CALL, DEFINE)):
        return {}
    start = f"{procedure_of(block.type)}."
    return {
        old.removeprefix(start): new
        for old, new in names.parameters.items()
        if old.startswith(start)
    }
