"""The monitor: what several threads hear arrives in one, in batches, and never floods it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from nep_studio.run.node_board import LARGEST_BATCH, Monitor


@pytest.fixture
def monitor(qtbot) -> Iterator[Monitor]:
    made = Monitor(most_waiting=100)
    made.start()
    yield made
    made.end()


def test_what_is_heard_arrives_in_its_order(monitor: Monitor, qtbot) -> None:
    came: list[object] = []
    monitor.arrived.connect(lambda batch: (came.extend(batch), monitor.may_send.set()))

    for number in range(50):
        monitor.hear(number)

    qtbot.waitUntil(lambda: len(came) == 50)
    assert came == list(range(50))


def test_a_busy_window_gets_one_batch_until_it_has_taken_it(monitor: Monitor, qtbot) -> None:
    batches: list[list[object]] = []
    monitor.arrived.connect(batches.append)
    monitor.hear("first")
    qtbot.waitUntil(lambda: len(batches) == 1)

    monitor.hear("second")
    monitor.hear("third")
    qtbot.wait(100)  # three of its pauses: nothing else tells that a thread keeps back something
    assert batches == [["first"]]

    monitor.may_send.set()
    qtbot.waitUntil(lambda: batches == [["first"], ["second", "third"]])


def test_the_oldest_of_too_many_are_dropped_and_counted(monitor: Monitor, qtbot) -> None:
    batches: list[list[object]] = []
    monitor.arrived.connect(batches.append)
    monitor.hear("first")
    qtbot.waitUntil(lambda: len(batches) == 1)

    for number in range(250):
        monitor.hear(number)
    monitor.may_send.set()

    qtbot.waitUntil(lambda: len(batches) == 2)
    assert batches[1] == list(range(150, 250))
    assert monitor.dropped == 150


def test_a_large_heap_comes_in_several_batches(qtbot) -> None:
    monitor = Monitor()
    sizes: list[int] = []
    monitor.arrived.connect(lambda batch: (sizes.append(len(batch)), monitor.may_send.set()))
    for number in range(1000):
        monitor.hear(number)

    monitor.start()

    qtbot.waitUntil(lambda: sum(sizes) == 1000)
    monitor.end()
    assert max(sizes) == LARGEST_BATCH


def test_it_ends_while_a_batch_is_not_taken(monitor: Monitor, qtbot) -> None:
    with qtbot.waitSignal(monitor.arrived):
        monitor.hear("never taken")

    monitor.end()

    assert monitor.isFinished()
