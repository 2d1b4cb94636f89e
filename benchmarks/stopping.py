"""How long a robot goes on after Stop is pressed, while it speaks, walks and plays an animation.

The robot is the virtual NAO in a process of its own, the program is traced as it is in the window.
Measured from the press to the moment at which the robot's node says that the action is cancelled;
idle, and while every core of the computer is busy with something else. The worst of all rounds.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import msgspec

from nep_core.wire.messages import ACTION_RESULT, ActionResult
from nep_studio.run.local_network import LocalNetwork
from nep_studio.run.plan import PlannedNode, Watching
from nep_studio.run.session import Session

GOAL_S = 0.2
WAIT_S = 20.0
ROUNDS = {"idle": 2, "busy computer": 4}
ACTIONS = {
    "speaking": 'nao.say("This is a very long sentence, and it goes on for some time. " * 4)',
    "walking": "nao.walk(3)",
    "playing": 'nao.play("dance")',
}
PROGRAM = 'from nep_core import Robot\nnao = Robot("NAO")\n{action}\nnao.say("Still here.")\n'
ROBOT = PlannedNode("action/nao", "NAO", {"robot": "NAO", "driver": "virtual"})
BURN = "while True: pass"


class Results:
    """What the robot's node said last of its actions."""

    def __init__(self) -> None:
        self.all: list[ActionResult] = []
        self._came = threading.Condition()

    def __call__(self, topic: str, message: msgspec.Struct) -> None:
        """Take in a message of the session."""
        if topic == ACTION_RESULT and isinstance(message, ActionResult):
            with self._came:
                self.all.append(message)
                self._came.notify_all()

    def first(self, state: str) -> ActionResult:
        """The first result of that state; raises TimeoutError."""
        with self._came:
            if not self._came.wait_for(lambda: self._of(state), WAIT_S):
                raise TimeoutError(f"no action was {state}")
            return self._of(state)[0]

    def _of(self, state: str) -> list[ActionResult]:
        return [result for result in self.all if result.state == state]


def run() -> list[dict[str, Any]]:
    """A row for each action, idle and under load."""
    rows, begun_after = [], 0
    with tempfile.TemporaryDirectory() as folder:
        for load, rounds in ROUNDS.items():
            for name, action in ACTIONS.items():
                with _busy(os.cpu_count() or 1 if load != "idle" else 0):
                    times_s, begun = zip(
                        *(_stop_s(Path(folder), action) for _ in range(rounds)), strict=True
                    )
                rows.append(_row(f"{name}, {load}", max(times_s)))
                begun_after += sum(begun)
    return [*rows, _begun_row(begun_after)]


@contextmanager
def _busy(processes: int) -> Iterator[None]:
    """Keep that many cores busy."""
    burning = [subprocess.Popen([sys.executable, "-c", BURN]) for _ in range(processes)]
    try:
        yield
    finally:
        for process in burning:
            process.kill()
            process.wait()


def _stop_s(folder: Path, action: str) -> tuple[float, int]:
    """Seconds from the press to the end of the action, and how many the robot began after it."""
    file = folder / "program.py"
    file.write_text(PROGRAM.format(action=action), encoding="utf-8")
    results = Results()
    network = LocalNetwork(logs=folder)
    network.listen(results)
    network.gate.admit(file.read_text(encoding="utf-8"))  # it is our own
    with closing(network), Session([ROBOT], network, program=file, watching=Watching()) as session:
        results.first("started")
        time.sleep(0.5)  # it is in the middle of it
        pressed_s = time.time()
        session.stop()
    begun = sum(result.state == "started" and result.time > pressed_s for result in results.all)
    return results.first("cancelled").time - pressed_s, begun


def _begun_row(count: int) -> dict[str, Any]:
    return {
        "name": "actions that robots began after Stop",
        "value": count,
        "unit": "",
        "goal": "none",
        "ok": count == 0,
    }


def _row(name: str, seconds: float) -> dict[str, Any]:
    return {
        "name": f"from Stop to a robot at rest: {name}",
        "value": round(seconds * 1000, 1),
        "unit": "ms",
        "goal": f"under {GOAL_S * 1000:g} ms",
        "ok": seconds < GOAL_S,
    }
