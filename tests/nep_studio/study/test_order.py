"""The order of conditions: each as often at each place, and as often after each other one."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import pytest

from nep_studio.study.records import conditions_for, latin_square, next_code, participant_number


@pytest.mark.parametrize("count", range(1, 9))
def test_each_condition_is_as_often_at_each_place(count: int) -> None:
    square = latin_square(count)

    for column in zip(*square, strict=True):
        assert set(Counter(column).values()) == {len(square) // count}


@pytest.mark.parametrize("count", range(2, 9))
def test_each_condition_follows_each_other_one_as_often(count: int) -> None:
    pairs = Counter(pair for row in latin_square(count) for pair in pairwise(row))

    assert len(pairs) == count * (count - 1)
    assert len(set(pairs.values())) == 1


def test_participants_take_the_rows_in_turn() -> None:
    orders = [conditions_for(number, ("blocks", "text")) for number in (1, 2, 3)]

    assert orders == [["blocks", "text"], ["text", "blocks"], ["blocks", "text"]]
    assert conditions_for(1, ()) == []


@pytest.mark.parametrize(
    ("code", "number"), [("P07", 7), ("12", 12), ("A3b", 3), ("x", None), ("", None), ("P0", None)]
)
def test_the_number_of_a_participant_is_in_the_code(code: str, number: int | None) -> None:
    assert participant_number(code) == number


def test_the_next_participant_gets_the_next_code() -> None:
    assert next_code([]) == "P01"
    assert next_code(["P01", "P09", "pilot"]) == "P10"
