"""The text of a .nep file as a project; whatever is wrong names the file, the place, the remedy.

Nothing here trusts the file: its size, its nesting, its types, its ids, its shape as a forest, and
each value is checked. Nothing is read by recursion but the JSON itself, which msgspec limits.
"""

from __future__ import annotations

import re
from collections.abc import Container
from typing import Any

import msgspec

from .connections import why_not_variable_name
from .errors import ProjectFileError
from .fitting import why_not_block, why_not_stack
from .language import Language
from .program import FARTHEST, PAGES, Block, Parent, Project, Stack, Variable
from .values import why_not_name, why_not_text
from .writing import FORMAT, VERSION

DEEPEST_EXTRA = 100
_ID = re.compile(r"[A-Za-z0-9_-]{1,64}")
_TYPE = re.compile(r"[A-Za-z0-9_.-]{1,128}")
_KNOWN_KEYS = frozenset(Block.__struct_fields__) - {"extra"}
_UNKNOWN_TYPE_KEYS = _KNOWN_KEYS - {"fields", "groups"}

_OLD_COPY = "Open an older copy of the file, if there is one."


class _File(msgspec.Struct):
    format: str
    version: int
    name: str
    pages: dict[str, list[Stack]]
    blocks: list[dict[str, Any]]
    variables: list[Variable] = []


class _Fault(Exception):
    """What is wrong with the file, and with which block."""

    def __init__(self, sentence: str, block: str = "") -> None:
        super().__init__(sentence)
        self.block = block


def from_bytes(data: bytes, file_name: str, language: Language) -> Project:
    """Read a project, or raise ProjectFileError."""
    decoded = _decode(data, file_name)
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
    except _Fault as fault:
        place = _place(data, fault.block)
        raise ProjectFileError(
            f"{file_name} cannot be used{place}: {fault}",
            checklist=("If the file was changed by hand, change this place back.", _OLD_COPY),
        ) from fault


def _decode(data: bytes, file_name: str) -> object:
    try:
        return msgspec.json.decode(data.removeprefix(b"\xef\xbb\xbf"))
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        sentence, place = _why_not_json(data, error)
        raise ProjectFileError(
            f"{file_name} cannot be read{place}: {sentence}",
            checklist=("Was the file copied completely? Copy it again.", _OLD_COPY),
            details=str(error),
        ) from error


def _why_not_json(data: bytes, error: Exception) -> tuple[str, str]:
    """A sentence and a place for what msgspec says about a file that is no JSON."""
    if isinstance(error, UnicodeDecodeError):
        return "it is not text in UTF-8.", ""
    if isinstance(error, RecursionError):
        return "groups are nested too deep in it.", ""
    if isinstance(error, msgspec.ValidationError):
        return "there is a number in it that is too large.", _place_of_number(data)
    if "truncated" in str(error):
        return "it ends too early, as if a part of it were missing.", ""
    byte = re.search(r"\(byte (\d+)\)", str(error))
    line = _line_at(data, int(byte[1]) if byte else 0)
    return "this is not how a project is written.", f" at line {line}"


def _line_at(data: bytes, offset: int) -> int:
    return data.count(b"\n", 0, offset) + 1


def _place_of_number(data: bytes) -> str:
    for number, line in enumerate(data.splitlines(), start=1):
        try:
            msgspec.json.decode(line.strip().rstrip(b","))
        except msgspec.ValidationError:
            return f" at line {number}"
        except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
            continue
    return ""


def _place(data: bytes, block: str) -> str:
    if not block:
        return ""
    entry = re.search(rb'"id"\s*:\s*"' + re.escape(block.encode()) + rb'"', data)
    line = f"line {_line_at(data, entry.start())}, " if entry else ""
    return f" at {line}block {block}"


