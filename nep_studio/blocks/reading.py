"""The text of a .nep file as a project; whatever is wrong names the file, the place, the remedy.

Nothing here trusts the file: its size, its nesting, its types, its ids, its shape as a forest, and
each value is checked.
"""

from __future__ import annotations

import re
from collections.abc import Container
from typing import Any

import msgspec

from .connections import MOST_NOTES, MOST_PAGES, why_not_note, why_not_size, why_not_variable_name
from .edits.own_blocks import see_ids
from .errors import ProjectFileError
from .file_text import OLD_COPY, Fault, decode, in_words, is_deeper, place_in
from .fitting import why_not_block, why_not_stack
from .language import Language
from .own_animations import PREFIX, why_not_animation
from .own_gestures import why_not_kept
from .procedures import MOST_PROCEDURES, why_not_procedure
from .program import FARTHEST, PAGES, Block, Note, Parent, Procedure, Project, Stack, Variable
from .values import why_not_name, why_not_text
from .writing import FORMAT, VERSION

DEEPEST_EXTRA = 100
_ID = re.compile(r"[A-Za-z0-9_-]{1,64}")
_TYPE = re.compile(r"[A-Za-z0-9_.-]{1,128}")
_KNOWN_KEYS = frozenset(Block.__struct_fields__) - {"extra"}
_UNKNOWN_TYPE_KEYS = _KNOWN_KEYS - {"fields", "groups"}


class _Page(msgspec.Struct):
    id: str
    title: str = ""


class _File(msgspec.Struct):
    """The file; version 1 had neither own blocks nor notes, and three pages."""

    format: str
    version: int
    name: str
    pages: dict[str, list[Stack]]
    blocks: list[dict[str, Any]]
    variables: list[Variable] = []
    procedures: list[Procedure] = []
    notes: list[Note] = []
    page_order: list[_Page] = []


def from_bytes(data: bytes, file_name: str, language: Language) -> Project:
    """Read a project, or raise ProjectFileError."""
    decoded = decode(data, file_name)
    if not isinstance(decoded, dict) or decoded.get("format") != FORMAT:
        raise ProjectFileError(
            f"{file_name} is not a NEP Studio project.",
            checklist=("Choose a file that NEP Studio has saved; its name ends in .nep.",),
        )
    version = decoded.get("version")
    if isinstance(version, int) and version > VERSION:
        raise ProjectFileError(
            f"{file_name} was saved by a newer NEP Studio (format {version}; this one reads "
            f"up to {VERSION}).",
            checklist=("Update NEP Studio, then open the file again.",),
        )
    try:
        return _project(decoded, language)
    except Fault as fault:
        place = place_in(data, fault.block)
        raise ProjectFileError(
            f"{file_name} cannot be used{place}: {fault}",
            checklist=("If the file was changed by hand, change this place back.", OLD_COPY),
        ) from fault


def _project(decoded: dict[str, Any], language: Language) -> Project:
    try:
        file = msgspec.convert(decoded, _File)
    except msgspec.ValidationError as error:
        raise Fault(f"{in_words(error)}.") from error
    if (reason := why_not_name(file.name)) is not None:
        raise Fault(f"the project's name: {reason}")
    project = Project(file.name)
    project.extra = {k: v for k, v in decoded.items() if k not in _File.__struct_fields__}
    if is_deeper(project.extra, DEEPEST_EXTRA):
        raise Fault("groups are nested too deep in it.")
    _check_kept(project)
    _read_variables(project, file.variables)
    _read_procedures(project, file.procedures)
    _read_page_order(project, file.page_order)
    language = language.of(project)
    for entry in file.blocks:
        _read_block(project, entry, language)
    _read_pages(project, file.pages)
    _read_notes(project, file.notes)
    _find_parents(project)
    for block in project.blocks.values():
        if (reason := why_not_block(block, project.blocks, language)) is not None:
            raise Fault(reason, block.id)
    for stack in project.stacks.values():
        if (fault := why_not_stack(stack.body, project.blocks, language)) is not None:
            raise Fault(fault[1], fault[0])
    return project


def _check_kept(project: Project) -> None:
    for key, value in project.extra.items():
        if (reason := why_not_kept(key, value)) is not None:
            raise Fault(reason)
        name = key.removeprefix(PREFIX)
        if name != key and (reason := why_not_animation(name, value)) is not None:
            raise Fault(f"the animation “{name[:40]}”: {reason}")


def _read_variables(project: Project, variables: list[Variable]) -> None:
    for variable in variables:
        _new_id(project, variable.id, {v.id for v in project.variables})
        if (reason := why_not_variable_name(project, variable.name)) is not None:
            raise Fault(f"the variable “{variable.name[:40]}”: {reason}")
        project.variables.append(variable)


def _read_procedures(project: Project, procedures: list[Procedure]) -> None:
    if len(procedures) > MOST_PROCEDURES:
        raise Fault(f"there are too many own blocks: {MOST_PROCEDURES} at most.")
    for procedure in procedures:
        if (reason := why_not_procedure(procedure)) is not None:
            raise Fault(f"the own block “{procedure.id[:40]}”: {reason}")
        _new_id(project, procedure.id, project.procedures)
        project.procedures[procedure.id] = procedure
        see_ids(project, procedure)
    project.touch_procedures()
    project.changes.whole = False  # nobody has seen the project yet


