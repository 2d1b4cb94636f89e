"""Everything that can be told about a program before it runs, in plain words."""

from __future__ import annotations

from ..language import Language
from ..program import Project
from .blocks import check_blocks, check_inside, check_own_blocks
from .deployment import check_abilities, check_deployment, check_real_robots, check_rules
from .flow import check_flow, check_limits
from .problem import Fix, Problem

_CHECKS = (
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
    language = language.of(project)
    problems = [problem for find in _CHECKS for problem in find(project, language)]
    order = {"error": 0, "warning": 1, "info": 2}
    return sorted(problems, key=lambda problem: order[problem.severity])


__all__ = ["Fix", "Problem", "check"]
