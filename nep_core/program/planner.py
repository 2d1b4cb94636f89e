"""The planner: which tasks, in which order and with which values, make wanted facts true.

Planning of the kind STRIPS (Fikes and Nilsson 1971): a task needs facts, and makes some true and
others no longer true. ``ground`` fills in values as far as facts can become true at all when
nothing is ever made untrue (the delete relaxation); ``plan_search`` finds steps to the goal, and
``why_not`` says what is missing where nothing leads there.
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from nep_core.errors import PlanError

from .facts import Fact, Value, told_fact
from .plan_search import Look, Problem, search

MOST_ACTIONS = 20_000
"""More ways to do the tasks than these are not looked through: too many values fit anywhere."""


class Parameter(NamedTuple):
    """A value of a task, by its number from 0."""

    number: int


Term = Value | Parameter
Pattern = tuple[Term, ...]
"""A fact in which values of a task stand."""
Binding = tuple[Value | None, ...]


@dataclass(frozen=True, slots=True)
class Task:
    """What a program can do: what it needs, and what it then changes, in this order."""

    name: str
    parameters: tuple[str, ...] = ()
    needs: tuple[Pattern, ...] = ()
    changes: tuple[tuple[Pattern, bool], ...] = ()
    """Facts with whether they are made true, or no longer true."""

    def makes(self) -> Iterator[Pattern]:
        """The facts that it makes true."""
        return (pattern for pattern, is_made in self.changes if is_made)


@dataclass(frozen=True, slots=True)
class Step:
    """A task with its values."""

    task: Task
    values: tuple[Value, ...] = ()

    def needs(self) -> list[Fact]:
        """The facts that it needs."""
        return [_filled(pattern, self.values) for pattern in self.task.needs]

    def changes(self) -> dict[Fact, bool]:
        """What it changes in the end: a later change of a fact outdoes an earlier one."""
        return {_filled(pattern, self.values): made for pattern, made in self.task.changes}


def _filled(pattern: Pattern, values: Binding) -> Fact:
    terms = [values[term.number] if isinstance(term, Parameter) else term for term in pattern]
    return tuple(term for term in terms if term is not None)


def find_plan(
    present: Iterable[Fact],
    goal: Sequence[Fact],
    tasks: Sequence[Task],
    *,
    avoided: frozenset[Step] = frozenset(),
    look: Look,
) -> list[Step]:
    """The steps from the present facts to the wanted ones; the fewest where that is found in time.

    ``avoided`` steps are not taken. ``look`` is called now and then: it gives the seconds of the
    program, and may raise to end the search. Raises PlanError, which says what is missing.
    """
    present = frozenset(present)
    grounded = ground(present, goal, tasks, avoided, look)
    missing = [fact for fact in goal if fact not in grounded.reached]
    if missing:
        raise why_not(missing[0], tasks, grounded.reached)
    steps = list(grounded.steps)
    problem = Problem([(step.needs(), step.changes()) for step in steps], present, goal)
    return [steps[number] for number in search(problem, look)]


# Grounding: the steps that are possible when nothing is ever made untrue.


@dataclass(slots=True)
class Grounded:
    """The facts that can become true, and the steps that can be taken, without untrue ones."""

    reached: dict[Fact, None] = field(default_factory=dict)
    steps: dict[Step, None] = field(default_factory=dict)
    index: defaultdict[tuple[int, int, Value], dict[Fact, None]] = field(
        default_factory=lambda: defaultdict(dict)
    )
    """Facts by their length and a value at a place: 0 is that of the name."""

    def add(self, fact: Fact) -> bool:
        """Note that a fact can become true; whether that is new."""
        if fact in self.reached:
            return False
        self.reached[fact] = None
        for place, value in enumerate(fact):
            self.index[len(fact), place, value][fact] = None
        return True

    def candidates(self, pattern: Pattern, values: Binding) -> Mapping[Fact, None]:
        """Facts among which are all that fit a pattern: the fewest that one value tells."""
        found: list[Mapping[Fact, None]] = []
        for place, term in enumerate(pattern):
            value = values[term.number] if isinstance(term, Parameter) else term
            if value is not None:
                found.append(self.index.get((len(pattern), place, value), {}))
        return min(found, key=len)

    def joined(self, needs: Sequence[Pattern], values: Binding) -> Iterator[Binding]:
        """The values with which all these facts can become true, the rarest fact first."""
        if not needs:
            yield values
            return
        few, first = min(
            ((self.candidates(need, values), need) for need in needs), key=lambda one: len(one[0])
        )
        rest = [need for need in needs if need is not first]
        for fact in list(few):
            if (bound := fitted(first, fact, values)) is not None:
                yield from self.joined(rest, bound)


def fitted(pattern: Pattern, fact: Fact, values: Binding) -> Binding | None:
    """The values with which a pattern is a fact, or None."""
    if len(pattern) != len(fact):
        return None
    bound = list(values)
    for term, value in zip(pattern, fact, strict=True):
        if isinstance(term, Parameter):
            known = bound[term.number]
            if known is None:
                bound[term.number] = value
            elif known != value:
                return None
        elif term != value:
            return None
    return tuple(bound)


def ground(
    present: frozenset[Fact],
    goal: Sequence[Fact],
    tasks: Sequence[Task],
    avoided: frozenset[Step],
    look: Look,
) -> Grounded:
    """All steps that can ever be taken, by how facts become true one from the other."""
    found, waiting = Grounded(), sorted(present, key=repr)
    values = _values_in(waiting, goal, tasks)
    needed: defaultdict[tuple[Value, int], list[tuple[Task, Pattern]]] = defaultdict(list)
    for task in tasks:
        for need in task.needs:
            if not isinstance(need[0], Parameter):
                needed[need[0], len(need)].append((task, need))
    for task in tasks:
        if not task.needs:
            _take(task, found, (None,) * len(task.parameters), values, avoided, waiting)
    while waiting:
        fact = waiting.pop()
        look()
        if not found.add(fact):
            continue
        for task, need in needed[fact[0], len(fact)]:
            bound = fitted(need, fact, (None,) * len(task.parameters))
            if bound is not None:
                rest = [other for other in task.needs if other is not need]
                for full in found.joined(rest, bound):
                    _take(task, found, full, values, avoided, waiting)
    return found


def _take(
    task: Task,
    found: Grounded,
    bound: Binding,
    values: Sequence[Value],
    avoided: frozenset[Step],
    waiting: list[Fact],
) -> None:
    """Note the steps of a task with these values; what needs do not bind can be any value."""
    choices = [values if one is None else (one,) for one in bound]
    for full in itertools.product(*choices):
        step = Step(task, full)
        if step in found.steps or step in avoided:
            continue
        if len(found.steps) >= MOST_ACTIONS:
            raise PlanError(
                "There are more than {most} ways to do “{task}” and the other tasks.",
                checklist=(
                    "Say with “needs” which values go together.",
                    "Use fewer values in facts.",
                ),
                most=MOST_ACTIONS,
                task=task.name,
            )
        found.steps[step] = None
        waiting += [fact for fact, made in step.changes().items() if made]


def _values_in(
    facts: Iterable[Fact], goal: Iterable[Fact], tasks: Iterable[Task]
) -> tuple[Value, ...]:
    """All values that occur in facts, and in those that tasks need or make."""
    seen: dict[Value, None] = {}
    patterns = (one for task in tasks for one in (*task.needs, *(p for p, _ in task.changes)))
    for fact in itertools.chain(facts, goal, patterns):
        seen.update((term, None) for term in fact[1:] if not isinstance(term, Parameter))
    return tuple(seen)


# Why there is no plan: the first fact on the way that nothing makes true.


def why_not(fact: Fact, tasks: Sequence[Task], reached: Mapping[Fact, None]) -> PlanError:
    """What is missing for a fact that cannot become true."""
    by = _missing(fact, tasks, reached)
    if by is None:
        return PlanError(
            "Nothing makes “{fact}” true.",
            checklist=(
                "Say that it is now true, if it is.",
                "Make an own block in which it becomes true.",
            ),
            fact=_shown(fact),
        )
    task, need = by
    seen: set[Pattern] = {fact}
    while need not in seen:  # what it needs may need something in its turn
        seen.add(need)
        deeper = _missing(need, tasks, reached)
        if deeper is None:
            break
        task, need = deeper
    return PlanError(
        "“{fact}” cannot become true: “{task}” needs “{need}”, which nothing makes true.",
        checklist=(
            "Say that it is now true, if it is.",
            "Make an own block in which it becomes true.",
        ),
        fact=_shown(fact),
        task=task.name,
        need=_shown(need),
    )


def _missing(
    pattern: Pattern, tasks: Sequence[Task], reached: Mapping[Fact, None]
) -> tuple[Task, Pattern] | None:
    """A task that would make a fact true, and the first that it needs and does not have."""
    found = Grounded()
    for fact in reached:
        found.add(fact)
    nearest: tuple[int, Task, Pattern] | None = None
    for task in tasks:
        for made in task.makes():
            bound = _unified(made, pattern, len(task.parameters))
            if bound is None:
                continue
            met, need = _furthest(task, bound, found)
            if need is not None and (nearest is None or met > nearest[0]):
                nearest = met, task, need
    return None if nearest is None else nearest[1:]


def _unified(made: Pattern, wanted: Pattern, count: int) -> Binding | None:
    """The values with which a task makes what is wanted, in which some may be open."""
    if len(made) != len(wanted):
        return None
    bound: list[Value | None] = [None] * count
    for term, value in zip(made, wanted, strict=True):
        if isinstance(value, Parameter):
            continue
        if not isinstance(term, Parameter):
            if term != value:
                return None
        elif bound[term.number] not in (None, value):
            return None
        else:
            bound[term.number] = value
    return tuple(bound)


def _furthest(task: Task, bound: Binding, found: Grounded) -> tuple[int, Pattern | None]:
    """How many of the needs of a task can be met one after the other, and the first that cannot."""
    for count, need in enumerate(task.needs):
        if next(found.joined(task.needs[: count + 1], bound), None) is None:
            # What stands before it tells its values, where they can be no others
            before = list(itertools.islice(found.joined(task.needs[:count], bound), 2))
            return count, _partly(need, before[0] if len(before) == 1 else bound)
    return len(task.needs), None


def _partly(pattern: Pattern, values: Binding) -> Pattern:
    """A pattern with the values that are known."""
    filled: list[Term] = []
    for term in pattern:
        value = values[term.number] if isinstance(term, Parameter) else term
        filled.append(term if value is None else value)
    return tuple(filled)


def _shown(pattern: Pattern) -> str:
    """A fact in words, with … for values that are open."""
    return told_fact(tuple("…" if isinstance(term, Parameter) else term for term in pattern))
