"""A minute in which nodes and the master are killed and started again, every second one of them.

10 publishers (two in each of five processes) and 20 subscribers (four in each of five) on five
topics, so that each publisher has four subscribers. No message may be lost between two that live,
after their handshake: see _soak_account.py. The memory of two that are never killed stays flat.
"""

from __future__ import annotations

import contextlib
import random
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TextIO

import psutil

from benchmarks._soak_account import Account, account

SECONDS = 60.0
SEED = 20260714
GROUPS = 5
TOPICS = tuple(f"/soak/{i}" for i in range(GROUPS))
EVERY_S = 1.0
MASTERS_TURN = 3
"""Every so many-th time it is the master that is killed."""
LONGEST_AWAY_S = 0.7
READY_S = 30.0
DRAIN_S = 1.0
MOST_GROWTH_MB = 3.0


@dataclass
class Program:
    """One place in the soak; ``run`` counts the processes that have filled it."""

    name: str
    command: list[str]
    run: int = 0
    process: subprocess.Popen[str] | None = None
    start_s: float = 0.0


@dataclass
class Report:
    """How it went."""

    account: Account = field(default_factory=Account)
    kills: int = 0
    stops: int = 0
    master_kills: int = 0
    died: list[str] = field(default_factory=list)
    growth_mb: float | None = None


def run() -> list[dict[str, Any]]:
    """Messages lost (goal: none) and memory (goal: flat)."""
    with tempfile.TemporaryDirectory() as folder:
        report = soak(SECONDS, SEED, Path(folder))
        errors = (Path(folder) / "errors.txt").read_text("utf-8")[-2000:]
    told = report.account
    print("\n".join([*told.losses, *report.died, errors]), file=sys.stderr)
    return [
        _row("messages sent", told.sent),
        _row("deliveries owed", told.owed),
        _row("deliveries received", told.received),
        _row("excused: an end was killed or closed", told.excused),
        _row("lost", told.lost, most=0),
        _row("twice or out of order", told.disordered, most=0),
        _row("nodes killed", report.kills),
        _row("nodes stopped", report.stops),
        _row("masters killed", report.master_kills),
        _row("programs that ended by themselves", len(report.died), most=0),
        _row("memory gained by the survivors", report.growth_mb, "MB", most=MOST_GROWTH_MB),
    ]


def _row(
    name: str, value: float | None, unit: str = "", most: float | None = None
) -> dict[str, Any]:
    row: dict[str, Any] = {"name": name, "value": value, "unit": unit}
    if most is None or value is None:
        return row
    return row | {"goal": f"at most {most:g}", "ok": value <= most}


def soak(
    seconds: float, seed: int, folder: Path, *, every_s: float = EVERY_S, is_deaf: bool = False
) -> Report:
    """Let all work for so long; ``is_deaf`` plants a fault: one program skips messages."""
    with Soak(seed, folder, is_deaf) as all_:
        all_.wait_until_ready()
        all_.trouble(seconds, every_s)
        all_.drain()
    all_.report.account = account(folder, all_.killed_s)
    return all_.report


