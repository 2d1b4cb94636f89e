"""In which order a person meets the conditions of a study: a balanced Latin square.

Source: E. J. Williams, "Experimental designs balanced for the estimation of residual effects of
treatments", Australian Journal of Scientific Research A 2 (1949) 149-168. Each condition is as
often at each place, and follows each other one as often. An odd number of conditions needs two
squares, of which the second is the mirror of the first.
"""

from __future__ import annotations

import re
from collections.abc import Sequence


def latin_square(count: int) -> list[list[int]]:
    """The rows of the square for so many conditions, which are numbered from 0."""
    first = [0]
    for step in range(1, count):
        first.append((first[-1] + (step if step % 2 else -step)) % count)
    square = [[(number + row) % count for number in first] for row in range(count)]
    return square + [row[::-1] for row in square] if count % 2 and count > 1 else square


def conditions_for(participant: int, conditions: Sequence[str]) -> list[str]:
    """The conditions in the order for a participant, who are numbered from 1."""
    if not conditions:
        return []
    square = latin_square(len(conditions))
    return [conditions[number] for number in square[(participant - 1) % len(square)]]


def participant_number(code: str) -> int | None:
    """The number in a participant's code, as 7 in P07; None where there is none."""
    found = re.search(r"(\d{1,9})\D*$", code)
    number = int(found.group(1)) if found else 0
    return number or None


def next_code(codes: Sequence[str]) -> str:
    """A code for the next participant, P01 for the first."""
    last = max((participant_number(code) or 0 for code in codes), default=0)
    return f"P{last + 1:02d}"
