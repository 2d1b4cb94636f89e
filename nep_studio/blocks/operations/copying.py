"""Copy blocks and paste them, in the same project or another one, also as text.

A clip is a small project of its own: its text is that of a .nep file, is checked like one, and
can be opened as one; whatever draws a project can draw a clip.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from msgspec.structs import replace

from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddProcedure, SetExtra, SetField
from nep_studio.blocks.edits.placing import CreateBlocks, DeleteBlocks, MoveBlocks
from nep_studio.blocks.edits.project import AddVariable
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.language import Language
from nep_studio.blocks.places import InInput, InStack, NewStack, Place
from nep_studio.blocks.procedures import (
    CALL,
    DEFINE,
    header_of,
    parameter_of,
    parameters,
    procedure_of,
    title,
)
from nep_studio.blocks.program import FARTHEST, PAGES, Block, Procedure, Project, Stack
from nep_studio.blocks.slots import FieldValue
from nep_studio.blocks.text import sentence

from .animations import bring_animations, take_along
from .selection import Run, members, require_runs, runs

Points = Mapping[str, tuple[float, float]]
"""Where blocks are on their page, in canvas units, as the canvas has laid them out."""

UNKNOWN: Points = MappingProxyType({})

STEP = 24.0
"""How far a copy lies from what it is a copy of."""


@dataclass(frozen=True)
class Clip:
    """Blocks that are in no project: each stack of ``project`` is one run that was copied.

    ``along`` are the definitions of own blocks of a pack that come along where a project lacks
    them.
    """

    project: Project = field(default_factory=lambda: Project("Blocks"))
    along: Clip | None = None

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
    # The variables that the blocks name, with the ids that they have in their project
    target = clip.project
    used = {
        block.fields.get(key)
        for block in target.blocks.values()
        for key in variable_keys(block, language.definitions)
    }
    for variable in project.variables:
        if variable.id in used:
            count, scope = len(target.variables), variable.scope
            AddVariable(variable.id, variable.name, count, scope).apply(target)
    _add_procedures(clip.project, project)
    _note_rules(clip.project, project, language)
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
    return _keys_of_kind(block, definitions, "variable")


def _keys_of_kind(block: Block, definitions: Mapping[str, Definition], kind: str) -> list[str]:
    definition = definitions.get(block.type)
    if definition is None or kind not in definition.kinds:
        return []
    return [key for key, slot in definition.keys(block.groups) if slot.kind.name == kind]


RULES = "rules"
"""Where a clip keeps what the rules say that its blocks name and that are not in it."""


def _note_rules(clip: Project, project: Project, language: Language) -> None:
    """Note which rules blocks name, so that they mean no other one in another project."""
    said: dict[str, str] = {}
    for block in clip.blocks.values():
        for key in _keys_of_kind(block, language.of(project).definitions, "rule"):
            hat = str(block.fields.get(key, ""))
            if hat in project.blocks and hat not in clip.blocks:
                said[hat] = sentence(project, language, hat)
    if said:
        SetExtra(RULES, said).apply(clip)


def _rule_for(editor: Editor, clip: Project, names: Names, hat: str) -> str:
    """The block with which a rule of a clip begins in the project; "" where it is not there."""
    if hat in names.blocks:
        return names.blocks[hat]
    said, project = clip.extra.get(RULES), editor.project
    if not isinstance(said, dict) or hat not in project.blocks:
        return ""
    return hat if said.get(hat) == sentence(project, editor.language, hat) else ""


def _name_rules(editor: Editor, clip: Clip, names: Names) -> None:
    """Let the new blocks of a clip name the rules that they named there."""
    for new in names.blocks.values():
        block = editor.project.blocks[new]
        for key in _keys_of_kind(block, editor.language.definitions, "rule"):
            named = str(block.fields.get(key, ""))
            meant = _rule_for(editor, clip.project, names, named)
            if meant != named:
                editor.apply(SetField(new, key, meant))


def _create(
    project: Project, roots: list[str], blocks: list[Block], page: str, at: tuple[float, float]
) -> None:
    place = NewStack(page, project.new_id("s"), *at, len(project.pages[page]))
    while place.stack in project.blocks or any(place.stack == block.id for block in blocks):
        place = NewStack(page, project.new_id("s"), *at, len(project.pages[page]))
    CreateBlocks(tuple(roots), tuple(blocks), place).apply(project)


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


# What the names in a clip stand for in another project: its variables and own blocks there.


@dataclass(slots=True)
class Names:
    """Ids in the project by those in the clip; parameters by "own block.parameter" of the clip.

    ``blocks`` are those that have been made.

    ``made`` are the ids of own blocks that the project did not have.
    """

    variables: dict[str, str] = field(default_factory=dict)
    procedures: dict[str, str] = field(default_factory=dict)
    parameters: dict[str, str] = field(default_factory=dict)
    blocks: dict[str, str] = field(default_factory=dict)
    made: list[str] = field(default_factory=list)


def names_for(editor: Editor, clip: Clip) -> Names:
    """Find the variables and own blocks of a clip by their names, and make those that lack."""
    if clip.along is not None:
        bring_definitions(editor, clip.along)
    names = Names()
    known = {variable.name: variable.id for variable in editor.project.variables}
    for variable in clip.project.variables:
        there = known.get(variable.name)
        names.variables[variable.id] = there or editor.add_variable(variable.name, variable.scope)
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
    new.type = renamed_type(block.type, names)
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
    """The own block from the same pack, or that says the same; a new one when there is none, or
    when it has a header already and the clip brings another.
    """
    there = editor.project.procedures.values()
    same = copy_of(editor.project, procedure)
    same = same or next((p for p in there if _signature(p) == _signature(procedure)), None)
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
    return title(procedure), *_taken_and_given(procedure)


def _taken_and_given(procedure: Procedure) -> tuple[object, ...]:
    return tuple(parameter.kind for parameter in parameters(procedure)), procedure.gives_value


def copy_of(project: Project, procedure: Procedure) -> Procedure | None:
    """The own block of a project that is a copy of the same block of a pack, of any version.

    None, too, where it has become another one, to which calls would not fit.
    """
    origin = procedure.origin
    for own in project.procedures.values() if origin is not None else ():
        if own.origin is not None and origin is not None:
            is_same = (own.origin.pack, own.origin.block) == (origin.pack, origin.block)
            if is_same and _taken_and_given(own) == _taken_and_given(procedure):
                return own
    return None


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


def renamed_type(block_type: str, names: Names) -> str:
    """The type of a block with the ids of own block and parameter that these names give."""
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


# Put the blocks of a clip into a project, with ids of their own there.


def paste(editor: Editor, clip: Clip, page: str, x: float, y: float) -> tuple[str, ...]:
    """Put the blocks of a clip on a page, its corner at (x, y); gives the first of each stack.

    Variables and own blocks are found by their names, or made. Raises EditRefused, for blocks of
    another page too.
    """
    _require_blocks(clip)
    left, top = clip.corner
    with editor.transaction("paste blocks"):
        names = names_for(editor, clip)
        bring_animations(editor, clip.project)
        new = tuple(
            put_chain(
                editor,
                clip,
                stack.body,
                names,
                editor.new_stack(page, x + stack.x - left, y + stack.y - top),
            )[0]
            for stack in clip.stacks
        )
        _name_rules(editor, clip, names)
        _add_headers(editor, names, page, x + STEP, y)
    return new


Where = Mapping[str, tuple[str, float, float] | None]
"""Pages and points of definitions, by own block; None and the others: below all that is there."""

BELOW: Where = MappingProxyType({})


def bring_definitions(editor: Editor, along: Clip, where: Where = BELOW) -> None:
    """Put the definitions that a project lacks onto its pages, with what they name."""
    source, project = along.project, editor.project
    lacking = [
        block
        for chain in along.roots
        if not _is_defined(project, source, procedure_of(source.blocks[chain[0]].type))
        for block in chain
    ]
    if not lacking:
        return
    clip = copy(source, editor.language.of(source), lacking)
    names = names_for(editor, clip)
    bring_animations(editor, clip.project)
    for chain in clip.roots:
        own = procedure_of(clip.project.blocks[chain[0]].type)
        page, x, y = where.get(own) or (PAGES[0], STEP, lowest(project, PAGES[0]))
        put_chain(editor, clip, chain, names, editor.new_stack(page, x, y))


def _is_defined(project: Project, source: Project, procedure: str) -> bool:
    there = copy_of(project, source.procedures[procedure])
    return there is not None and bool(header_of(project, there.id))


BLOCK_HEIGHT = 60.0
"""About how high a block is, in canvas units: where nobody has laid the blocks out yet."""


def lowest(project: Project, page: str) -> float:
    """About where the stacks of a page end."""
    ends = (stack.y + height_of(project, stack.body) for stack in project.pages[page])
    return min(max(ends, default=STEP), FARTHEST / 2)


def height_of(project: Project, chain: list[str]) -> float:
    """About how high a chain is with some room below it."""
    return BLOCK_HEIGHT * (1 + sum(1 for _ in project.within(chain)))


def paste_at(editor: Editor, clip: Clip, place: Place) -> tuple[str, ...]:
    """Put the blocks of a clip of one stack into a place; gives the new blocks of the chain."""
    _require_blocks(clip)
    if len(clip.stacks) > 1:
        raise EditRefused(
            "These are several stacks: they can be pasted onto a page only.",
            checklist=("Click an empty place of the page, and paste there.",),
        )
    with editor.transaction("paste blocks"):
        bring_animations(editor, clip.project)
        names = names_for(editor, clip)
        new = put_chain(editor, clip, clip.roots[0], names, place)
        _name_rules(editor, clip, names)
    return new


def duplicate(editor: Editor, ids: Iterable[str], at: Points = UNKNOWN) -> tuple[str, ...]:
    """Copy blocks and put the copies beside them as stacks; gives the first of each.

    ``at`` says where blocks lie that do not begin a stack.
    """
    project, ids = editor.project, list(ids)
    page = project.page_of(require_runs(project, ids)[0].first)
    clip = copy(project, editor.language, ids, at)
    left, top = clip.corner
    with editor.transaction("duplicate blocks"):
        return paste(editor, clip, page, left + STEP, top + STEP)


def put_chain(
    editor: Editor, clip: Clip, chain: Iterable[str], names: Names, place: Place
) -> tuple[str, ...]:
    """Create a chain of a clip with ids that are new to the project; gives them."""
    chain = list(chain)
    old = list(clip.project.within(chain))
    ids = {block.id: editor.project.new_id("b") for block in old}
    blocks = tuple(renewed(editor.language, block, ids, names) for block in old)
    roots = tuple(ids[root] for root in chain)
    editor.apply(CreateBlocks(roots, blocks, place))
    names.blocks |= ids
    return roots


def _add_headers(editor: Editor, names: Names, page: str, x: float, y: float) -> None:
    """Give an own block that was made for a pasted call an empty header, to be filled."""
    for procedure in names.made:
        if not header_of(editor.project, procedure):
            editor.create(DEFINE + procedure, editor.new_stack(page, x + 12 * STEP, y))
            y += 4 * STEP


def _require_blocks(clip: Clip) -> None:
    if not clip.stacks:
        raise EditRefused("There is nothing to paste.", checklist=("Copy some blocks first.",))


# The Python of selected blocks, for the clipboard.

HAT, HOLDER, HELD = "event.started", "variable.set", "value"
"""What makes lines of blocks that make none by themselves: a hat, a statement and its slot."""


def python_of(project: Project, language: Language, ids: Iterable[str]) -> str:
    """The Python of selected blocks: rules whole, other blocks as the lines that they make.

    Raises CodeRefused, which names the block.
    """
    clip = copy(project, language, ids).project
    language = language.of(clip)
    added = {
        stack.id: _complete(clip, language, stack.body[0])
        for stack in list(clip.pages["behaviour"])
    }
    code = generate_program(clip, language)
    lines = code.text.splitlines()
    texts = [_lines(clip, code, lines, stack, blocks) for stack, blocks in added.items()]
    return "\n\n".join(text for text in texts if text)


def _complete(clip: Project, language: Language, first: str) -> set[str]:
    """Put a hat above a stack that has none, and a value into a statement; gives what was added."""
    definition = language.definitions.get(clip.blocks[first].type)
    if definition is None or definition.shape == "hat":
        return set()
    stack = clip.stack_of(first).id
    hat = _create_chain(clip, language, HAT, stack)
    if not definition.is_value:
        return {hat}
    holder = _create_chain(clip, language, HOLDER, stack)
    variable, name = clip.new_id("v"), "value"
    while any(known.name == name for known in clip.variables):
        name += "_"
    AddVariable(variable, name, len(clip.variables)).apply(clip)
    clip.blocks[holder].fields["variable"] = variable
    MoveBlocks(first, 1, InInput(holder, HELD)).apply(clip)
    MoveBlocks(holder, 1, InStack(stack, 1)).apply(clip)
    return {hat, holder}


def _create_chain(clip: Project, language: Language, block_type: str, stack: str) -> str:
    block = language.definitions[block_type].new_block(clip.new_id("b"))
    CreateBlocks((block.id,), (block,), InStack(stack, 0)).apply(clip)
    return block.id


def _lines(clip: Project, code: Code, lines: list[str], stack: str, added: set[str]) -> str:
    """The lines of a stack, without those of the blocks that were added to it."""
    held = [line for block in added for line in code.lines_of(block) if len(added) == 2]
    if held:  # the last of them is “name = value”
        return lines[max(held) - 1].partition(" = ")[2]
    inside = (block.id for block in clip.within(clip.stacks[stack].body) if block.id not in added)
    numbers = [line for block in inside for line in code.lines_of(block)]
    if not numbers:
        return ""
    return textwrap.dedent("\n".join(lines[min(numbers) - 1 : max(numbers)]))


# Delete blocks; what was deleted is given back, for the list of deleted blocks.


def delete(editor: Editor, ids: Iterable[str]) -> Clip:
    """Delete blocks with all that is inside them; chains close up. Gives what was deleted."""
    ids = list(ids)
    chosen = require_runs(editor.project, ids)
    deleted = copy(editor.project, editor.language, ids)
    with editor.transaction("delete blocks"):
        for run in chosen:
            editor.apply(DeleteBlocks(run.first, run.count))
    return deleted
