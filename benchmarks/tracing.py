"""What it costs to follow a program: a tight loop traced and untraced, and what is told of it.

The loop does nothing but arithmetic, which is the worst that a program can do to its tracer. The
reference is the same program, untraced, in the same process and in turns. Times are CPU time.
"""

from __future__ import annotations

import runpy
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from nep_core.program.tasks import PROGRAM
from nep_core.wire.messages import ProgramControl, ProgramState
from nodes.cognitive.tracing.state import read_source
from nodes.cognitive.tracing.tracer import Tracer

ROUNDS = 5
TURNS = 300_000
STATEMENTS = 3 * TURNS
FOLLOWED_GOAL = 3.0
INSIDE_GOAL = 15.0
RATE_GOAL_HZ = 30.0
LOOP = f"""
def work():
    total = number = 0
    while number < {TURNS}:
        total += number
        number += 1
    if number < 0:
        work()
work()
"""
CALLS = 200_000
OWN_GOAL = 6.0
OWN_BLOCK = f"""
def add(value):
    return value + 1
def work():
    number = 0
    while number < {CALLS}:
        number = add(number)
work()
"""
LONG = "from nep_core import Behavior\nbehavior = Behavior()\nx = 0\ny = 0\n" + "".join(
    f"def rule{n}():\n    global x, y\n" + "    x = x + 1\n    y = x\n" * 50 for n in range(50)
)
RULES = 20
SIDE_BY_SIDE = f"""
from nep_core.program.tasks import PROGRAM, together
def rule():
    global count
    while not PROGRAM.cancelled.is_set():
        count = count + 1
count = 0
together({", ".join(["rule"] * RULES)})
"""
NOWHERE, NEVER_REACHED = 999, 8
"""Lines at which the loop never is: one outside of its function, one in it."""
LISTEN_S = 3.0


def run() -> list[dict[str, Any]]:
    """Rows of ratios, rates and milliseconds."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "program.py"
        file.write_text(LOOP, encoding="utf-8")
        plain_s, followed_s, elsewhere_s, inside_s = _loop_times(file)
        file.write_text(OWN_BLOCK, encoding="utf-8")
        own_s, own_followed_s = _own_block_times(file)
        file.write_text(LONG, encoding="utf-8")
        read_s = min(_cpu_s(lambda: read_source(file)) for _ in range(ROUNDS))
        file.write_text(SIDE_BY_SIDE, encoding="utf-8")
        rates = _message_rates(file)
    return [
        _ratio("a loop that is followed", followed_s, plain_s, FOLLOWED_GOAL),
        _ratio("a loop with a breakpoint elsewhere", elsewhere_s, plain_s, FOLLOWED_GOAL),
        _ratio("a loop with a breakpoint in its function", inside_s, plain_s, INSIDE_GOAL),
        _ratio("an own block in a loop, followed", own_followed_s, own_s, OWN_GOAL, CALLS),
        *(_rate(event, rates[event]) for event in ("line", "value")),
        {
            "name": "tracing: reading a program of 5,000 blocks",
            "value": round(read_s * 1000, 1),
            "unit": "ms CPU",
            "goal": "under 300 ms",
            "ok": read_s < 0.3,
        },
    ]


def _loop_times(file: Path) -> tuple[float, float, float, float]:
    """CPU seconds of the program: as it is, followed, with a breakpoint elsewhere and inside."""
    plain, followed, elsewhere, inside = [], [], [], []
    for _ in range(ROUNDS):
        plain.append(_cpu_s(lambda: _run(file)))
        followed.append(_cpu_s(lambda: _run(file, Tracer("program", str(file), _ignore))))
        elsewhere.append(_cpu_s(lambda: _run(file, _tracer(file, breakpoint_at=NOWHERE))))
        inside.append(_cpu_s(lambda: _run(file, _tracer(file, breakpoint_at=NEVER_REACHED))))
    return min(plain), min(followed), min(elsewhere), min(inside)


def _own_block_times(file: Path) -> tuple[float, float]:
    """CPU seconds of a loop that does nothing but call an own block: as it is, and followed."""
    plain, followed = [], []
    for _ in range(ROUNDS):
        plain.append(_cpu_s(lambda: _run(file)))
        followed.append(_cpu_s(lambda: _run(file, Tracer("program", str(file), _ignore))))
    return min(plain), min(followed)


def _tracer(file: Path, breakpoint_at: int) -> Tracer:
    tracer = Tracer("program", str(file), _ignore)
    tracer.obey(ProgramControl(command="set", breakpoints=[breakpoint_at]))
    return tracer


def _ignore(_state: ProgramState) -> None:
    """Hear what is told, as a publisher does."""


def _run(file: Path, tracer: Tracer | None = None) -> None:
    if tracer is not None:
        tracer.begin()
    try:
        runpy.run_path(str(file))
    finally:
        if tracer is not None:
            tracer.end()


def _cpu_s(work: Callable[[], object]) -> float:
    began_s = time.process_time()
    work()
    return time.process_time() - began_s


def _message_rates(file: Path) -> dict[str, float]:
    """Messages a second of each kind, while 20 rules run in loops that never wait."""
    told: list[ProgramState] = []
    tracer = Tracer("program", str(file), told.append)
    threading.Timer(LISTEN_S, PROGRAM.cancel).start()
    began_s = time.monotonic()
    try:
        _run(file, tracer)
    except BaseException as ended:  # Cancelled: the timer ends the program
        if not PROGRAM.cancelled.is_set():
            raise ended
    elapsed_s = time.monotonic() - began_s
    PROGRAM.cancelled.clear()
    return {
        event: sum(state.event == event for state in told) / elapsed_s
        for event in ("line", "value")
    }


def _ratio(
    name: str, seconds: float, plain_s: float, goal: float, count: int = STATEMENTS
) -> dict[str, Any]:
    return {
        "name": f"tracing: {name}",
        "value": round(seconds / count * 1e9, 1),
        "unit": "ns each",
        "reference": round(plain_s / count * 1e9, 1),
        "ratio": round(seconds / plain_s, 2),
        "goal": f"at most {goal:g} times",
        "ok": seconds / plain_s <= goal,
    }


def _rate(event: str, rate_hz: float) -> dict[str, Any]:
    return {
        "name": f"tracing: {event} messages of {RULES} busy rules",
        "value": round(rate_hz, 1),
        "unit": "a second",
        "goal": f"at most {RATE_GOAL_HZ:g}",
        "ok": 0 < rate_hz <= RATE_GOAL_HZ,
    }
