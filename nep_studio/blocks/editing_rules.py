"""Why an edit does not fit the block language: one question for every kind of edit."""

from __future__ import annotations

from .connections import (
    MOST_NOTES,
    MOST_PAGES,
    why_no_field,
    why_not_note,
    why_not_size,
    why_not_variable_name,
)
from .edits import (
    AddGroup,
    AddNote,
    AddPage,
    AddProcedure,
    AddVariable,
    ChangeNote,
    ChangeProcedure,
    CreateBlocks,
    Edit,
    MoveBlocks,
    MoveStack,
    RemoveGroup,
    RemoveProcedure,
    RenamePage,
    RenameProject,
    RenameVariable,
    SetComment,
    SetCommentSize,
    SetExtra,
    SetField,
)
from .edits.kept import why_not_extra
from .language import Language
from .own_block_changes import why_not_change, why_not_remove
from .placing_rules import is_near, why_not_create, why_not_move
from .procedures import MOST_PROCEDURES, why_not_procedure
from .program import Project
from .values import why_not_name, why_not_text


def why_not(edit: Edit, project: Project, language: Language) -> str | None:
    """Why an edit does not fit the language, or None when it does."""
    match edit:
        case MoveBlocks():
            return why_not_move(edit, project, language)
        case CreateBlocks():
            return why_not_create(edit, project, language)
        case SetField():
            return _why_not_field(edit, project, language)
        case AddGroup() | RemoveGroup():
            return _why_not_group(edit, project, language)
        case SetComment():
            return why_not_text(edit.comment)
        case MoveStack() if not is_near(edit.x, edit.y):
            return "This is too far outside the page."
        case RenameProject():
            return why_not_name(edit.name)
        case AddVariable():
            return why_not_variable_name(project, edit.name)
        case RenameVariable():
            return why_not_variable_name(project, edit.name, but=edit.variable)
    return _why_not_more(edit, project, language)


def _why_not_more(edit: Edit, project: Project, language: Language) -> str | None:
    """The edits of notes, pages and own blocks."""
    match edit:
        case AddNote() if len(project.notes) >= MOST_NOTES:
            return f"There are too many notes: {MOST_NOTES} at most."
        case AddNote() | ChangeNote():
            return why_not_note(project, edit.note)
        case SetCommentSize():
            return why_not_size(edit.width, edit.height)
        case AddPage() if len(project.pages) >= MOST_PAGES:
            return f"There are too many pages: {MOST_PAGES} at most."
        case AddPage() | RenamePage():
            return why_not_name(edit.title) if edit.title else None
        case AddProcedure() if len(project.procedures) >= MOST_PROCEDURES:
            return f"There are too many own blocks: {MOST_PROCEDURES} at most."
        case AddProcedure():
            return why_not_procedure(edit.procedure)
        case ChangeProcedure():
            return why_not_change(edit.procedure, project, language)
        case RemoveProcedure():
            return why_not_remove(edit.procedure, project)
        case SetExtra():
            return why_not_extra(edit.key, edit.value)
    return None


def _why_not_field(edit: SetField, project: Project, language: Language) -> str | None:
    block = project.blocks.get(edit.block)
    if block is None:
        return "This block is not there any more."
    if edit.value is None:
        return None
    reason = why_no_field(block, edit.slot, edit.value, language)
    if reason is not None:
        return reason
    slot = language.definitions[block.type].slot(edit.slot, block.groups)
    if slot is None:
        return None
    return language.why_not_choice(slot, edit.value, block, edit.slot)


def _why_not_group(
    edit: AddGroup | RemoveGroup, project: Project, language: Language
) -> str | None:
    block = project.blocks.get(edit.block)
    definition = language.definitions.get(block.type) if block is not None else None
    if block is None or definition is None or edit.group not in definition.groups:
        return "This block has no such part."
    if edit.slots != definition.group_slots(edit.group):
        return "This part has other slots."
    count = block.groups.get(edit.group, 0) + (1 if isinstance(edit, AddGroup) else -1)
    if count > definition.groups[edit.group].maximum:
        return "This block cannot have more parts."
    if count < definition.minimum[edit.group]:
        return "This block cannot have fewer parts."
    if isinstance(edit, RemoveGroup):
        return None
    for name, value in edit.fields.items():
        slot = definition.slots[name] if name in edit.slots else None
        if slot is None or not slot.kind.typed:
            return f"This part has no field “{name}”."
        if (reason := slot.why_not(value)) is not None:
            return reason
    return None
