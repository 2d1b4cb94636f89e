"""The search for a plan among steps that are filled in: the shortest by A*, else any by h_add.

A situation is a whole number with a bit for each fact that may change. The estimate of A* counts
the landmarks of LM-cut (Helmert and Domshlak 2009) that a path has not passed yet: sets of steps of
which each plan has one, no step in two of them, so that it is never too high (Karpas and Domshlak
2009). They are found once, at the start, for a look at each situation would take longer in Python
than to look at more situations. The estimate h_add is of Bonet and Geffner (2001), and the helpful
steps, which are tried first, of Hoffmann and Nebel (2001).
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from nep_core.errors import PlanError

from .facts import Fact

MOST_STATES = 150_000
"""So many situations are kept, about 100 MB."""
BEST_S = 4.0
"""For so long the shortest plan is looked for, and then any."""
ANY_S = 20.0
LOOK_EVERY = 64
"""Situations between two looks at the clock, and at whether the program is to end."""
NEVER = 1 << 60

Look = Callable[[], float]


class Act(NamedTuple):
    """A step as bits: what it needs, what stays of a situation, what is added; and its number."""

    needs: int
    keeps: int
    adds: int
    number: int


class Problem:
    """The steps, the present facts and the goal, by the facts that may change."""

    def __init__(
        self,
        steps: Sequence[tuple[Iterable[Fact], dict[Fact, bool]]],
        present: frozenset[Fact],
        goal: Iterable[Fact],
    ) -> None:
        changing = dict.fromkeys(
            fact
            for _, changes in steps
            for fact, is_made in changes.items()
            if is_made is not (fact in present)
        )
        self._bits = {fact: 1 << place for place, fact in enumerate(changing)}
        self.start, self.goal = self._mask(present), self._mask(goal)
        self.acts = [self._act(number, *step) for number, step in enumerate(steps)]
        self._buckets = _buckets(self.acts)

    def _mask(self, facts: Iterable[Fact]) -> int:
        return sum(self._bits.get(fact, 0) for fact in set(facts))

    def _act(self, number: int, needs: Iterable[Fact], changes: dict[Fact, bool]) -> Act:
        removed = self._mask(fact for fact, is_made in changes.items() if not is_made)
        added = self._mask(fact for fact, is_made in changes.items() if is_made)
        return Act(self._mask(needs), ~removed, added, number)

    def possible(self, state: int) -> Iterator[Act]:
        """The steps that can be taken in a situation."""
        for key, acts in self._buckets:
            if state & key == key:
                for act in acts:
                    if state & act.needs == act.needs:
                        yield act


def _buckets(acts: Sequence[Act]) -> list[tuple[int, list[Act]]]:
    """Steps by the fact that most of them need: where it is untrue none of them is looked at."""
    counts: dict[int, int] = {}
    for act in acts:
        for bit in bits_of(act.needs):
            counts[bit] = counts.get(bit, 0) + 1
    found: dict[int, list[Act]] = {}
    for act in acts:
        key = max(bits_of(act.needs), key=lambda bit: counts[bit], default=0)
        found.setdefault(key, []).append(act)
    return list(found.items())


def bits_of(mask: int) -> Iterator[int]:
    """The single bits of a mask."""
    while mask:
        bit = mask & -mask
        yield bit
        mask ^= bit


def search(problem: Problem, look: Look) -> list[int]:
    """The numbers of the steps that lead to the goal; raises PlanError when none do."""
    found, is_all = shortest(problem, look)
    if found is None and not is_all:
        found, is_all = any_plan(problem, look)
    if found is not None:
        return found
    if is_all:
        raise PlanError(
            "No order of the tasks leads there: what one makes true another makes untrue.",
            checklist=("Look at what the tasks make untrue.", "Ask for fewer facts at once."),
        )
    raise PlanError(
        "No plan was found in time: there are too many ways to do the tasks.",
        checklist=("Use fewer values in facts.", "Reach something on the way first."),
    )


Found = tuple[list[int] | None, bool]
"""A plan, or None; and whether everything was looked through."""
_Trail = dict[int, tuple[int, int]]
"""For each situation the one before it, and the step from there."""


def shortest(problem: Problem, look: Look, limit_s: float = BEST_S) -> Found:
    """The shortest plan, by A*; None without having looked at all when it takes too long."""
    begun_s = look()
    left = landmarks(problem, look)
    of_step = _landmark_of_step(left)
    start, goal = problem.start, problem.goal
    lengths, trail = {start: 0}, _Trail()
    first = (1 << len(left)) - 1
    waiting: list[tuple[int, int, int, int]] = [(len(left), 0, start, first)]
    looked = 0
    while waiting:
        _, back, state, ahead = heapq.heappop(waiting)
        length = -back
        if length > lengths[state]:
            continue  # a shorter way to it has been found since
        if state & goal == goal:
            return _way(trail, start, state), True
        looked += 1
        if looked % LOOK_EVERY == 0 and (look() - begun_s > limit_s or len(lengths) > MOST_STATES):
            return None, False
        for _, keeps, adds, number in problem.possible(state):
            then = state & keeps | adds
            known = lengths.get(then)
            if known is not None and known <= length + 1:
                continue
            lengths[then] = length + 1
            trail[then] = state, number
            open_ = ahead & ~of_step.get(number, 0)
            estimate = length + 1 + open_.bit_count()
            # Of those that look as near, the one that has come farthest is tried first
            heapq.heappush(waiting, (estimate, -length - 1, then, open_))
    return None, True


def _way(trail: _Trail, start: int, state: int) -> list[int]:
    steps = []
    while state != start:
        state, number = trail[state]
        steps.append(number)
    return steps[::-1]


def _landmark_of_step(found: Sequence[frozenset[int]]) -> dict[int, int]:
    return {number: 1 << place for place, one in enumerate(found) for number in one}


# What is true when nothing is ever made untrue, and at which cost.


class Relaxed:
    """The steps without what they make untrue; facts are numbered, 0 is always true."""

    def __init__(self, problem: Problem) -> None:
        self._place = {bit: n + 1 for n, bit in enumerate(_all_bits(problem))}
        self.size = len(self._place) + 2
        self.end = self.size - 1
        """The fact that a last step without cost makes of the goal."""
        goal = self.places(problem.goal) or (0,)
        self.needs = [self.places(act.needs) or (0,) for act in problem.acts] + [goal]
        self.makes = [self.places(act.adds) for act in problem.acts] + [(self.end,)]
        self.costs = [1] * len(problem.acts) + [0]
        self.needed_by: list[list[int]] = [[] for _ in range(self.size)]
        self.made_by: list[list[int]] = [[] for _ in range(self.size)]
        for step, places in enumerate(self.needs):
            for place in places:
                self.needed_by[place].append(step)
        for step, places in enumerate(self.makes):
            for place in places:
                self.made_by[place].append(step)

    def places(self, mask: int) -> tuple[int, ...]:
        """The numbers of the facts of a mask."""
        return tuple(self._place[bit] for bit in bits_of(mask) if bit in self._place)

    def explore(
        self, state: int, costs: Sequence[int], *, is_sum: bool
    ) -> tuple[list[int], list[int]]:
        """What each fact costs, and each step the need that decided: h_add as a sum, else h_max."""
        reached = [NEVER] * self.size
        supporters = [-1] * len(self.needs)
        left = [len(places) for places in self.needs]
        so_far = [0] * len(self.needs)
        waiting = [(0, place) for place in (0, *self.places(state))]
        for _, place in waiting:
            reached[place] = 0
        heapq.heapify(waiting)
        while waiting:
            cost, place = heapq.heappop(waiting)
            if cost > reached[place]:
                continue
            for step in self.needed_by[place]:
                left[step] -= 1
                so_far[step] = so_far[step] + cost if is_sum else cost
                if left[step]:
                    continue
                supporters[step] = place  # the last and so the dearest
                then = so_far[step] + costs[step]
                for made in self.makes[step]:
                    if then < reached[made]:
                        reached[made] = then
                        heapq.heappush(waiting, (then, made))
        return reached, supporters


def _all_bits(problem: Problem) -> Iterator[int]:
    mask = problem.start | problem.goal
    for act in problem.acts:
        mask |= act.adds | act.needs
    return bits_of(mask)


def landmarks(problem: Problem, look: Look) -> list[frozenset[int]]:
    """Sets of steps, none in two of them, of each of which every plan has one: LM-cut."""
    relaxed, found = Relaxed(problem), list[frozenset[int]]()
    costs = list(relaxed.costs)
    while True:
        look()
        reached, supporters = relaxed.explore(problem.start, costs, is_sum=False)
        if not 0 < reached[relaxed.end] < NEVER:
            return found
        zone = _goal_zone(relaxed, costs, supporters)
        cut = _cut(relaxed, problem.start, zone, supporters)
        found.append(frozenset(cut))
        for step in cut:
            costs[step] = 0  # each costs 1, so that it is spent


def _goal_zone(relaxed: Relaxed, costs: Sequence[int], supporters: Sequence[int]) -> set[int]:
    """The facts from which the goal follows at no cost, by what decided about each step."""
    zone, waiting = {relaxed.end}, [relaxed.end]
    while waiting:
        for step in relaxed.made_by[waiting.pop()]:
            before = supporters[step]
            if costs[step] == 0 and before >= 0 and before not in zone:
                zone.add(before)
                waiting.append(before)
    return zone


def _cut(relaxed: Relaxed, start: int, zone: set[int], supporters: Sequence[int]) -> set[int]:
    """The steps that lead into the zone of the goal from what is reached without entering it."""
    begun = [0, *relaxed.places(start)]
    seen, waiting, cut = set(begun), begun, set[int]()
    while waiting:
        place = waiting.pop()
        for step in relaxed.needed_by[place]:
            if supporters[step] != place:
                continue
            for made in relaxed.makes[step]:
                if made in zone:
                    cut.add(step)
                elif made not in seen:
                    seen.add(made)
                    waiting.append(made)
    return cut


def any_plan(problem: Problem, look: Look, limit_s: float = ANY_S) -> Found:
    """Some plan: the nearest by h_add first, and steps that help before the others."""
    begun_s, relaxed = look(), Relaxed(problem)
    start, goal, trail = problem.start, problem.goal, _Trail()
    waiting: list[tuple[int, int, int]] = [(0, 0, start)]
    seen, pushed = {start}, 0
    while waiting:
        _, _, state = heapq.heappop(waiting)
        if state & goal == goal:
            return _way(trail, start, state), True
        if look() - begun_s > limit_s or len(seen) > MOST_STATES:
            return None, False
        far, helpful = _estimate(relaxed, state)
        if far >= NEVER:
            continue  # not even when nothing is made untrue
        for _, keeps, adds, number in problem.possible(state):
            then = state & keeps | adds
            if then in seen:
                continue
            seen.add(then)
            trail[then] = state, number
            pushed += 1
            # Each child waits with the estimate of its parent; half a step nearer if it helps
            heapq.heappush(waiting, (2 * far - (number in helpful), pushed, then))
    return None, True


def _estimate(relaxed: Relaxed, state: int) -> tuple[int, set[int]]:
    """The sum of what the goal costs, and the steps of a relaxed plan that can be taken now."""
    reached, _ = relaxed.explore(state, relaxed.costs, is_sum=True)
    far = reached[relaxed.end]
    if far >= NEVER:
        return far, set()
    helpful, seen, waiting = set[int](), {relaxed.end}, [relaxed.end]
    while waiting:
        place = waiting.pop()
        if reached[place] == 0 and place != relaxed.end:
            continue
        step = min(
            relaxed.made_by[place], key=lambda one: sum(reached[n] for n in relaxed.needs[one])
        )
        if all(reached[need] == 0 for need in relaxed.needs[step]):
            helpful.add(step)
        for need in relaxed.needs[step]:
            if need not in seen:
                seen.add(need)
                waiting.append(need)
    return far, helpful
