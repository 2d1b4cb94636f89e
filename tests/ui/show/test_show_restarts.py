"""A show that failed is begun again, with pauses, until somebody must look."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from nep_studio.ui.plugins.show.performance import LONGEST_PAUSE_S, PAUSE_S, STEADY_S, Restarts


def fail(restarts: Restarts, began_s: float, after_s: float = 1.0) -> float | None:
    restarts.began(began_s)
    return restarts.failed(began_s + after_s)


def test_pauses_grow_and_then_somebody_must_look() -> None:
    restarts = Restarts(most=3)

    pauses = [fail(restarts, 0.0) for _ in range(4)]

    assert pauses == [PAUSE_S, 2 * PAUSE_S, 4 * PAUSE_S, None]
    assert restarts.total == 3


def test_without_restarts_the_first_error_needs_somebody() -> None:
    assert fail(Restarts(most=0), 0.0) is None


def test_a_show_that_went_on_for_a_while_begins_to_count_anew() -> None:
    restarts = Restarts(most=1)

    assert fail(restarts, 0.0) == PAUSE_S
    assert fail(restarts, 0.0, STEADY_S) == PAUSE_S
    assert fail(restarts, 0.0) is None


def test_a_good_end_is_followed_by_another_beginning_only_where_that_is_wanted() -> None:
    assert Restarts().ended() is None
    assert Restarts(again=True).ended() == PAUSE_S


def test_who_presses_run_forgives() -> None:
    restarts = Restarts(most=1)
    fail(restarts, 0.0)
    fail(restarts, 0.0)

    restarts.pressed()

    assert (restarts.failures, restarts.total) == (0, 0)
    assert fail(restarts, 0.0) == PAUSE_S


@given(st.integers(0, 20), st.lists(st.floats(0, 200), max_size=60))
def test_it_is_never_begun_more_often_in_a_row_than_is_allowed(most: int, lasts: list) -> None:
    restarts, in_a_row = Restarts(most=most), 0

    for lasted_s in lasts:
        pause_s = fail(restarts, 0.0, lasted_s)
        in_a_row = 1 if lasted_s >= STEADY_S else in_a_row + 1
        if pause_s is None:
            assert in_a_row > most
        else:
            assert in_a_row <= most
            assert PAUSE_S <= pause_s <= LONGEST_PAUSE_S
