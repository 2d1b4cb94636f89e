"""The window's thread is never held up, whatever nodes and programs do at the same time.

Measured is the CPU time of that thread between two beats, which is the same on a computer that is
busy with other things; how long it stands still for locks, files and Python's own lock has a bound
of its own, since other programs have a share in that. ``dev.py bench gui_heartbeat`` is stricter.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from benchmarks.gui_loads import LOADS, PREPARATIONS
from benchmarks.heartbeat import Heartbeat, Longest
from nep_studio.ui.main_window import MainWindow

MOST_WORK_MS = 50
MOST_HELD_UP_MS = 500
WAIT_MS = 60_000
FEWEST_BEATS = 10
TRIES = 3
"""Two programs on one core's halves make each other's CPU time longer: a window that is really
held up is so each time."""

Wait = Callable[[Callable[[], bool]], None]


def until(qtbot: QtBot) -> Wait:
    """Run the window until a condition holds."""
    return lambda condition: qtbot.waitUntil(condition, timeout=WAIT_MS)


def test_a_heartbeat_notices_work_and_standing_still(qtbot: QtBot) -> None:
    heartbeat = Heartbeat()
    heartbeat.begin()

    sum(number * number for number in range(400_000))
    qtbot.waitUntil(lambda: heartbeat.beats > 2)
    worked = heartbeat.longest.work_ms
    heartbeat.begin()
    qtbot.waitUntil(lambda: heartbeat.beats > 2)

    assert worked > 5
    assert heartbeat.end().work_ms < worked


@pytest.mark.timeout(240)
@pytest.mark.parametrize("load", LOADS)
def test_the_window_is_not_held_up_while(
    window: MainWindow, tmp_path: Path, qtbot: QtBot, load: str
) -> None:
    found: list[Longest] = []
    while len(found) < TRIES and not (found and _is_fluent(found[-1])):
        folder = tmp_path / str(len(found))
        folder.mkdir()
        found.append(_longest_during(load, window, folder, until(qtbot)))

    assert _is_fluent(found[-1]), found


def _longest_during(load: str, window: MainWindow, folder: Path, wait: Wait) -> Longest:
    runner = window.running.runner
    runner.stop()
    wait(lambda: runner.state == "idle")
    if load in PREPARATIONS:
        PREPARATIONS[load](window, folder, wait)
    heartbeat = Heartbeat()
    heartbeat.begin()

    LOADS[load](window, folder, wait)

    longest = heartbeat.end()
    assert heartbeat.beats > FEWEST_BEATS
    return longest


def _is_fluent(longest: Longest) -> bool:
    return longest.work_ms < MOST_WORK_MS and longest.held_up_ms < MOST_HELD_UP_MS
