"""The System Usability Scale: the paper's score from the paper's table, and Brooke's."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.study.records import (
    BROOKE,
    PAPER,
    Reply,
    brooke_questionnaire,
    paper_questionnaire,
    questionnaire,
    score_of_means,
    summarize,
    sus_score,
)

PAPER_MEANS = (5.6, 2.1, 6.5, 4.0, 4.8, 2.1, 6.3, 2.0, 5.5, 1.5)
PAPER_DEVIATIONS = (0.47, 0.89, 0.5, 1.52, 1.06, 1.06, 0.74, 0.81, 0.76, 0.5)
PAPER_SCORE = 78.6
ROUNDING = 0.05
"""A mean that is told to one decimal may be wrong by so much."""


def test_the_means_of_the_paper_give_its_score_within_their_rounding() -> None:
    score = score_of_means(PAPER_MEANS, options=7)

    greatest_error = 10 * ROUNDING * 100 / 60
    assert score == pytest.approx(78.33, abs=0.01)
    assert abs(score - PAPER_SCORE) < greatest_error


def test_no_other_number_of_options_gives_the_score_of_the_paper() -> None:
    scores = [score_of_means(PAPER_MEANS, options) for options in (5, 6, 8, 9)]

    assert all(abs(score - PAPER_SCORE) > 1 for score in scores)


def test_the_items_are_those_of_the_paper() -> None:
    paper = Path(__file__).resolve().parents[4] / "shared" / "paper.tex"
    if not paper.is_file():
        pytest.skip("the paper (../shared/paper.tex) is not here")
    table = paper.read_text(encoding="utf-8", errors="replace").split("\\label{tb:sus}")[1]
    rows = re.findall(r"^([A-Z][^&\n]*?)\s*&\s*([\d.]+)\s*&\s*([\d.]+)", table, re.MULTILINE)

    words, means, deviations = zip(*rows, strict=True)

    assert words == paper_questionnaire().items
    assert tuple(map(float, means)) == PAPER_MEANS
    assert tuple(map(float, deviations)) == PAPER_DEVIATIONS


def test_brookes_example_has_his_score() -> None:
    """A sum of 22, which is a score of 55."""
    answers = (5, 4, 2, 1, 2, 3, 2, 4, 5, 2)

    assert sus_score(answers, options=5) == 22 * 2.5


@pytest.mark.parametrize("options", [5, 7])
def test_the_best_and_the_worst_answers_are_100_and_0(options: int) -> None:
    best, worst = [options, 1] * 5, [1, options] * 5

    assert sus_score(best, options) == 100
    assert sus_score(worst, options) == 0
    assert sus_score([(options + 1) // 2] * 10, options) == 50


def test_an_open_item_counts_as_the_option_in_the_middle() -> None:
    answers = [7, 1, None, 1, 7, None, 7, 1, 7, 1]

    assert sus_score(answers, 7) == sus_score([7, 1, 4, 1, 7, 4, 7, 1, 7, 1], 7)


@pytest.mark.parametrize("answers", [[None] * 10, [3] * 9, [3] * 11, [8] + [3] * 9, [0] + [3] * 9])
def test_what_is_no_set_of_answers_has_no_score(answers: list[int | None]) -> None:
    with pytest.raises(ValueError, match="answer"):
        sus_score(answers, 7)


people = st.lists(st.lists(st.integers(1, 7), min_size=10, max_size=10), min_size=1, max_size=12)


@given(people)
def test_the_score_of_the_means_is_the_mean_of_the_scores(people: list[list[int]]) -> None:
    summary = summarize([Reply("P", "", list(one)) for one in people], paper_questionnaire())

    means = [item.mean for item in summary.items]

    assert score_of_means(means, 7) == pytest.approx(summary.overall.mean)
    assert 0 <= summary.overall.mean <= 100


def test_deviations_are_counted_as_in_the_paper() -> None:
    """Six people who answer 5, 5, 6, 6, 6, 6 have the 5.6 (cut off) and the 0.47 of its table."""
    people = [Reply(f"P{n}", "", [answer] * 10) for n, answer in enumerate((5, 5, 6, 6, 6, 6))]

    first = summarize(people, paper_questionnaire()).items[0]

    assert (int(first.mean * 10) / 10, int(first.deviation * 100) / 100) == (5.6, 0.47)


def test_a_summary_keeps_questionnaires_and_conditions_apart() -> None:
    best, worst = [7, 1] * 5, [1, 7] * 5
    replies = [
        Reply("P1", "a", list(best)),
        Reply("P1", "b", list(worst)),
        Reply("P2", "a", [*best[:9], None]),
        Reply("P2", "a", [5, 1] * 5, BROOKE),
    ]

    summary = summarize(replies, questionnaire(PAPER))

    assert [round(one.score) for one in summary.replies] == [100, 0, 95]
    assert {name: one.count for name, one in summary.by_condition.items()} == {"a": 2, "b": 1}
    assert summary.items[9].count == 2
    assert summarize(replies, questionnaire(BROOKE)).overall.mean == 100
    assert summarize([], brooke_questionnaire()).overall.count == 0
