"""Publisher to Subscriber against raw pyzmq (PUB and SUB, bytes, one frame), in the same run.

Where it is installed Zenoh is measured too, and with ``--with-peers`` the original ``nep``, which
is fetched for it. Two processes over loopback TCP. Floods and bursts of all sides alternate;
pings (one a millisecond) go by turns from the same process to the same process; ratios are
medians over the rounds. Our messages and those of the original are JSON of the given size,
encoded and decoded; all others are bytes. In floods both sides queue without limit, so nothing is
lost, but with the original; bursts are below every high-water mark, with all as it comes.
"""

from __future__ import annotations

import contextlib
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from typing import Any

from benchmarks import peers
from benchmarks._original_nep import original_nep
from benchmarks._pubsub_sides import HEARERS, Hear, free_ports, known_sides

Row = dict[str, Any]
Rounds = list[dict[str, float]]

SIZES = {"100 B": 100, "1 KB": 1000}
FLOOD = 150_000
ORIGINAL_FLOOD = 20_000
"""The original is slow: it gets fewer messages."""
BURST = 900
"""Raw ZeroMQ takes 1,000 as it comes."""
PINGS = 1_000
FLOOD_ROUNDS = 7
BURST_ROUNDS = 3
PING_ROUNDS = 5
SLOW_ROUNDS = 2
"""For the sides that no goal is about."""
START_S = 20.0
QUIET_S = 1.0


def run() -> list[Row]:
    """Throughput (goal: at least 0.85 of raw), one-way delay (at most 1.2 of raw), delivery."""
    with contextlib.ExitStack() as stack:
        rows: list[Row] = []
        if peers.are_wanted() and (why := stack.enter_context(original_nep())):
            missing = {"name": f"the original nep: not measured. {why}", "value": None, "unit": ""}
            rows.append({**missing, "goal": "to be measured", "ok": False})
        sides = known_sides()
        for label, size in SIZES.items():
            rows += _rows(label, size, sides)
        return rows


def _rows(label: str, size: int, sides: list[str]) -> list[Row]:
    floods = [
        {side: _flood(side, size) for side in _of_round(sides, at)} for at in range(FLOOD_ROUNDS)
    ]
    by_turns = [side for side in sides if side != "nep"]  # what it loses would hold up the rest
    pings = [_pings(size, by_turns) for _ in range(PING_ROUNDS)]
    if "nep" in sides:
        for all_sides, alone in zip(pings[0], _pings(size, ["nep"]), strict=True):
            all_sides |= alone
    bursts = [
        {side: _burst(side, size) for side in _of_round(sides, at)} for at in range(BURST_ROUNDS)
    ]
    rows = [
        *_compared(f"throughput {label}", "messages/s", floods, ("at least", 0.85)),
        *_compared(f"delay p50 {label}", "us", [p50 for p50, _ in pings], ("at most", 1.2)),
        *_compared(f"delay p99 {label}", "us", [p99 for _, p99 in pings], None),
        *_compared(f"delivered of a burst {label}", "%", bursts, None),
    ]
    for row in rows:
        if row["name"] == f"delivered of a burst {label}":
            row |= {"goal": "100 %", "ok": min(burst["ours"] for burst in bursts) == 100}
    return rows


def _of_round(sides: list[str], at: int) -> list[str]:
    return [side for side in sides if side in ("raw", "ours") or at < SLOW_ROUNDS]


def _compared(
    name: str, unit: str, rounds: Rounds, goal: tuple[str, float] | None
) -> Iterator[Row]:
    """Ours against raw, with the goal, and against each other side that was measured."""
    for other in list(rounds[0]):
        if other == "ours":
            continue
        both = [(one["ours"], one[other]) for one in rounds if other in one]
        ours, theirs = (statistics.median(side) for side in zip(*both, strict=True))
        ratio = statistics.median(ours / max(theirs, 1e-9) for ours, theirs in both)
        row: Row = {
            "name": name if other == "raw" else f"{name}, to {other}",
            "value": round(ours, 1),
            "unit": unit,
            "reference": round(theirs, 1),
            "ratio": round(ratio, 3),
        }
        if goal is not None and other == "raw":
            is_least = goal[0] == "at least"
            row["goal"] = f"{goal[0]} {goal[1]}"
            row["ok"] = ratio >= goal[1] if is_least else ratio <= goal[1]
        yield row


def _flood(side: str, size: int) -> float:
    """Messages a second, from the first sending to the last arrival."""
    count = ORIGINAL_FLOOD if side == "nep" else FLOOD
    with _hearing("flood", size, count, [side]) as [hear]:
        first_sent_s = hear(START_S)
        if first_sent_s is None:
            raise RuntimeError(f"nothing came from {side}")
        arrived, last_s = 1, time.monotonic()
        while arrived < count and hear(QUIET_S) is not None:
            arrived, last_s = arrived + 1, time.monotonic()
        if arrived < count and side != "nep":
            raise RuntimeError(f"{side}: {count - arrived} messages of a flood were lost")
        return arrived / (last_s - first_sent_s)


def _burst(side: str, size: int) -> float:
    """How much of a burst arrives, in %."""
    with _hearing("burst", size, BURST, [side]) as [hear]:
        arrived = int(hear(START_S) is not None)
        while arrived < BURST and hear(QUIET_S) is not None:
            arrived += 1
    return 100 * arrived / BURST


def _pings(size: int, sides: list[str]) -> tuple[dict[str, float], dict[str, float]]:
    """The p50 and the p99 of the delays of each side, in us."""
    delays_us: dict[str, list[float]] = {side: [] for side in sides}
    with _hearing("pings", size, PINGS, sides) as hearers:
        for at in range(PINGS):
            for side, hear in zip(sides, hearers, strict=True):
                if (sent_s := hear(QUIET_S if at else START_S)) is None:
                    break
                delays_us[side].append((time.monotonic() - sent_s) * 1e6)
    cuts = {side: statistics.quantiles(some, n=100) for side, some in delays_us.items()}
    return {side: cut[49] for side, cut in cuts.items()}, {s: cut[98] for s, cut in cuts.items()}


@contextlib.contextmanager
def _hearing(job: str, size: int, count: int, sides: list[str]) -> Iterator[list[Hear]]:
    """Hearers of these sides, to which a talker in a process of its own sends."""
    ports = free_ports(len(sides))
    with contextlib.ExitStack() as stack:
        pairs = list(zip(sides, ports, strict=True))
        hearers = [stack.enter_context(HEARERS[side](port, job == "burst")) for side, port in pairs]
        places = [f"{side}={port}" for side, port in pairs]
        command = [sys.executable, "-m", "benchmarks._pubsub_talker"]
        talker = subprocess.Popen(
            [*command, job, str(size), str(count), *places],
            stdout=sys.stderr,  # the original prints, and figures alone belong into our output
        )
        try:
            yield hearers
            talker.wait(START_S)
        finally:
            talker.kill()
            talker.wait()
