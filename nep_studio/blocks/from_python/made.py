"""Blocks read from Python, before they have ids."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from ..errors import BlocksError
from ..language import Language
from ..program import Block, Project
from ..values import FieldValue


class CodeUnread(BlocksError):
    """Python that cannot become blocks; ``line`` is where, from 1."""

    title = "This Python cannot become blocks"

    def __init__(self, sentence: str, line: int, *, checklist: tuple[str, ...] = ()) -> None:
        super().__init__(f"Line {line}: {sentence}", checklist=checklist)
        self.line = line


@dataclass(slots=True)
class Made:
    """A block with all that is inside it; ``text`` is its Python without the margin."""

    type: str
    fields: dict[str, FieldValue] = field(default_factory=dict)
    inputs: dict[str, Made] = field(default_factory=dict)
    bodies: dict[str, list[Made]] = field(default_factory=dict)
    groups: dict[str, int] = field(default_factory=dict)
    comment: str = ""
    text: str = ""

    def inner(self) -> Iterator[Made]:
        """The blocks directly inside."""
        yield from self.inputs.values()
        for chain in self.bodies.values():
            yield from chain


def blocks_of(
    project: Project, language: Language, chain: Sequence[Made]
) -> tuple[tuple[str, ...], tuple[Block, ...]]:
    """Blocks with ids that are new to a project: those of the chain, and all."""
    ids: dict[int, str] = {}
    order: list[Made] = []
    waiting = list(reversed(chain))
    while waiting:
        made = waiting.pop()
        ids[id(made)] = project.new_id("b")
        order.append(made)
        waiting.extend(reversed(list(made.inner())))
    blocks = tuple(_block(made, ids, language) for made in order)
    return tuple(ids[id(made)] for made in chain), blocks


def _block(made: Made, ids: dict[int, str], language: Language) -> Block:
    definition = language.definitions[made.type]
    block = definition.new_block(ids[id(made)])
    block.groups = {**block.groups, **made.groups}
    keys = {key for key, _ in definition.keys(block.groups)}
    block.fields = {
        **{key: value for key, value in block.fields.items() if key in keys},
        **made.fields,
    }
    for key, slot in definition.keys(block.groups):
        if key not in block.fields and slot.name in definition.defaults:
            block.fields[key] = definition.defaults[slot.name]
    block.inputs = {key: ids[id(inner)] for key, inner in made.inputs.items()}
    block.bodies = {
        key: [ids[id(inner)] for inner in chain] for key, chain in made.bodies.items() if chain
    }
    block.comment = made.comment
    return block