def _project(decoded: dict[str, Any], language: Language) -> Project:
    try:
        file = msgspec.convert(decoded, _File)
    except msgspec.ValidationError as error:
        raise _Fault(f"{_in_words(error)}.") from error
    if (reason := why_not_name(file.name)) is not None:
        raise _Fault(f"the project's name: {reason}")
    project = Project(file.name)
    _read_variables(project, file.variables)
    for entry in file.blocks:
        _read_block(project, entry, language)
    _read_pages(project, file.pages)
    _find_parents(project)
    for block in project.blocks.values():
        if (reason := why_not_block(block, project.blocks, language)) is not None:
            raise _Fault(reason, block.id)
    for stack in project.stacks.values():
        if (fault := why_not_stack(stack.body, project.blocks, language)) is not None:
            raise _Fault(fault[1], fault[0])
    return project


def _in_words(error: msgspec.ValidationError) -> str:
    """Turn “Expected `str`, got `int` - at `$.name`” into words."""
    what, _, where = str(error).partition(" - at ")
    place = where.strip("`").removeprefix("$.") or "its beginning"
    return f"at {place}: {what.replace('`', '')}"


def _read_variables(project: Project, variables: list[Variable]) -> None:
    for variable in variables:
        _new_id(project, variable.id, {v.id for v in project.variables})
        if (reason := why_not_variable_name(project, variable.name)) is not None:
            raise _Fault(f"the variable “{variable.name[:40]}”: {reason}")
        project.variables.append(variable)


def _read_block(project: Project, entry: dict[str, Any], language: Language) -> None:
    block_id, block_type = entry.get("id"), entry.get("type")
    if not isinstance(block_id, str) or not isinstance(block_type, str):
        raise _Fault(f"block number {len(project.blocks) + 1} needs an id and a type.")
    _new_id(project, block_id, project.blocks)
    if not _TYPE.fullmatch(block_type):
        raise _Fault("the block's type is not a name.", block_id)
    definition = language.definitions.get(block_type)
    keys = _KNOWN_KEYS if definition is not None else _UNKNOWN_TYPE_KEYS
    try:
        block = msgspec.convert({key: entry[key] for key in keys & entry.keys()}, Block)
    except msgspec.ValidationError as error:
        raise _Fault(f"{_in_words(error)}.", block_id) from error
    if (reason := why_not_text(block.comment)) is not None:
        raise _Fault(f"its comment: {reason}", block_id)
    block.extra = {key: value for key, value in entry.items() if key not in keys}
    if _is_deeper(block.extra, DEEPEST_EXTRA):
        raise _Fault("groups are nested too deep in it.", block_id)
    block.bodies = {slot: chain for slot, chain in block.bodies.items() if chain}
    if definition is not None:
        block.groups = {**definition.minimum, **block.groups}
    project.blocks[block_id] = block


def _new_id(project: Project, some_id: str, taken: Container[str]) -> None:
    if not _ID.fullmatch(some_id):
        raise _Fault(f"{some_id[:40]!a} is not an id: letters, digits, - and _ can be in it.")
    if some_id in taken:
        raise _Fault("this id is there twice.", some_id)
    project.id_seen(some_id)


def _read_pages(project: Project, pages: dict[str, list[Stack]]) -> None:
    taken = set(project.blocks)
    for page, stacks in pages.items():
        if page not in PAGES:
            raise _Fault(f"there is no page “{page[:40]}”: {', '.join(PAGES)} are the pages.")
        for stack in stacks:
            _new_id(project, stack.id, taken)
            taken.add(stack.id)
            if not all(abs(place) <= FARTHEST for place in (stack.x, stack.y)):
                raise _Fault(f"stack {stack.id} lies too far outside.")
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
            raise _Fault(f"the block is {where}.", block_id)


def _put(project: Project, block_id: str, parent: Parent) -> None:
    if block_id not in project.blocks:
        raise _Fault(f"block “{block_id[:40]}” is named by {parent.owner}, but is not there.")
    if block_id in project.parents:
        raise _Fault(
            f"the block is in two places: {project.parents[block_id].owner} and {parent.owner}.",
            block_id,
        )
    project.parents[block_id] = parent


def _is_deeper(value: object, limit: int) -> bool:
    layer = [value]
    for _ in range(limit):
        layer = [
            inner
            for outer in layer
            if isinstance(outer, dict | list)
            for inner in (outer.values() if isinstance(outer, dict) else outer)
        ]
        if not layer:
            return False
    return True
