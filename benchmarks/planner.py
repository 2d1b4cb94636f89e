"""How fast plans are found, beside a plain search that looks at all situations.

Both solve the same small problems that books tell of, one after the other in the same run; the
plans of the planner must be as short. The reference is a judge of the tests, which shares nothing
with the planner.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from typing import Any

from nep_core.program.planner import find_plan

from ._planning_domains import CLASSICS, Domain
from ._planning_judge import shortest_length

LIMIT_S = 180
ROUNDS = 5
GOAL_S = 1.0
"""A plan is waited for by people: each of these is there within a second."""
GOAL_RATIO = 1.0
TOO_LARGE = ("guide",)
"""Problems on which the reference would work for minutes."""


def run() -> list[dict[str, Any]]:
    """The seconds for each problem, with those of the reference where there are any."""
    return [_figure(name, make()) for name, make in CLASSICS.items()]


def _figure(name: str, domain: Domain) -> dict[str, Any]:
    taken_s, length = _timed(lambda: len(_plan(domain)), ROUNDS)
    figure: dict[str, Any] = {
        "name": f"{name}, a plan of {length} steps",
        "value": round(taken_s, 4),
        "unit": "s",
        "goal": f"at most {GOAL_S} s",
        "ok": taken_s <= GOAL_S,
    }
    if name in TOO_LARGE:
        return figure
    reference_s, shortest = _timed(lambda: shortest_length(domain), 1)
    ratio = taken_s / reference_s
    is_fast = ratio <= GOAL_RATIO or reference_s < 0.02  # else it is the grounding that is compared
    return figure | {
        "reference": round(reference_s, 4),
        "ratio": round(ratio, 3),
        "goal": f"at most {GOAL_S} s, {GOAL_RATIO} of a plain search, and as short",
        "ok": taken_s <= GOAL_S and is_fast and length == shortest,
    }


def _plan(domain: Domain) -> list[Any]:
    return find_plan(domain.present, domain.goal, domain.tasks, look=time.monotonic)


def _timed(work: Callable[[], int | None], rounds: int) -> tuple[float, int | None]:
    """The middle of the seconds of some rounds, and what came of the last."""
    taken: list[float] = []
    result: int | None = None
    for _ in range(rounds):
        begun_s = time.perf_counter()
        result = work()
        taken.append(time.perf_counter() - begun_s)
    return statistics.median(taken), result
