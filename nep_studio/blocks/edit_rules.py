"""What fits the block language, and why not: shapes, values, whole blocks, and every edit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from faults import Text, text_of

from . import edits
from .closed import REASONS
from .definitions import Definition
from .language import Language
from .places import InBody, InInput, InStack, NewStack, Place, chain_at, procedure_uses
from .procedures import (
    CALL,
    DEFINE,
    MOST_PROCEDURES,
    definitions_of,
    procedure_of,
    why_not_procedure,
)
from .program import FARTHEST, Block, Note, Procedure, Project
from .slots import RESULTS, why_not_name, why_not_text

# Which blocks go together: shapes in chains, results in slots, values in fields.

MOST_VARIABLES = 1000
MOST_NOTES = 1000
MOST_PAGES = 100
LARGEST_NOTE = 10_000
"""How wide or high a note or a comment can be, in canvas units."""


def why_not_chained(definition: Definition | None, *, first_in_stack: bool) -> Text | None:
    """Why a block cannot be in a chain at all; a block of an unknown type always can.

    A reporter may lie on a page by itself, and is then the first and only one of its stack.
    """
    if definition is None or first_in_stack:
        return None
    if definition.shape == "hat":
        return Text("A “when” block begins a stack: no block goes above it.")
    if definition.is_value:
        return Text("A block that gives a value goes into a slot, not between other blocks.")
    return None


def why_not_below(upper: Definition | None) -> Text | None:
    """Why no block can be put directly below ``upper``."""
    if upper is not None and upper.is_value:
        return Text("A block that gives a value goes into a slot: nothing goes below it.")
    if upper is not None and upper.is_last:
        return Text("Nothing goes below this block: it would never be reached.")
    return None


def why_not_plugged(
    owner: Block, key: str, plugged: Block, definitions: Mapping[str, Definition]
) -> Text | None:
    """Why ``plugged`` cannot be put into the slot ``key`` of ``owner``."""
    definition = definitions.get(owner.type)
    value = definitions.get(plugged.type)
    if definition is None:
        return None
    slot = definition.slot(key, owner.groups)
    if slot is None or slot.kind.name == "body":
        return text_of("The block “{type}” has no slot “{key}”.", type=owner.type, key=key)
    if value is None:
        return None
    if not value.is_value:
        return Text("Only a block that gives a value goes into a slot.")
    if value.result in slot.fits:
        return None
    noun = Text(slot.kind.noun)
    if slot.closed:
        return text_of("No block goes into this place: {reason}.", reason=REASONS[slot.closed])
    if not slot.pluggable:
        return text_of("This place takes {noun} that is chosen or typed, not a block.", noun=noun)
    return text_of(
        "This place needs {noun}, and “{block_name}” gives {result}.",
        noun=noun,
        block_name=value.in_words,
        result=Text(RESULTS[value.result]),
    )


def why_no_body(owner: Block, key: str, definitions: Mapping[str, Definition]) -> Text | None:
    """Why the block ``owner`` has no body ``key`` to put blocks in."""
    definition = definitions.get(owner.type)
    if definition is None:
        return None
    slot = definition.slot(key, owner.groups)
    if slot is None or slot.kind.name != "body":
        return text_of(
            "The block “{type}” has no place for blocks called “{key}”.", type=owner.type, key=key
        )
    return None


def why_no_field(block: Block, key: str, value: object, language: Language) -> Text | None:
    """Why the field ``key`` of a block cannot be there or cannot hold ``value``."""
    definition = language.definitions.get(block.type)
    if definition is None:
        return Text("A block of an unknown type cannot be changed.")
    slot = definition.slot(key, block.groups)
    if slot is None or not slot.kind.typed:
        return text_of("The block “{type}” has no field “{key}”.", type=block.type, key=key)
    return slot.why_not(value)


def why_no_groups(block: Block, definition: Definition) -> Text | None:
    """Why a block cannot have its groups as often as it does."""
    for name, count in block.groups.items():
        group = definition.groups.get(name)
        if group is None:
            return text_of("The block “{type}” has no part “{name}”.", type=block.type, name=name)
        if not definition.minimum[name] <= count <= group.maximum:
            return text_of(
                "The part “{name}” of “{type}” is there {count} times: {minimum} to {maximum} can "
                "be.",
                name=name,
                type=block.type,
                count=count,
                minimum=definition.minimum[name],
                maximum=group.maximum,
            )
    return None


def why_not_variable_name(project: Project, name: str, *, but: str = "") -> Text | None:
    """Why a variable cannot have this name; ``but`` is the id of the variable itself."""
    reason = why_not_name(name)
    if not but and len(project.variables) >= MOST_VARIABLES:
        return text_of(
            "There are too many variables: {most_variables} at most.", most_variables=MOST_VARIABLES
        )
    if reason is None and any(v.name == name and v.id != but for v in project.variables):
        return text_of("There is a variable “{name}” already.", name=name)
    return reason


def why_not_size(width: float, height: float) -> Text | None:
    """Why a note or a comment cannot be of this size; 0 is as large as it needs to be."""
    if not all(0 <= length <= LARGEST_NOTE for length in (width, height)):
        return text_of("A note is at most {largest_note} wide and high.", largest_note=LARGEST_NOTE)
    return None


def why_not_note(project: Project, note: Note) -> Text | None:
    """Why a note cannot be like this."""
    if note.page not in project.pages:
        return Text("This page is not there any more.")
    if not (abs(note.x) <= FARTHEST and abs(note.y) <= FARTHEST):
        return Text("This is too far outside the page.")
    return why_not_size(note.width, note.height) or why_not_text(note.text)


# Whether whole blocks and chains, read from a file or a clipboard, fit their definitions.


def why_not_block(block: Block, blocks: Mapping[str, Block], language: Language) -> Text | None:
    """Why a block and those directly inside it do not fit; a block of an unknown type always does.

    ``blocks`` holds at least the blocks inside it.
    """
    definition = language.definitions.get(block.type)
    if definition is None:
        return None
    return next(_reasons(block, definition, blocks, language), None)


def why_not_stack(
    chain: Sequence[str], blocks: Mapping[str, Block], language: Language
) -> tuple[str, Text] | None:
    """The first block that cannot be where it is in a stack, and why."""
    for block_id in chain:
        definition = language.definitions.get(blocks[block_id].type)
        is_first = block_id == chain[0]
        reason = why_not_chained(definition, first_in_stack=is_first)
        if definition is not None and definition.is_value and len(chain) > 1:
            reason = reason or Text(
                "A block that gives a value goes into a slot: nothing is below it."
            )
        if reason is not None:
            return block_id, reason
    return None


def _reasons(
    block: Block, definition: Definition, blocks: Mapping[str, Block], language: Language
) -> Iterator[Text]:
    if block.groups and (reason := why_no_groups(block, definition)) is not None:
        yield reason
    for key, value in block.fields.items():
        slot = definition.slot(key, block.groups)
        if slot is not None and slot.why_not(value) is None:
            continue
        if (reason := why_no_field(block, key, value, language)) is not None:
            yield text_of("“{key}”: {reason}", key=key, reason=reason)
    for key, plugged in block.inputs.items():
        reason = why_not_plugged(block, key, blocks[plugged], language.definitions)
        if reason is not None:
            yield text_of("“{key}”: {reason}", key=key, reason=reason)
    for key, chain in block.bodies.items():
        if (reason := why_no_body(block, key, language.definitions)) is not None:
            yield reason
        for child in chain:
            inner = language.definitions.get(blocks[child].type)
            if (reason := why_not_chained(inner, first_in_stack=False)) is not None:
                yield reason


# Why blocks cannot be put into a place: what is above and below, the slot, the page.


def why_not_move(
    edit: edits.placing.MoveBlocks, project: Project, language: Language
) -> Text | None:
    """Why blocks cannot be moved."""
    if edit.first not in project.blocks:
        return Text("This block is not there any more.")
    chain = project.chain_of(project.parents[edit.first]) or [edit.first]
    start = chain.index(edit.first) if edit.first in chain else 0
    roots = [project.blocks[i] for i in chain[start : start + edit.count]]
    return _why_not_here(roots or [project.blocks[edit.first]], edit.place, project, language)


def why_not_create(
    edit: edits.placing.CreateBlocks, project: Project, language: Language
) -> Text | None:
    """Why blocks cannot be made."""
    by_id = {block.id: block for block in edit.blocks}
    inside = [child for block in edit.blocks for child in block.children()]
    if not edit.roots or not by_id.keys() >= {*inside, *edit.roots}:
        return Text("These blocks are not complete.")
    for block in edit.blocks:
        if (reason := why_not_block(block, by_id, language)) is not None:
            return reason
        if block.type.startswith(DEFINE) and _is_there(block.type, project):
            return Text("This block is defined already: a block has one definition.")
    return _why_not_here([by_id[root] for root in edit.roots], edit.place, project, language)


def _is_there(block_type: str, project: Project) -> bool:
    return any(project.blocks[s.body[0]].type == block_type for s in project.stacks.values())


def _why_not_here(
    roots: list[Block], place: Place, project: Project, language: Language
) -> Text | None:
    """Why these blocks cannot be put, one after the other, into a place."""
    if isinstance(place, NewStack) and max(abs(place.x), abs(place.y)) > FARTHEST:
        return Text("This is too far outside the page.")
    if isinstance(place, InInput | InBody):
        owner = project.blocks.get(place.block)
        if owner is None:
            return Text("This block is not there any more.")
        if isinstance(place, InInput):
            return why_not_plugged(owner, place.slot, roots[0], language.definitions)
        if (reason := why_no_body(owner, place.slot, language.definitions)) is not None:
            return reason
    at = place.block if isinstance(place, InBody) else place.stack
    page = place.page if isinstance(place, NewStack) else ""
    if at in project.blocks or at in project.stacks:
        page = page or project.page_of(at)
    for root in roots if page else ():
        definition = language.definitions.get(root.type)
        if definition is not None and definition.page != project.kind_of_page(page):
            right = Text(definition.page.title())
            return text_of("This block belongs on the page {page}.", page=right)
    return _why_not_between(roots, place, project, language)


def _why_not_between(
    roots: list[Block], place: Place, project: Project, language: Language
) -> Text | None:
    """Why these blocks cannot be between those that will be above and below a place."""
    chain = chain_at(project, place)
    moved, definitions = {block.id for block in roots}, language.definitions
    left = chain if moved.isdisjoint(chain) else [i for i in chain if i not in moved]
    index = place.index if isinstance(place, InStack | InBody) else 0
    above = project.blocks[left[index - 1]] if 0 < index <= len(left) else None
    below = project.blocks[left[index]] if 0 <= index < len(left) else None
    is_top = above is None and not isinstance(place, InBody)
    reason = why_not_chained(definitions.get(roots[0].type), first_in_stack=is_top)
    if reason is None and above is not None:
        reason = why_not_below(definitions.get(above.type))
    if reason is None and below is not None:
        reason = why_not_below(definitions.get(roots[-1].type)) or why_not_chained(
            definitions.get(below.type), first_in_stack=False
        )
    return reason


# What happens to the blocks that use an own block when its sentence changes.
#
# A change leaves *misfits*: a field or a block in a slot that is no more, a block that gives a
# value where it did not. They are looked for before the change, so that each can be put right.


@dataclass(frozen=True, slots=True)
class Misfit:
    """A block with a field that goes (``field``), or a block that must leave its place."""

    block: str
    field: str = ""


def misfits(procedure: Procedure, project: Project, language: Language) -> Iterator[Misfit]:
    """What would not fit any more if an own block became like this."""
    # The language as it will be once the own block is like this
    kept = {
        block_type: definition
        for block_type, definition in language.definitions.items()
        if procedure_of(block_type) != procedure.id
    }
    after = replace(language, definitions={**kept, **definitions_of([procedure])})
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


def why_not_change(procedure: Procedure, project: Project, language: Language) -> Text | None:
    """Why an own block cannot become like this as things are, or None when it can."""
    if (reason := why_not_procedure(procedure)) is not None:
        return reason
    if next(misfits(procedure, project, language), None) is not None:
        return Text("There are blocks that would not fit this own block any more.")
    return None


def why_not_remove(procedure_id: str, project: Project) -> Text | None:
    """Why an own block cannot leave the list, or None when it can."""
    types = (CALL + procedure_id, DEFINE + procedure_id)
    if any(block.type in types for block in project.blocks.values()):
        return Text("This own block is still used: delete the blocks that call or define it first.")
    return None


def why_not_delete_procedure(project: Project, procedure_id: str) -> Text | None:
    """Why an own block cannot be deleted with its definition: it is used elsewhere."""
    header = DEFINE + procedure_id
    used = [
        block_id
        for block_id in procedure_uses(project, procedure_id)
        if project.blocks[project.stack_of(block_id).body[0]].type != header
    ]
    if not used:
        return None
    places = "1 place" if len(used) == 1 else text_of("{count} places", count=len(used))
    return text_of(
        "This own block is used in {places}. Take those blocks out first.", places=places
    )


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


def why_not(edit: edits.Edit, project: Project, language: Language) -> Text | None:
    """Why an edit does not fit the language, or None when it does."""
    match edit:
        case edits.placing.MoveBlocks():
            return why_not_move(edit, project, language)
        case edits.placing.CreateBlocks():
            return why_not_create(edit, project, language)
        case edits.content.SetField():
            block = project.blocks.get(edit.block)
            if block is None:
                return Text("This block is not there any more.")
            if edit.value is None:
                return None
            reason = why_no_field(block, edit.slot, edit.value, language)
            if reason is not None:
                return reason
            slot = language.definitions[block.type].slot(edit.slot, block.groups)
            if slot is None:
                return None
            return language.why_not_choice(slot, edit.value, block, edit.slot)
        case edits.content.AddGroup() | edits.content.RemoveGroup():
            return _why_not_group(edit, project, language)
        case edits.content.SetComment():
            return why_not_text(edit.comment)
        case edits.project.MoveStack() if max(abs(edit.x), abs(edit.y)) > FARTHEST:
            return Text("This is too far outside the page.")
        case edits.project.RenameProject():
            return why_not_name(edit.name)
        case edits.project.AddVariable():
            return why_not_variable_name(project, edit.name)
        case edits.project.RenameVariable():
            return why_not_variable_name(project, edit.name, but=edit.variable)
    return _why_not_more(edit, project, language)


def _why_not_more(edit: edits.Edit, project: Project, language: Language) -> Text | None:
    """The edits of notes, pages and own blocks."""
    match edit:
        case edits.content.AddNote() if len(project.notes) >= MOST_NOTES:
            return text_of("There are too many notes: {most_notes} at most.", most_notes=MOST_NOTES)
        case edits.content.AddNote() | edits.content.ChangeNote():
            return why_not_note(project, edit.note)
        case edits.content.SetCommentSize():
            return why_not_size(edit.width, edit.height)
        case edits.project.AddPage() if len(project.pages) >= MOST_PAGES:
            return text_of("There are too many pages: {most_pages} at most.", most_pages=MOST_PAGES)
        case edits.project.AddPage() | edits.project.RenamePage():
            return why_not_name(edit.title) if edit.title else None
        case edits.content.AddProcedure() if len(project.procedures) >= MOST_PROCEDURES:
            return text_of(
                "There are too many own blocks: {most_procedures} at most.",
                most_procedures=MOST_PROCEDURES,
            )
        case edits.content.AddProcedure():
            return why_not_procedure(edit.procedure)
        case edits.content.ChangeProcedure():
            return why_not_change(edit.procedure, project, language)
        case edits.content.RemoveProcedure():
            return why_not_remove(edit.procedure, project)
        case edits.content.SetExtra():
            return edits.content.why_not_extra(edit.key, edit.value)
    return None


def _why_not_group(
    edit: edits.content.AddGroup | edits.content.RemoveGroup, project: Project, language: Language
) -> Text | None:
    block = project.blocks.get(edit.block)
    definition = language.definitions.get(block.type) if block is not None else None
    if block is None or definition is None or edit.group not in definition.groups:
        return Text("This block has no such part.")
    if edit.slots != definition.group_slots(edit.group):
        return Text("This part has other slots.")
    count = block.groups.get(edit.group, 0) + (
        1 if isinstance(edit, edits.content.AddGroup) else -1
    )
    if count > definition.groups[edit.group].maximum:
        return Text("This block cannot have more parts.")
    if count < definition.minimum[edit.group]:
        return Text("This block cannot have fewer parts.")
    if isinstance(edit, edits.content.RemoveGroup):
        return None
    for name, value in edit.fields.items():
        slot = definition.slots[name] if name in edit.slots else None
        if slot is None or not slot.kind.typed:
            return text_of("This part has no field “{name}”.", name=name)
        if (reason := slot.why_not(value)) is not None:
            return reason
    return None
