"""What the answers of several people say together: means, deviations, and scores.

A deviation is that of the people who were asked, divided by their number, as in the paper's table.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import fmean, pstdev

from nep_studio.study.records import Reply
from nep_studio.study.sus import Questionnaire


@dataclass(frozen=True)
class Spread:
    """A mean, the deviation from it, and of how many; ``count`` 0 means that nobody answered."""

    mean: float = 0.0
    deviation: float = 0.0
    count: int = 0


@dataclass(frozen=True)
class Summary:
    """Everything about one questionnaire: each item, each person, and all of them."""

    questionnaire: Questionnaire
    items: tuple[Spread, ...]
    replies: tuple[Reply, ...]
    overall: Spread
    by_condition: dict[str, Spread]


def summarize(replies: Sequence[Reply], form: Questionnaire) -> Summary:
    """Sum up the answers to this questionnaire; items that were left open do not count."""
    ours = tuple(reply for reply in replies if reply.questionnaire == form.id)
    items = tuple(
        spread([answer for reply in ours if (answer := reply.answers[number]) is not None])
        for number in range(len(form.items))
    )
    conditions = dict.fromkeys(reply.condition for reply in ours)
    by_condition = {
        condition: spread([reply.score for reply in ours if reply.condition == condition])
        for condition in conditions
    }
    return Summary(form, items, ours, spread([reply.score for reply in ours]), by_condition)


def spread(values: Sequence[float]) -> Spread:
    """Mean and deviation of values; of none, none."""
    return Spread(fmean(values), pstdev(values), len(values)) if values else Spread()
