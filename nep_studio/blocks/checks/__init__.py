"""Everything that can be told about a program before it runs, in plain words."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import Any, TypeVar

from ..deployment import chains, find_uses, node_entries, robot_entries
from ..generate.names import python_name
from ..language import Language
from ..program import Project
from ..sharing import look_at, sharing_of
from ..slices import Steps, at_once
from .blocks import check_blocks, check_inside, check_own_blocks
from .deployment import (
    check_abilities,
    check_deployment,
    check_goals,
    check_real_robots,
    check_rules,
    check_talk,
    check_trees,
)
from .diagnostic import SEVERITIES, Diagnostic, Fix
from .facts import check_facts
from .flow import check_flow, check_limits, check_shared

One = TypeVar("One")
_OfChain = Callable[[Project, Language, list[str]], Iterator[One | None]]
"""What looks at the blocks of one chain, and at no other; None wherever it may rest."""


class KnownChains:
    """What was found in each chain, as long as neither it nor what is around it changes."""

    def __init__(self) -> None:
        self._around: object = None
        self._found: dict[object, tuple[object, list[Any]]] = {}

    def begin(self, project: Project, language: Language) -> None:
        """Forget all when something has changed that a check of any chain may look at."""
        around = (
            language,
            project.procedure_revision,
            project.extra_revision,
            list(project.variables),
            list(project.pages),
            dict(language.robots),
            robot_entries(project, language),
        )
        if around != self._around:
            self._around = around
            self._found.clear()

    def in_chains(
        self, look: _OfChain[One], project: Project, language: Language, found_in: list[list[str]]
    ) -> Steps[list[One]]:
        """What is found in chains that begin a stack."""
        found = list[One]()
        for chain in found_in:
            yield
            stack = project.stack_of(chain[0]).id
            revision = project.revisions.get(stack, 0)
            of_chain = partial(look, project, language, chain)
            found += yield from self.find((look, stack), revision, of_chain)
        return found

    def find(
        self, key: object, of: object, look: Callable[[], Iterable[One | None]]
    ) -> Steps[list[One]]:
        """What is found, or was found already when it was the same as now that it follows from."""
        known = self._found.get(key)
        if known is None or known[0] != of:
            found = list[One]()
            for one in look():
                if one is None:
                    yield
                else:
                    found.append(one)
            known = self._found[key] = of, found
        return known[1]


def check(project: Project, language: Language) -> list[Diagnostic]:
    """The problems of a program, errors first."""
    return at_once(check_steps(project, language))


def check_steps(
    project: Project, language: Language, known: KnownChains | None = None
) -> Steps[list[Diagnostic]]:
    """The same in steps: a large program takes longer than a frame of the screen.

    ``known`` has what was found the last time.
    """
    language, known = language.of(project), known or KnownChains()
    known.begin(project, language)
    every = [stack.body for stacks in project.pages.values() for stack in stacks]
    running = list(chains(project, language))
    problems = list(check_rules(project, language, running))
    problems += check_goals(project, language, running)
    problems += check_facts(project, language, running)
    problems += yield from known.in_chains(check_blocks, project, language, every)
    problems += yield from known.in_chains(check_inside, project, language, running)
    trees = partial(check_trees, project, language, running)
    problems += yield from known.find(check_trees, object(), trees)
    if project.procedures:
        own = partial(check_own_blocks, project, language, running)
        always_anew = object()
        problems += yield from known.find(check_own_blocks, always_anew, own)
    for look in (check_limits, check_flow, check_abilities, check_real_robots):
        problems += yield from known.in_chains(look, project, language, running)
    made = yield from known.in_chains(look_at, project, language, running)
    sharing = sharing_of(made, {one.id: python_name(one.name, "") for one in project.variables})
    if sharing.shared:
        for chain in running:
            stack = project.stack_of(chain[0]).id
            of = project.revisions.get(stack, 0), sharing
            torn = partial(check_shared, project, language, sharing, chain)
            problems += yield from known.find((check_shared, stack), of, torn)
    # the other pages follow from which robots and gestures are named, and where first
    nodes, uses = node_entries(project, language), dict[tuple[str, str], tuple[str, str]]()
    for use in (yield from known.in_chains(find_uses, project, language, running)):
        uses.setdefault((use.kind, use.name), (use.block, project.page_of(use.block)))
    problems += check_talk(project, language, running, uses)
    pages = partial(check_deployment, project, language, nodes, uses)
    problems += yield from known.find(check_deployment, (nodes, uses), pages)
    return [one for severity in SEVERITIES for one in problems if one.severity == severity]


__all__ = ["Diagnostic", "Fix", "KnownChains", "check", "check_steps"]
