"""Parts of a program that run side by side: they wait for each other, fail and are cancelled."""

from __future__ import annotations

import time

import pytest

from nep_core.program.tasks import Task, together, wait


def test_together_waits_for_the_slowest() -> None:
    done: list[str] = []

    together(lambda: (wait(0.05), done.append("slow")), lambda: done.append("fast"))

    assert done == ["fast", "slow"]


def test_an_error_in_one_part_ends_the_others() -> None:
    def fail() -> None:
        raise ValueError("one part fails")

    started_s = time.monotonic()
    with pytest.raises(ValueError, match="one part fails"):
        together(lambda: wait(60), fail)
    assert time.monotonic() - started_s < 10


def test_together_of_nothing_is_done_at_once() -> None:
    together()


def test_cancelling_reaches_the_parts_of_parts() -> None:
    child = Task(Task(root := Task()))

    root.cancel()

    assert child.cancelled.is_set()
    assert Task(root).cancelled.is_set()
