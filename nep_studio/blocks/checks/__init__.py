"""Everything that can be told about a program before it runs, in plain words."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from ..deployment import chains, robot_entries
from ..language import Language
from ..program import Project
from ..slices import Steps, at_once
from .blocks import check_blocks, check_inside, check_own_blocks
from .deployment import check_abilities, check_deployment, check_real_robots, check_rules
from .diagnostic import Diagnostic, Fix, Found
from .flow import check_flow, check_limits

_OfChain = Callable[[Project, Language, list[str]], Found]
"""A check of the blocks of one chain, which looks at no other."""


class KnownChains:
    """What was found in each chain, as long as neither it nor what is around it changes."""

    def __init__(self) -> None:
        self._around: object = None
        self._found: dict[tuple[_OfChain, str], tuple[int, list[Diagnostic]]] = {}

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

    def find(
        self, check: _OfChain, project: Project, language: Language, found_in: Iterable[list[str]]
    ) -> Found:
        """The problems that a check finds in chains that begin a stack."""
        for chain in found_in:
            yield None
            stack = project.stack_of(chain[0]).id
            key, revision = (check, stack), project.revisions.get(stack, 0)
            known = self._found.get(key)
            if known is None or known[0] != revision:
                problems = list[Diagnostic]()
                for problem in check(project, language, chain):
                    yield None
                    if problem is not None:
                        problems.append(problem)
                known = self._found[key] = revision, problems
            yield from known[1]


def check(project: Project, language: Language) -> list[Diagnostic]:
    """The problems of a program, errors first."""
    return at_once(check_steps(project, language))


def check_steps(
    project: Project, language: Language, known: KnownChains | None = None
) -> Steps[list[Diagnostic]]:
    """The same in steps: a large program takes longer than a frame of the screen.

    ``known`` has what was found the last time.
    """
    language, problems = language.of(project), list[Diagnostic]()
    known = known or KnownChains()
    known.begin(project, language)
    for found in _finds(project, language, known):
        for problem in found:
            if problem is None:
                yield
            else:
                problems.append(problem)
    order = {"error": 0, "warning": 1, "info": 2}
    return sorted(problems, key=lambda problem: order[problem.severity])


def _finds(project: Project, language: Language, known: KnownChains) -> Iterable[Found]:
    """What each check finds."""
    every = [stack.body for stacks in project.pages.values() for stack in stacks]
    running = list(chains(project, language))
    yield check_rules(project, language)
    yield known.find(check_blocks, project, language, every)
    yield known.find(check_inside, project, language, running)
    yield check_own_blocks(project, language)
    yield known.find(check_limits, project, language, running)
    yield known.find(check_flow, project, language, running)
    yield check_deployment(project, language)
    yield known.find(check_abilities, project, language, running)
    yield known.find(check_real_robots, project, language, running)


__all__ = ["Diagnostic", "Fix", "KnownChains", "check", "check_steps"]
