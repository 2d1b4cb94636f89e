"""Checks of own blocks: called without a definition, defined twice, giving nothing, in circles."""

from __future__ import annotations

from collections.abc import Iterator

from ..deployment import chains
from ..language import Language
from ..procedures import CALL, DEFINE, RETURN, procedure_of, title
from ..program import Block, Project
from .problem import Problem, page_of


def check_own_blocks(project: Project, language: Language) -> Iterator[Problem]:
    """Problems of own blocks; nothing is looked at where there are none."""
    if not project.procedures:
        return
    headers: dict[str, str] = {}
    calls: dict[str, dict[str, str]] = {}
    for chain in chains(project, language):
        header = project.blocks[chain[0]]
        owner = procedure_of(header.type) if header.type.startswith(DEFINE) else ""
        blocks = list(project.within(chain, enabled=True))
        called = calls.setdefault(owner, {})
        for block in blocks:
            if block.type.startswith(CALL):
                called.setdefault(procedure_of(block.type), block.id)
        if not owner:
            continue
        if headers.setdefault(owner, header.id) != header.id:
            yield _twice(project, header)
        if project.procedures[owner].gives_value and not _gives_back(blocks):
            yield _gives_nothing(project, header)
    yield from _undefined(project, headers, calls)
    yield from _circles(project, headers, calls)


def _gives_back(blocks: list[Block]) -> bool:
    return any(block.type == RETURN for block in blocks)


def _twice(project: Project, header: Block) -> Problem:
    return Problem(
        "error",
        "defined_twice",
        page_of(project, header.id),
        header.id,
        f"The block “{_name(project, procedure_of(header.type))}” is defined twice.",
        ("Take one of the two definitions out.",),
    )


def _gives_nothing(project: Project, header: Block) -> Problem:
    return Problem(
        "warning",
        "gives_nothing",
        page_of(project, header.id),
        header.id,
        f"“{_name(project, procedure_of(header.type))}” gives a value, but there is no "
        "“give back” block in it.",
        ("Put “give back” at its end.", "Or let the block give no value."),
    )


def _undefined(
    project: Project, headers: dict[str, str], calls: dict[str, dict[str, str]]
) -> Iterator[Problem]:
    missing = {p: block for called in calls.values() for p, block in called.items()}
    for procedure, block in missing.items():
        if procedure in project.procedures and procedure not in headers:
            yield Problem(
                "error",
                "no_definition",
                page_of(project, block),
                block,
                f"Nothing says what “{_name(project, procedure)}” does: "
                "its “define” block is on no page, or it is switched off.",
                ("Put its “define” block onto a page again.", "Or take this block out."),
            )


def _circles(
    project: Project, headers: dict[str, str], calls: dict[str, dict[str, str]]
) -> Iterator[Problem]:
    for procedure, header in headers.items():
        if _reaches(procedure, calls):
            yield Problem(
                "info",
                "calls_itself",
                page_of(project, header),
                header,
                f"“{_name(project, procedure)}” calls itself, at once or through another block.",
                ("Make sure that it comes to an end: some way through it must not call it.",),
            )


def _reaches(procedure: str, calls: dict[str, dict[str, str]]) -> bool:
    """Whether an own block is called, however indirectly, by itself."""
    waiting, seen = list(calls.get(procedure, ())), set[str]()
    while waiting:
        called = waiting.pop()
        if called == procedure:
            return True
        if called not in seen:
            seen.add(called)
            waiting += calls.get(called, ())
    return False


def _name(project: Project, procedure: str) -> str:
    return title(project.procedures[procedure])
