"""Open and save .nep files; saving never loses the file that was there."""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Container, Iterable
from pathlib import Path
from typing import Any, Literal

import msgspec
from msgspec.structs import replace

from faults import Text, reason_of
from faults.files import whole_file

from .code_text import trim_python
from .definitions import Definition
from .edit_rules import (
    MOST_NOTES,
    MOST_PAGES,
    why_not_block,
    why_not_note,
    why_not_size,
    why_not_stack,
    why_not_variable_name,
)
from .edits.content import see_ids
from .errors import ProjectFileError
from .file_text import OLD_COPY, Flaw, decode, in_words, is_deeper, place_in
from .generate.scopes import share_as_before
from .language import Language
from .own_animations import PREFIX, why_not_animation
from .own_gestures import why_not_kept
from .procedures import MOST_PROCEDURES, why_not_procedure
from .program import FARTHEST, PAGES, Block, Note, Parent, Procedure, Project, Stack, Variable
from .slots import why_not_name, why_not_text

# A project as the text of a .nep file: always the same bytes for the same project.
#
# Keys are sorted, blocks too, and each block, stack and variable has a line of its own, so that
# two versions of a program compare well.

FORMAT = "nep-studio-project"
VERSION = 3


_ALL_SHARED = 2
"""The version in which stacks always shared the variables that several of them used."""


def to_bytes(project: Project) -> bytes:
    """The text of a project in UTF-8."""
    pages = [
        f"{_line(page)}: {_lines(msgspec.to_builtins(stack) for stack in stacks)}"
        for page, stacks in sorted(project.pages.items())
    ]
    blocks = sorted(project.blocks.values(), key=lambda block: natural_key(block.id))
    notes = sorted(project.notes.values(), key=lambda note: natural_key(note.id))
    titles = project.page_titles
    entries = {
        "blocks": _lines(map(_block, blocks)),
        "format": f'"{FORMAT}"',
        "name": _line(project.name),
        "notes": _lines(map(msgspec.to_builtins, notes)),
        "page_order": _lines({"id": page, "title": titles.get(page, "")} for page in project.pages),
        "pages": "{\n" + ",\n".join(pages) + "\n}",
        "procedures": _lines(map(_procedure, project.procedures.values())),
        "variables": _lines(map(msgspec.to_builtins, project.variables)),
        "version": str(VERSION),
        **{key: _line(value) for key, value in project.extra.items()},
    }
    text = ",\n".join(f"{_line(key)}: {entries[key]}" for key in sorted(entries))
    return ("{\n" + text + "\n}\n").encode()


def natural_key(some_id: str) -> tuple[str, int, str]:
    """Sort b2 before b10."""
    digits = re.search(r"[0-9]{1,15}$", some_id)
    return (some_id[: digits.start()], int(digits[0]), some_id) if digits else (some_id, -1, "")


def _block(block: Block) -> dict[str, Any]:
    """What is not said is empty, off or the default; extra keys are as they were."""
    entry: dict[str, Any] = msgspec.to_builtins(block)
    entry.update(entry.pop("extra", {}))
    for size in ("comment_width", "comment_height"):
        if not entry.get(size, 1):
            del entry[size]
    groups = {name: count for name, count in block.groups.items() if count}
    if groups:
        entry["groups"] = groups
    elif block.groups:
        del entry["groups"]
    return entry


def _procedure(procedure: Procedure) -> dict[str, Any]:
    """What is not told of an own block is left out; extra keys are as they were."""
    entry: dict[str, Any] = msgspec.to_builtins(procedure)
    extra = entry.pop("extra")
    for key in ("help", "sentences", "origin"):
        if not entry[key]:
            del entry[key]
    return {**extra, **entry}


def _lines(entries: Iterable[object]) -> str:
    lines = ",\n".join(map(_line, entries))
    return f"[\n{lines}\n]" if lines else "[]"


def _line(entry: object) -> str:
    return msgspec.json.encode(entry, order="sorted").decode()


