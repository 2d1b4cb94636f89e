"""Everything that can be told about a program before it runs, in plain words."""

from __future__ import annotations

from collections.abc import Callable

from ..language import Language
from ..program import Project
from ..slices import Steps, at_once
from .blocks import check_blocks, check_inside, check_own_blocks
from .deployment import check_abilities, check_deployment, check_real_robots, check_rules
from .flow import check_flow, check_limits
from .problem import Fix, Found, Problem

_CHECKS: tuple[Callable[[Project, Language], Found], ...] = (
    check_rules,
    check_blocks,
    check_inside,
    check_own_blocks,
    check_limits,
    check_flow,
    check_deployment,
    check_abilities,
    check_real_robots,
)


def check(project: Project, language: Language) -> list[Problem]:
    """The problems of a program, errors first."""
    return at_once(check_steps(project, language))


def check_steps(project: Project, language: Language) -> Steps[list[Problem]]:
    """The same in steps: a large program takes longer than a frame of the screen."""
    language, problems = language.of(project), list[Problem]()
    for find in _CHECKS:
        for problem in find(project, language):
            if problem is None:
                yield
            else:
                problems.append(problem)
    order = {"error": 0, "warning": 1, "info": 2}
    return sorted(problems, key=lambda problem: order[problem.severity])


__all__ = ["Fix", "Problem", "check", "check_steps"]
