"""A judge of plans that shares nothing with the planner: all situations, one ring after another.

Values of tasks are put in for every parameter, and situations are sets of facts.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

from nep_core.program.facts import Fact, Value
from nep_core.program.planner import Parameter, Pattern, Step

from ._planning_domains import Domain


def filled(pattern: Pattern, values: Sequence[Value]) -> Fact:
    """A pattern with values put in."""
    return tuple(values[t.number] if isinstance(t, Parameter) else t for t in pattern)


Steps = list[tuple[frozenset[Fact], list[tuple[Fact, bool]]]]
"""What each needs, and what it then changes, in this order."""


def all_steps(domain: Domain) -> Steps:
    """All ways to do the tasks, with any values that are somewhere."""
    found: Steps = []
    values = {v for fact in (*domain.present, *domain.goal) for v in fact[1:]}
    for task in domain.tasks:
        for pattern in (*task.needs, *(p for p, _ in task.changes)):
            values |= {t for t in pattern[1:] if not isinstance(t, Parameter)}
    static = {f[0] for f in domain.present} - {
        pattern[0] for task in domain.tasks for pattern, _ in task.changes
    }
    for task in domain.tasks:
        for chosen in product(sorted(values, key=repr), repeat=len(task.parameters)):
            needs = frozenset(filled(p, chosen) for p in task.needs)
            if any(n[0] in static and n not in domain.present for n in needs):
                continue
            found.append((needs, [(filled(p, chosen), made) for p, made in task.changes]))
    return found


def shortest_length(domain: Domain) -> int | None:
    """How many steps the shortest plan has, or None."""
    steps, goal = all_steps(domain), set(domain.goal)
    ring, seen, length = {domain.present}, {domain.present}, 0
    while ring:
        if any(goal <= state for state in ring):
            return length
        following = set[frozenset[Fact]]()
        for state in ring:
            for needs, changes in steps:
                if needs <= state:
                    then = set(state)
                    for fact, made in changes:
                        (then.add if made else then.discard)(fact)
                    following.add(frozenset(then))
        ring = following - seen
        seen |= ring
        length += 1
    return None


def follow(domain: Domain, plan: Sequence[Step]) -> frozenset[Fact]:
    """The facts after a plan; asserts that each step may be taken."""
    state = set(domain.present)
    for step in plan:
        assert {filled(p, step.values) for p in step.task.needs} <= state
        for pattern, made in step.task.changes:
            (state.add if made else state.discard)(filled(pattern, step.values))
    return frozenset(state)
