"""The order in which the fields of a stack follow each other: as they are read."""

from __future__ import annotations

from collections.abc import Iterator

from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project

_SKIPPED = frozenset({"checkbox"})
"""Kinds without an editor: pressing them changes them."""

Place = tuple[str, str]
"""A block and the key of one of its fields."""


def fields_within(project: Project, language: Language, root: str) -> Iterator[Place]:
    """The fields of a block and of those inside it that can be seen and edited."""
    waiting: list[Place] = [(root, "")]
    while waiting:
        block_id, key = waiting.pop()
        if key:
            yield block_id, key
            continue
        block = project.blocks[block_id]
        definition = language.definitions.get(block.type)
        if block.collapsed or definition is None:
            continue
        found: list[Place] = []
        for slot_key, slot in definition.keys(block.groups):
            if slot_key in block.inputs:
                found.append((block.inputs[slot_key], ""))
            elif slot.kind.name == "body":
                found += [(child, "") for child in block.bodies.get(slot_key, ())]
            elif slot.kind.typed and slot.kind.name not in _SKIPPED:
                found.append((block_id, slot_key))
        waiting += reversed(found)


def field_after(
    project: Project, language: Language, place: Place, *, forward: bool
) -> Place | None:
    """The field that follows (or comes before) another in its stack, or None at the end."""
    top = place[0]
    while (parent := project.parents[top]).owner in project.blocks:
        top = parent.owner
    body = project.stacks[parent.owner].body
    at = body.index(top)
    near = list(fields_within(project, language, top))
    index = near.index(place) if place in near else -1 if forward else len(near)
    index += 1 if forward else -1
    if 0 <= index < len(near):
        return near[index]
    for root in body[at + 1 :] if forward else reversed(body[:at]):
        fields = list(fields_within(project, language, root))
        if fields:
            return fields[0 if forward else -1]
    return None
