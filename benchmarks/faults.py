"""How soon a person is told that something went wrong, in a window that runs the karate example.

From the event to the message: a process is killed; a third heartbeat is missed; a node tells that
its watch or its robot does not answer. The worst of some rounds.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import Any

MOST_MS = 300.0
CHILD_S = 300


def run() -> list[dict[str, Any]]:
    """A row for each fault."""
    command = [sys.executable, "-m", "benchmarks._faults_child"]
    environment = os.environ | {"QT_QPA_PLATFORM": "offscreen"}
    child = subprocess.run(
        command, env=environment, stdout=subprocess.PIPE, check=True, timeout=CHILD_S
    )
    found: dict[str, float] = json.loads(child.stdout)
    return [_row(name, told_ms) for name, told_ms in found.items()]


def _row(name: str, told_ms: float) -> dict[str, Any]:
    return {
        "name": f"{name}: until it is told",
        "value": round(told_ms, 1),
        "unit": "ms",
        "goal": f"under {MOST_MS:g} ms",
        "ok": told_ms < MOST_MS,
    }
