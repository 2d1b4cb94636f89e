"""Copy blocks and paste them, in the same project or another one, also as text.

A clip is a small project of its own: its text is that of a .nep file, is checked like one, and
can be opened as one; whatever draws a project can draw a clip.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from ..definitions import Definition
from ..edits import AddProcedure, AddVariable, CreateBlocks
from ..language import Language
from ..places import NewStack
from ..procedures import procedure_of
from ..program import PAGES, Block, Project, Stack
from ..reading import from_bytes
from ..values import FieldValue
from ..writing import to_bytes
from .animations import take_along
from .selection import Run, members, runs

Points = Mapping[str, tuple[float, float]]
"""Where blocks are on their page, in canvas units, as the canvas has laid them out."""

UNKNOWN: Points = MappingProxyType({})

STEP = 24.0
"""How far a copy lies from what it is a copy of."""


@dataclass(frozen=True)
class Clip:
    """Blocks that are in no project: each stack of ``project`` is one run that was copied."""

    project: Project = field(default_factory=lambda: Project("Blocks"))

    def __len__(self) -> int:
        return len(self.project.blocks)

    @property
    def stacks(self) -> list[Stack]:
        """The stacks, in page order."""
        return [stack for stacks in self.project.pages.values() for stack in stacks]

    @property
    def roots(self) -> tuple[tuple[str, ...], ...]:
        """The blocks of each stack, in page order."""
        return tuple(tuple(stack.body) for stack in self.stacks)

    @property
    def corner(self) -> tuple[float, float]:
        """The left and top edge of all stacks."""
        return min(stack.x for stack in self.stacks), min(stack.y for stack in self.stacks)


def copy(project: Project, language: Language, ids: Iterable[str], at: Points = UNKNOWN) -> Clip:
    """Copy blocks with all that is inside them, and the variables and own blocks they name.

    The animations of the project that they play come along too.

    ``at`` says where blocks lie that do not begin a stack; else they lie below each other.
    """
    clip = Clip()
    for number, run in enumerate(runs(project, ids)):
        roots = members(project, run)
        definition = language.definitions.get(project.blocks[run.first].type)
        page = definition.page if definition is not None else PAGES[0]
        place = at.get(run.first) or _place(project, run, number)
        _create(clip.project, roots, list(project.within(roots)), page, place)
    _add_variables(clip.project, project, language)
    _add_procedures(clip.project, project)
    take_along(clip.project, project, language)
    return clip


def clip_of(language: Language, block_type: str, **fields: FieldValue) -> Clip:
    """A clip of one new block of a type with its default values, and some fields set."""
    definition = language.definitions[block_type]
    block = definition.new_block("b1")
    block.fields.update(fields)
    clip = Clip()
    _create(clip.project, [block.id], [block], definition.page, (0.0, 0.0))
    return clip


def to_text(clip: Clip) -> str:
    """A clip as text: that of a project file."""
    return to_bytes(clip.project).decode()


def from_text(text: str, language: Language) -> Clip:
    """Read a clip, or any project as a clip; raises ProjectFileError, which says what is wrong."""
    return Clip(from_bytes(text.encode(errors="surrogatepass"), "The clipboard", language))


def variable_keys(block: Block, definitions: Mapping[str, Definition]) -> list[str]:
    """The slots of a block that name a variable."""
    definition = definitions.get(block.type)
    if definition is None:
        return []
    return [key for key, slot in definition.keys(block.groups) if slot.kind.name == "variable"]


def _create(
    project: Project, roots: list[str], blocks: list[Block], page: str, at: tuple[float, float]
) -> None:
    place = NewStack(page, project.new_id("s"), *at, len(project.pages[page]))
    while place.stack in project.blocks or any(place.stack == block.id for block in blocks):
        place = NewStack(page, project.new_id("s"), *at, len(project.pages[page]))
    CreateBlocks(tuple(roots), tuple(blocks), place).apply(project)


def _add_variables(target: Project, source: Project, language: Language) -> None:
    """The variables that the blocks name, with the ids that they have in their project."""
    used = {
        block.fields.get(key)
        for block in target.blocks.values()
        for key in variable_keys(block, language.definitions)
    }
    for variable in source.variables:
        if variable.id in used:
            AddVariable(variable.id, variable.name, len(target.variables)).apply(target)


def _add_procedures(target: Project, source: Project) -> None:
    used = {procedure_of(block.type) for block in target.blocks.values()}
    for procedure in source.procedures.values():
        if procedure.id in used:
            AddProcedure(procedure, len(target.procedures)).apply(target)


def _place(project: Project, run: Run, number: int) -> tuple[float, float]:
    """About where a run is; blocks inside a stack lie somewhat to the right and below."""
    stack = project.stack_of(run.first)
    depth = 0 if stack.body[0] == run.first else number + 1
    return stack.x + STEP * depth, stack.y + STEP * depth