class Soak:
    """The programs at work, and what was done to them."""

    def __init__(self, seed: int, folder: Path, is_deaf: bool) -> None:
        self.report = Report()
        self.killed_s: dict[str, float] = {}
        self._folder = folder
        self._chance = random.Random(seed)
        self._errors: TextIO = (folder / "errors.txt").open("w+")
        self._master = Program("master", ["benchmarks._master_child", "tcp://127.0.0.1:*"])
        self._launch(self._master)
        master = self._first_word(self._master)
        self._master.command[1] = master
        self._publishers = [
            self._node("publisher", i, master, [TOPICS[i], TOPICS[(i + 1) % GROUPS]])
            for i in range(GROUPS)
        ]
        self._subscribers = [
            self._node(
                "deaf" if is_deaf and i == 0 else "subscriber",
                i,
                master,
                TOPICS[:i] + TOPICS[i + 1 :],
            )
            for i in range(GROUPS)
        ]
        self._survivors = [self._publishers[0], self._subscribers[0]]
        self._mortals = [*self._publishers[1:], *self._subscribers[1:]]
        self._sizes_mb: list[float] = []
        self._hits = 0

    def __enter__(self) -> Soak:
        return self

    def __exit__(self, *_error: object) -> None:
        for program in self._all():
            if program.process is not None:
                program.process.kill()
                program.process.communicate()
        self._errors.close()

    def wait_until_ready(self) -> None:
        """Wait for the first word of each program."""
        programs = [*self._publishers, *self._subscribers]
        for program in programs:
            self._launch(program)
        for program in programs:
            self._first_word(program)

    def trouble(self, seconds: float, every_s: float) -> None:
        """Every second something is killed, and started again a little later."""
        end_s = time.monotonic() + seconds
        next_s = time.monotonic() + every_s
        while (now_s := time.monotonic()) < end_s:
            for program in self._all():
                if program.process is None and now_s >= program.start_s:
                    self._launch(program)
            self._look_for_the_dead()
            if now_s >= next_s:
                next_s += every_s
                self._sizes_mb.append(self._survivors_mb())
                self._hit()
            time.sleep(0.02)
        for program in self._all():
            if program.process is None:
                self._launch(program)

    def drain(self) -> None:
        """Stop the publishers, let what they sent arrive, stop the subscribers."""
        for programs in (self._publishers, self._subscribers):
            for program in programs:
                assert program.process is not None
                program.process.terminate()
            for program in programs:
                assert program.process is not None
                if program.process.wait(READY_S) not in (0, -signal.SIGTERM):
                    self._note_dead(program)
            if programs is self._publishers:
                time.sleep(DRAIN_S)
        quarter = len(self._sizes_mb) // 4
        if quarter > 2:
            first, last = self._sizes_mb[quarter : 2 * quarter], self._sizes_mb[-quarter:]
            self.report.growth_mb = round(statistics.median(last) - statistics.median(first), 2)

    def _all(self) -> list[Program]:
        return [self._master, *self._publishers, *self._subscribers]

    def _node(self, role: str, index: int, master: str, topics: Sequence[str]) -> Program:
        name = f"{role}{index}"
        command = ["benchmarks._soak_child", role, name, "RUN", master, str(self._folder), *topics]
        return Program(name, command)

    def _launch(self, program: Program) -> None:
        program.run += 1
        words = [str(program.run) if word == "RUN" else word for word in program.command]
        program.process = subprocess.Popen(
            [sys.executable, "-m", *words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
        )

    def _first_word(self, program: Program) -> str:
        assert program.process is not None and program.process.stdout is not None
        return program.process.stdout.readline().strip()

    def _hit(self) -> None:
        self._hits += 1
        victim = self._chance.choice([one for one in self._mortals if one.process])
        if self._hits % MASTERS_TURN == 0 and self._master.process:
            victim = self._master
        assert victim.process is not None
        if victim is self._master or self._chance.random() < 0.7:
            self.killed_s[f"{victim.name}.{victim.run}"] = time.monotonic()
            victim.process.kill()
            self.report.master_kills += victim is self._master
            self.report.kills += victim is not self._master
        else:
            victim.process.terminate()
            self.report.stops += 1
        with contextlib.suppress(subprocess.TimeoutExpired):
            victim.process.communicate(timeout=READY_S)
        if victim.process.returncode is None or victim.process.returncode > 0:
            self._note_dead(victim)  # it hung, or it had ended before
        victim.process = None
        victim.start_s = time.monotonic() + self._chance.uniform(0.0, LONGEST_AWAY_S)

    def _look_for_the_dead(self) -> None:
        for program in self._all():
            if program.process is not None and program.process.poll() is not None:
                self._note_dead(program)
                program.process = None
                program.start_s = time.monotonic() + EVERY_S

    def _note_dead(self, program: Program) -> None:
        assert program.process is not None
        self.report.died.append(f"{program.name}.{program.run}: {program.process.returncode}")

    def _survivors_mb(self) -> float:
        pids = [one.process.pid for one in self._survivors if one.process]
        return float(sum(psutil.Process(pid).memory_info().rss for pid in pids) / 1e6)
