"""A project as the text of a .nep file: always the same bytes for the same project.

Keys are sorted, blocks too, and each block, stack and variable has a line of its own, so that two
versions of a program compare well.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

import msgspec

from .program import Block, Project

FORMAT = "nep-studio-project"
VERSION = 2


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
        "procedures": _lines(map(msgspec.to_builtins, project.procedures.values())),
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


def _lines(entries: Iterable[object]) -> str:
    lines = ",\n".join(map(_line, entries))
    return f"[\n{lines}\n]" if lines else "[]"


def _line(entry: object) -> str:
    return msgspec.json.encode(entry, order="sorted").decode()
