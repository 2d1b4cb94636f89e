"""A NAOqi client for the benchmark, ours or the official package's: for each line of its input it
measures that many round trips of both calls and prints them in us as JSON."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable

NAMES = [f"Joint{number}" for number in range(26)]
GOALS = [0.05 * number for number in range(26)]

KEPT: list[object] = []  # sessions of the official package end when nobody holds them

Call = Callable[[], object]


def our_calls(port: int) -> tuple[Call, Call]:
    """Connect with our client."""
    from robots.naoqi.client.session import Session

    session = Session(("127.0.0.1", port))
    session.connect()
    motion = session.service("ALMotion")
    return (
        lambda: motion.call("getAngles", "Body", True),
        lambda: motion.call("setAngles", NAMES, GOALS, 0.2),
    )


def their_calls(port: int) -> tuple[Call, Call]:
    """Connect with the official package."""
    import qi

    qi.logging.setLevel(qi.logging.FATAL)
    session = qi.Session()
    session.connect(f"tcp://127.0.0.1:{port}")
    KEPT.append(session)
    motion = session.service("ALMotion")
    return (
        lambda: motion.getAngles("Body", True),
        lambda: motion.setAngles(NAMES, GOALS, 0.2),
    )


def measured(call: Call, count: int) -> list[float]:
    """Return how long each call took, in us."""
    times_us = []
    for _ in range(count):
        start_s = time.perf_counter()
        call()
        times_us.append((time.perf_counter() - start_s) * 1e6)
    return times_us


if __name__ == "__main__":
    calls = (our_calls if sys.argv[1] == "ours" else their_calls)(int(sys.argv[2]))
    sys.stdout.write("ready\n")
    sys.stdout.flush()
    for line in sys.stdin:
        times = [measured(call, int(line)) for call in calls]
        sys.stdout.write(json.dumps(times) + "\n")
        sys.stdout.flush()
    os._exit(0)  # the official package aborts at a usual exit
