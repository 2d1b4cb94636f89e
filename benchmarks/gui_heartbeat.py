"""The longest time that the window's thread is held up while much happens at once.

A timer beats every 5 ms in a real window, offscreen and under Xvfb where it is installed. The goal
is held against the time that the thread was held up by the program itself; the clock's time, in
which other programs had the processor too, stands beside it.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import Any

from .virtual_display import NoDisplay, virtual_display

MOST_MS = 50.0
CHILD_S = 400

Row = dict[str, Any]


def run() -> list[Row]:
    """For each load the longest hold-up, and how much of it is work and how much the clock says."""
    rows = measured("offscreen", os.environ | {"QT_QPA_PLATFORM": "offscreen"})
    try:
        with virtual_display() as environment:
            return rows + measured("under Xvfb", environment)
    except NoDisplay as reason:
        name = f"window held up, under Xvfb: not measured. {reason}"
        return [*rows, {"name": name, "value": None, "unit": ""}]


def measured(where: str, environment: dict[str, str]) -> list[Row]:
    """Put the loads on a window in a process of its own."""
    command = [sys.executable, "-m", "benchmarks._heartbeat_child"]
    child = subprocess.run(
        command, env=environment, stdout=subprocess.PIPE, check=True, timeout=CHILD_S
    )
    found: dict[str, dict[str, float]] = json.loads(child.stdout)
    return [row for name, figures in found.items() for row in _rows(f"{where}: {name}", figures)]


def _rows(name: str, figures: dict[str, float]) -> list[Row]:
    held_up_ms = figures["held_up_ms"]
    goal = {"goal": f"under {MOST_MS:g} ms", "ok": held_up_ms < MOST_MS}
    return [
        {"name": f"window held up, {name}", "value": round(held_up_ms, 1), "unit": "ms", **goal},
        {"name": f"{name}: work alone", "value": round(figures["work_ms"], 1), "unit": "ms CPU"},
        {"name": f"{name}: by the clock", "value": round(figures["wall_ms"], 1), "unit": "ms"},
    ]