def _read_page_order(project: Project, order: list[_Page]) -> None:
    """The pages in their order; pages that every project has come last where none is said."""
    if len(order) > MOST_PAGES:
        raise Fault(f"there are too many pages: {MOST_PAGES} at most.")
    pages: dict[str, list[Stack]] = {}
    for page in order:
        _new_id(project, page.id, pages)
        if page.title and (reason := why_not_name(page.title)) is not None:
            raise Fault(f"the title of a page: {reason}")
        pages[page.id] = []
        if page.title:
            project.page_titles[page.id] = page.title
    project.pages = {**pages, **{page: [] for page in PAGES if page not in pages}}


def _read_notes(project: Project, notes: list[Note]) -> None:
    if len(notes) > MOST_NOTES:
        raise Fault(f"there are too many notes: {MOST_NOTES} at most.")
    for note in notes:
        _new_id(project, note.id, project.notes)
        if (reason := why_not_note(project, note)) is not None:
            raise Fault(f"the note {note.id}: {reason}")
        project.notes[note.id] = note


def _read_block(project: Project, entry: dict[str, Any], language: Language) -> None:
    block_id, block_type = entry.get("id"), entry.get("type")
    if not isinstance(block_id, str) or not isinstance(block_type, str):
        raise Fault(f"block number {len(project.blocks) + 1} needs an id and a type.")
    _new_id(project, block_id, project.blocks)
    definition = language.definitions.get(block_type)
    if definition is None and not _TYPE.fullmatch(block_type):
        raise Fault("the block's type is not a name.", block_id)
    keys = _KNOWN_KEYS if definition is not None else _UNKNOWN_TYPE_KEYS
    known = entry if entry.keys() <= keys else {k: entry[k] for k in keys & entry.keys()}
    try:
        block = msgspec.convert(known, Block)
    except msgspec.ValidationError as error:
        raise Fault(f"{in_words(error)}.", block_id) from error
    if block.comment or block.comment_width or block.comment_height:
        _require_comment(block)
    if len(known) < len(entry):
        block.extra = {key: value for key, value in entry.items() if key not in keys}
        if is_deeper(block.extra, DEEPEST_EXTRA):
            raise Fault("groups are nested too deep in it.", block_id)
    if block.bodies:
        block.bodies = {slot: chain for slot, chain in block.bodies.items() if chain}
    if definition is not None and definition.minimum:
        block.groups = {**definition.minimum, **block.groups}
    project.blocks[block_id] = block


def _require_comment(block: Block) -> None:
    reason = why_not_text(block.comment) or why_not_size(block.comment_width, block.comment_height)
    if reason is not None:
        raise Fault(f"its comment: {reason}", block.id)


def _new_id(project: Project, some_id: str, taken: Container[str]) -> None:
    if not _ID.fullmatch(some_id):
        raise Fault(f"{some_id[:40]!a} is not an id: letters, digits, - and _ can be in it.")
    if some_id in taken:
        raise Fault("this id is there twice.", some_id)
    project.id_seen(some_id)


def _read_pages(project: Project, pages: dict[str, list[Stack]]) -> None:
    taken = set(project.blocks)
    for page, stacks in pages.items():
        if page not in project.pages:
            raise Fault(f"there is no page “{page[:40]}”: {', '.join(project.pages)} are.")
        for stack in stacks:
            _new_id(project, stack.id, taken)
            taken.add(stack.id)
            if not all(abs(place) <= FARTHEST for place in (stack.x, stack.y)):
                raise Fault(f"stack {stack.id} lies too far outside.")
            if stack.body:
                project.stacks[stack.id] = stack
                project.pages[page].append(stack)


def _find_parents(project: Project) -> None:
    """Note where each block is; each must be in one place, and be reached from a stack."""
    for stack in project.stacks.values():
        for block_id in stack.body:
            _put(project, block_id, Parent(stack.id))
    for block in project.blocks.values():
        for slot, plugged in block.inputs.items():
            _put(project, plugged, Parent(block.id, slot))
        for slot, chain in block.bodies.items():
            for block_id in chain:
                _put(project, block_id, Parent(block.id, slot))
    # With one parent each, a block that no stack reaches is alone or in a circle.
    reached = {
        block.id for stack in project.stacks.values() for block in project.within(stack.body)
    }
    for block_id in project.blocks:
        if block_id not in reached:
            where = "inside itself" if block_id in project.parents else "in no stack"
            raise Fault(f"the block is {where}.", block_id)


def _put(project: Project, block_id: str, parent: Parent) -> None:
    if block_id not in project.blocks:
        raise Fault(f"block “{block_id[:40]}” is named by {parent.owner}, but is not there.")
    if block_id in project.parents:
        raise Fault(
            f"the block is in two places: {project.parents[block_id].owner} and {parent.owner}.",
            block_id,
        )
    project.parents[block_id] = parent