# The text of a .nep file as a project; whatever is wrong names the file, the place, the remedy.
#
# Nothing here trusts the file: its size, its nesting, its types, its ids, its shape as a forest,
# and each value is checked.

DEEPEST_EXTRA = 100
_ID = re.compile(r"[A-Za-z0-9_-]{1,64}")
_TYPE = re.compile(r"[A-Za-z0-9_.-]{1,128}")
_KNOWN_KEYS = frozenset(Block.__struct_fields__) - {"extra"}
_PROCEDURE_KEYS = frozenset(Procedure.__struct_fields__) - {"extra"}
_UNKNOWN_TYPE_KEYS = _KNOWN_KEYS - {"fields", "groups"}


class _Page(msgspec.Struct):
    id: str
    title: str = ""


class _File(msgspec.Struct):
    """The file; what one that was written by hand leaves out is empty."""

    format: str
    version: Literal[2, 3]  # VERSION
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
            "{file_name} is not a NEP Studio project.",
            checklist=("Choose a file that NEP Studio has saved; its name ends in .nep.",),
            file_name=file_name,
        )
    version = decoded.get("version")
    if isinstance(version, int) and version > VERSION:
        raise ProjectFileError(
            "{file_name} was saved by a newer NEP Studio (format {version}; this one reads up to "
            "{version_2}).",
            checklist=("Update NEP Studio, then open the file again.",),
            file_name=file_name,
            version=version,
            version_2=VERSION,
        )
    try:
        return _project(decoded, language)
    except Flaw as flaw:
        place = place_in(data, flaw.block)
        raise ProjectFileError(
            "{file_name} cannot be used{place}: {fault}",
            checklist=("If the file was changed by hand, change this place back.", OLD_COPY),
            file_name=file_name,
            place=place,
            fault=flaw,
        ) from flaw


def _project(decoded: dict[str, Any], language: Language) -> Project:
    own = decoded.get("procedures")
    if isinstance(own, list):
        decoded = {**decoded, "procedures": [_without_unknown(entry) for entry in own]}
    try:
        file = msgspec.convert(decoded, _File)
    except msgspec.ValidationError as error:
        raise Flaw(in_words(error)) from error
    if (reason := why_not_name(file.name)) is not None:
        raise Flaw("the project's name: {reason}", reason=reason)
    project = Project(file.name)
    project.extra = {k: v for k, v in decoded.items() if k not in _File.__struct_fields__}
    if is_deeper(project.extra, DEEPEST_EXTRA):
        raise Flaw("groups are nested too deep in it.")
    _check_kept(project)
    _read_variables(project, file.variables)
    _read_procedures(project, file.procedures, own if isinstance(own, list) else [])
    _read_page_order(project, file.page_order)
    language = language.of(project)
    for entry in file.blocks:
        _read_block(project, entry, language)
    _read_pages(project, file.pages)
    _read_notes(project, file.notes)
    _find_parents(project)
    for block in project.blocks.values():
        if (reason := why_not_block(block, project.blocks, language)) is not None:
            raise Flaw(reason, block.id)
    for stack in project.stacks.values():
        if (fault := why_not_stack(stack.body, project.blocks, language)) is not None:
            raise Flaw(fault[1], fault[0])
    if file.version == _ALL_SHARED:
        share_as_before(project, language)
    return project


def _without_unknown(entry: object) -> object:
    """An own block of the file without the keys that are kept as they are."""
    if not isinstance(entry, dict):
        return entry
    return {key: value for key, value in entry.items() if key in _PROCEDURE_KEYS}


def _check_kept(project: Project) -> None:
    for key, value in project.extra.items():
        if (reason := why_not_kept(key, value)) is not None:
            raise Flaw(reason)
        name = key.removeprefix(PREFIX)
        if name != key and (reason := why_not_animation(name, value)) is not None:
            raise Flaw("the animation “{name}”: {reason}", name=name[:40], reason=reason)


