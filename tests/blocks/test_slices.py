"""Long work in slices: it rests when its slice is over, and can be given up."""

from __future__ import annotations

import time

import pytest

from nep_studio.blocks.slices import Sliced, Steps, at_once


def counting(most: int) -> Steps[int]:
    """Counts, and rests at each number, which takes a millisecond at least."""
    for _ in range(most):
        time.sleep(0.001)
        yield
    return most


def test_a_long_work_rests_when_its_slice_is_over() -> None:
    work = Sliced(counting(30))

    slices = 0
    while not work.run(0.005):
        slices += 1

    assert slices >= 3
    assert work.result == 30


def test_a_cancelled_work_ends_where_it_rests() -> None:
    ended = []

    def endless() -> Steps[None]:
        try:
            while True:
                yield
        finally:
            ended.append(True)

    work = Sliced(endless())
    work.run(0.001)

    work.cancel()

    assert ended == [True]
    assert not work.is_over


def test_a_work_that_was_never_run_can_be_cancelled() -> None:
    work = Sliced(counting(10))

    work.cancel()

    assert not work.is_over


def test_what_a_work_raises_comes_out_of_its_slice() -> None:
    def refusing() -> Steps[None]:
        yield
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        Sliced(refusing()).run(0.01)


def test_a_work_that_is_done_at_once_gives_its_result() -> None:
    assert at_once(counting(3)) == 3
