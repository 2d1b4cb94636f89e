"""The planner beside pyperplan, a planner of a university: the same lengths, and none where none.

It is a judge from outside, never part of the program; where it is not installed nothing is told.
"""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from benchmarks._planning_domains import CLASSICS, Domain, random_domain
from nep_core.errors import PlanError
from nep_core.program.facts import Fact
from nep_core.program.planner import find_plan, ground

pyperplan = pytest.importorskip("pyperplan.planner", reason="pyperplan is not installed")
RANDOM = 60


def words(fact: Fact) -> str:
    return "(" + "-".join(map(str, fact)).lower() + ")"


def all_of(facts: list[str]) -> str:
    return f"(and {' '.join(facts)})" if facts else "(and)"


def their_length(domain: Domain, folder: Path) -> int | None:
    """The length of the plan that the other finds, by blind A*; steps are given filled in."""
    grounded = ground(domain.present, domain.goal, domain.tasks, frozenset(), time.monotonic)
    wanted = {words(fact) for fact in domain.goal}
    present = {words(fact) for fact in domain.present}
    actions, named = [], wanted | present
    for number, step in enumerate(grounded.steps):
        needs = [words(fact) for fact in step.needs()]
        effects = [
            words(fact) if made else f"(not {words(fact)})" for fact, made in step.changes().items()
        ]
        named |= {*needs, *(words(fact) for fact in step.changes())}
        actions.append(
            f"(:action s{number} :parameters () :precondition {all_of(needs)} "
            f":effect {all_of(effects)})"
        )
    first, second = folder / "domain.pddl", folder / "problem.pddl"
    first.write_text(
        f"(define (domain d) (:requirements :strips) (:predicates {' '.join(sorted(named))}) "
        f"{' '.join(actions)})"
    )
    second.write_text(
        f"(define (problem p) (:domain d) (:objects) (:init {' '.join(sorted(present))}) "
        f"(:goal {all_of(sorted(wanted))}))"
    )
    search, estimate = pyperplan.SEARCHES["astar"], pyperplan.HEURISTICS["blind"]
    plan = pyperplan.search_plan(str(first), str(second), search, estimate)
    return None if plan is None else len(plan)


def our_length(domain: Domain) -> int | None:
    try:
        return len(find_plan(domain.present, domain.goal, domain.tasks, look=time.monotonic))
    except PlanError:
        return None


@pytest.mark.parametrize("name", [name for name in CLASSICS if name != "guide"])
def test_another_planner_finds_plans_of_the_same_length(name: str, tmp_path: Path) -> None:
    domain = CLASSICS[name]()

    assert our_length(domain) == their_length(domain, tmp_path)


@pytest.mark.parametrize("seed", range(1000, 1000 + RANDOM))
def test_another_planner_agrees_about_random_problems(seed: int, tmp_path: Path) -> None:
    domain = random_domain(seed)
    unreached = set(domain.goal) - set(
        ground(domain.present, domain.goal, domain.tasks, frozenset(), time.monotonic).reached
    )
    if unreached:  # it takes no fact that nothing names: that there is none is seen at once
        assert our_length(domain) is None
        return

    assert our_length(domain) == their_length(domain, tmp_path)