def _read_variables(project: Project, variables: list[Variable]) -> None:
    for variable in variables:
        _new_id(project, variable.id, {v.id for v in project.variables})
        if (reason := why_not_variable_name(project, variable.name)) is not None:
            raise Flaw("the variable “{name}”: {reason}", name=variable.name[:40], reason=reason)
        project.variables.append(variable)


def _read_procedures(
    project: Project, procedures: list[Procedure], entries: list[dict[str, Any]]
) -> None:
    if len(procedures) > MOST_PROCEDURES:
        raise Flaw(
            "there are too many own blocks: {most_procedures} at most.",
            most_procedures=MOST_PROCEDURES,
        )
    for known, entry in zip(procedures, entries, strict=True):
        extra = {key: value for key, value in entry.items() if key not in _PROCEDURE_KEYS}
        procedure = replace(known, extra=extra)
        if is_deeper(extra, DEEPEST_EXTRA):
            raise Flaw("groups are nested too deep in it.")
        if (reason := why_not_procedure(procedure)) is not None:
            raise Flaw("the own block “{id}”: {reason}", id=procedure.id[:40], reason=reason)
        _new_id(project, procedure.id, project.procedures)
        project.procedures[procedure.id] = procedure
        see_ids(project, procedure)
    project.touch_procedures()
    project.changes.whole = False  # nobody has seen the project yet


def _read_page_order(project: Project, order: list[_Page]) -> None:
    """The pages in their order; pages that every project has come last where none is said."""
    if len(order) > MOST_PAGES:
        raise Flaw("there are too many pages: {most_pages} at most.", most_pages=MOST_PAGES)
    pages: dict[str, list[Stack]] = {}
    for page in order:
        _new_id(project, page.id, pages)
        if page.title and (reason := why_not_name(page.title)) is not None:
            raise Flaw("the title of a page: {reason}", reason=reason)
        pages[page.id] = []
        if page.title:
            project.page_titles[page.id] = page.title
    project.pages = {**pages, **{page: [] for page in PAGES if page not in pages}}


def _read_notes(project: Project, notes: list[Note]) -> None:
    if len(notes) > MOST_NOTES:
        raise Flaw("there are too many notes: {most_notes} at most.", most_notes=MOST_NOTES)
    for note in notes:
        _new_id(project, note.id, project.notes)
        if (reason := why_not_note(project, note)) is not None:
            raise Flaw("the note {id}: {reason}", id=note.id, reason=reason)
        project.notes[note.id] = note


def _read_block(project: Project, entry: dict[str, Any], language: Language) -> None:
    block_id, block_type = entry.get("id"), entry.get("type")
    if not isinstance(block_id, str) or not isinstance(block_type, str):
        raise Flaw("block number {count} needs an id and a type.", count=len(project.blocks) + 1)
    _new_id(project, block_id, project.blocks)
    definition = language.definitions.get(block_type)
    if definition is None and not _TYPE.fullmatch(block_type):
        raise Flaw("the block's type is not a name.", block_id)
    keys = _KNOWN_KEYS if definition is not None else _UNKNOWN_TYPE_KEYS
    known = entry if entry.keys() <= keys else {k: entry[k] for k in keys & entry.keys()}
    try:
        block = msgspec.convert(known, Block)
    except msgspec.ValidationError as error:
        raise Flaw(in_words(error), block_id) from error
    if block.comment or block.comment_width or block.comment_height:
        reason = why_not_text(block.comment) or why_not_size(
            block.comment_width, block.comment_height
        )
        if reason is not None:
            raise Flaw("its comment: {reason}", block.id, reason=reason)
    if len(known) < len(entry):
        block.extra = {key: value for key, value in entry.items() if key not in keys}
        if is_deeper(block.extra, DEEPEST_EXTRA):
            raise Flaw("groups are nested too deep in it.", block_id)
    if block.bodies:
        block.bodies = {slot: chain for slot, chain in block.bodies.items() if chain}
    if definition is not None and definition.groups:
        unfold_values(block, definition)
        block.groups = {**definition.minimum, **block.groups}
    if definition is not None and definition.holds_python:
        trim_python(block, definition)
    project.blocks[block_id] = block


