"""The sending process of the publish and subscribe benchmark: ``JOB SIZE COUNT SIDE=PORT ...``.

The jobs are "flood", "burst" (a flood with everything as it comes) and "pings".
"""

from __future__ import annotations

import contextlib
import sys
import time

from benchmarks._pubsub_sides import TALKERS, Send

PING_PAUSE_S = 0.001


def main(job: str, size: int, count: int, sides: list[tuple[str, int]]) -> None:
    """Talk to each side, by turns."""
    with contextlib.ExitStack() as stack:
        ways = [
            stack.enter_context(TALKERS[side](port, size, job == "burst")) for side, port in sides
        ]
        if job == "pings":
            ping(ways, count)
        else:
            flood(ways[0], count)


def flood(send: Send, count: int) -> None:
    """Send as fast as it goes."""
    for _ in range(count):
        send(time.monotonic())


def ping(ways: list[Send], count: int) -> None:
    """Send one message a millisecond, by turns."""
    for _ in range(count):
        for send in ways:
            time.sleep(PING_PAUSE_S)
            send(time.monotonic())


if __name__ == "__main__":
    _, job, size, count, *sides = sys.argv
    pairs = [side.split("=") for side in sides]
    main(job, int(size), int(count), [(side, int(port)) for side, port in pairs])
