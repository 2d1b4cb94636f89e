"""Round trips over NAOqi's protocol: our client against the official binding, at both servers.

Servers and clients are processes of their own on loopback. All four combinations are measured in
the same run, by turns; a ratio is the median over the rounds of ours against the official client
at the same server. Without the package ``qi`` there are only our own figures.
"""

from __future__ import annotations

import contextlib
import importlib.util
import json
import statistics
import subprocess
import sys
from collections.abc import Iterator
from typing import IO, Any

CALLS = ("getAngles", "setAngles(26 joints)")
ROUNDS = 9
CALLS_A_ROUND = 400
WARM_UP = 100
SIDES = ("ours", "theirs")
P50, P99 = 50, 99

Rounds = dict[tuple[str, str], list[list[list[float]]]]
"""By client and server: for each round, for each call, the times in us."""


def run() -> list[dict[str, Any]]:
    """The round trips of both calls at both servers (goal: at most 1.2 of the official client)."""
    sides = SIDES if importlib.util.find_spec("qi") else SIDES[:1]
    with contextlib.ExitStack() as stack:
        ports = {side: int(_started(stack, "_naoqi_server", side)[1]) for side in sides}
        clients = {
            (client, server): _started(stack, "_naoqi_client", client, str(ports[server]))[0]
            for client in sides
            for server in sides
        }
        rounds = _rounds(clients)
    return list(_figures(rounds, sides))


def _started(
    stack: contextlib.ExitStack, module: str, *arguments: str
) -> tuple[subprocess.Popen[str], str]:
    """Start a process that ends with the stack; return it and the line that it says first."""
    process = subprocess.Popen(
        [sys.executable, "-m", f"benchmarks.{module}", *arguments],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    stack.callback(process.wait)
    stack.callback(process.kill)
    return process, _pipe(process.stdout).readline()


def _rounds(clients: dict[tuple[str, str], subprocess.Popen[str]]) -> Rounds:
    times: Rounds = {key: [] for key in clients}
    for number in range(ROUNDS + 1):
        for key, client in clients.items():
            asked = _pipe(client.stdin)
            asked.write(f"{CALLS_A_ROUND if number else WARM_UP}\n")
            asked.flush()
            answer = json.loads(_pipe(client.stdout).readline())
            if number:
                times[key].append(answer)
    return times


def _pipe(pipe: IO[str] | None) -> IO[str]:
    assert pipe is not None
    return pipe


def _figures(rounds: Rounds, sides: tuple[str, ...]) -> Iterator[dict[str, Any]]:
    for server in sides:
        for number, call in enumerate(CALLS):
            for percent in (P50, P99):
                ours = _percentiles(rounds["ours", server], number, percent)
                theirs = _percentiles(rounds.get(("theirs", server), []), number, percent)
                yield _figure(f"{call} p{percent}, {server} server", percent, ours, theirs)


def _percentiles(rounds: list[list[list[float]]], number: int, percent: int) -> list[float]:
    """Return for each round the time that so many percent of the calls stay under."""
    return [statistics.quantiles(times[number], n=100)[percent - 1] for times in rounds]


def _figure(name: str, percent: int, ours: list[float], theirs: list[float]) -> dict[str, Any]:
    figure: dict[str, Any] = {"name": name, "value": round(statistics.median(ours), 1)}
    figure["unit"] = "us"
    if theirs:
        ratio = statistics.median(a / b for a, b in zip(ours, theirs, strict=True))
        figure["reference"] = round(statistics.median(theirs), 1)
        figure["ratio"] = round(ratio, 3)
        if percent == P50:
            figure |= {"goal": "at most 1.2", "ok": ratio <= 1.2}
    return figure