def unfold_values(block: Block, definition: Definition) -> None:
    """Put values where they are now that a part of the sentence unfolds.

    In older files they stand beside the part; one that says nothing new leaves it folded.
    """
    for key in list(block.fields):
        slot = definition.slots.get(key)
        if slot is None or not slot.group or definition.groups[slot.group].maximum > 1:
            continue
        value = block.fields.pop(key)
        if value != definition.defaults.get(key):
            block.groups.setdefault(slot.group, 1)
            block.fields.setdefault(f"{key}.1", value)


def _new_id(project: Project, some_id: str, taken: Container[str]) -> None:
    if not _ID.fullmatch(some_id):
        raise Flaw(
            "{some_id} is not an id: letters, digits, - and _ can be in it.",
            some_id=f"{some_id[:40]!a}",
        )
    if some_id in taken:
        raise Flaw("this id is there twice.", some_id)
    project.id_seen(some_id)


def _read_pages(project: Project, pages: dict[str, list[Stack]]) -> None:
    taken = set(project.blocks)
    for page, stacks in pages.items():
        if page not in project.pages:
            raise Flaw(
                "there is no page “{page}”: {pages} are.",
                page=page[:40],
                pages=", ".join(project.pages),
            )
        for stack in stacks:
            _new_id(project, stack.id, taken)
            taken.add(stack.id)
            if not all(abs(place) <= FARTHEST for place in (stack.x, stack.y)):
                raise Flaw("stack {id} lies too far outside.", id=stack.id)
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
            where = Text("inside itself" if block_id in project.parents else "in no stack")
            raise Flaw("the block is {where}.", block_id, where=where)


def _put(project: Project, block_id: str, parent: Parent) -> None:
    if block_id not in project.blocks:
        raise Flaw(
            "block “{block_id}” is named by {owner}, but is not there.",
            block_id=block_id[:40],
            owner=parent.owner,
        )
    if block_id in project.parents:
        raise Flaw(
            "the block is in two places: {owner} and {owner_2}.",
            block_id,
            owner=project.parents[block_id].owner,
            owner_2=parent.owner,
        )
    project.parents[block_id] = parent


LARGEST_BYTES = 60_000_000

_CHOOSE = ("Is the file still where it was?", "Choose a project that NEP Studio has saved.")


def load(path: Path, language: Language) -> Project:
    """Read a project; raises ProjectFileError, which names the file, the place, the remedy."""
    try:
        if path.is_dir() or (path.exists() and not path.is_file()):
            raise ProjectFileError("{name} is not a file.", checklist=_CHOOSE, name=path.name)
        with path.open("rb") as file:
            data = file.read(LARGEST_BYTES + 1)
    except OSError as error:
        raise ProjectFileError(
            "{name} cannot be opened: {reason}.",
            checklist=_CHOOSE,
            details=str(path),
            name=path.name,
            reason=reason_of(error),
        ) from error
    if len(data) > LARGEST_BYTES:
        raise ProjectFileError(
            "{name} is too large: more than {largest_bytes} MB.",
            checklist=_CHOOSE,
            name=path.name,
            largest_bytes=LARGEST_BYTES // 1_000_000,
        )
    return from_bytes(data, path.name, language)


def save(project: Project, path: Path) -> None:
    """Write a project beside the old file, then put it in its place in one step.

    Raises ProjectFileError; the old file is then as it was.
    """
    target = path.resolve()
    try:
        data = to_bytes(project)
        if target.exists() and not os.access(target, os.W_OK):  # the folder alone would allow it
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        with whole_file(target) as file:
            file.write(data)
    except (OSError, UnicodeEncodeError) as error:
        reason = (
            reason_of(error)
            if isinstance(error, OSError)
            else Text("a text in it cannot be written")
        )
        raise ProjectFileError(
            "{name} could not be saved: {reason}. The file that was there is unchanged.",
            checklist=(
                "Is there room on the disk?",
                "May you write into this folder? Save the project in another one.",
            ),
            details=str(error),
            name=path.name,
            reason=reason,
        ) from error
