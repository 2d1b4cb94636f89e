"""Which blocks go together, and why not: shapes in chains, results in slots, values in fields."""

from __future__ import annotations

from collections.abc import Mapping

from faults import Text, text_of

from .definitions import Definition
from .language import Language
from .program import FARTHEST, Block, Note, Project
from .slots import RESULTS, why_not_name, why_not_text

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
    if value.result in slot.kind.fits:
        return None
    noun = Text(slot.kind.noun)
    if not slot.kind.pluggable:
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
