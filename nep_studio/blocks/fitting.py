"""Whether whole blocks and chains, read from a file or a clipboard, fit their definitions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from .connections import (
    why_no_body,
    why_no_field,
    why_no_groups,
    why_not_chained,
    why_not_plugged,
)
from .definitions import Definition
from .language import Language
from .program import Block


def why_not_block(block: Block, blocks: Mapping[str, Block], language: Language) -> str | None:
    """Why a block and those directly inside it do not fit; a block of an unknown type always does.

    ``blocks`` holds at least the blocks inside it.
    """
    definition = language.definitions.get(block.type)
    if definition is None:
        return None
    return next(_reasons(block, definition, blocks, language), None)


def why_not_stack(
    chain: Sequence[str], blocks: Mapping[str, Block], language: Language
) -> tuple[str, str] | None:
    """The first block that cannot be where it is in a stack, and why."""
    for block_id in chain:
        definition = language.definitions.get(blocks[block_id].type)
        is_first = block_id == chain[0]
        reason = why_not_chained(definition, first_in_stack=is_first)
        if definition is not None and definition.is_value and len(chain) > 1:
            reason = reason or "A block that gives a value goes into a slot: nothing is below it."
        if reason is not None:
            return block_id, reason
    return None


def _reasons(
    block: Block, definition: Definition, blocks: Mapping[str, Block], language: Language
) -> Iterator[str]:
    if block.groups and (reason := why_no_groups(block, definition)) is not None:
        yield reason
    for key, value in block.fields.items():
        slot = definition.slot(key, block.groups)
        if slot is not None and slot.why_not(value) is None:
            continue
        if (reason := why_no_field(block, key, value, language)) is not None:
            yield f"“{key}”: {reason}"
    for key, plugged in block.inputs.items():
        reason = why_not_plugged(block, key, blocks[plugged], language.definitions)
        if reason is not None:
            yield f"“{key}”: {reason}"
    for key, chain in block.bodies.items():
        if (reason := why_no_body(block, key, language.definitions)) is not None:
            yield reason
        for child in chain:
            inner = language.definitions.get(blocks[child].type)
            if (reason := why_not_chained(inner, first_in_stack=False)) is not None:
                yield reason
