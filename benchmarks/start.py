"""From starting the program to a window that can be used, warm, from source.

A window can be used when its first page is painted and its event loop has turned some times. What
ours makes after its first page (the workbench and the panels) is measured to its end as well. So
is an empty window of PySide6, for a machine that is busy is slow for both. Memory is told as RSS,
which counts the libraries that others use too, and as USS, which does not; once when all is made,
and once after each panel, page and dialog was opened with an example that has run.
Offscreen, and under Xvfb where it is installed. With ``--with-peers`` Orange Canvas, another
editor made with Qt and Python, is measured in turn with ours: without its splash screen and
without its welcome window, and with no widget installed, so that it has the least to do.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from nep_studio.support.safe_mode import NOTE

from . import peers
from .virtual_display import NoDisplay, virtual_display

ROOT = Path(__file__).resolve().parents[1]
LIMIT_S = 1800
"""Programs to compare with are fetched first, when they are asked for."""
CHILD = Path(__file__).with_name("_start_child.py")
MOST_S, MOST_COMPLETE_S = 0.8, 1.5
MOST_MB, MOST_USED_MB = 110, 220
USED_ROUNDS = 3
ROUNDS = 9
LONGEST_S = 60
LINES = 2
"""What a start tells: when the window is there, and when all is behind it."""
FETCH_S = 400
ORANGE = ("orange-canvas-core==0.2.9", "PyQt6==6.11.0")
"""It knows PyQt only; with the Qt that we have."""

Row = dict[str, Any]


class PeerMissing(Exception):
    """Orange cannot be measured on this machine; the text says what is missing."""


@dataclass(frozen=True)
class Program:
    """A program with a window, and the Python that it is started with."""

    name: str
    python: str
    words: tuple[str, ...]


@dataclass(frozen=True)
class Start:
    """One start: on the clock, and the CPU time of all threads of the process.

    ``all`` is when nothing is left to be made behind the window that can be used; the memory is of
    that moment, 0 where the system does not tell it.
    """

    wall_s: float
    cpu_s: float
    all_wall_s: float
    all_cpu_s: float
    rss_mb: float
    uss_mb: float


OURS = Program("ours", sys.executable, ("PySide6", "nep_studio"))
EMPTY = Program("empty", sys.executable, ("PySide6", "empty"))


def run() -> list[Row]:
    """Medians of some starts, ours and Orange's one after the other."""
    with ExitStack() as ending:
        programs, rows = [OURS, EMPTY], []
        if peers.are_wanted():
            try:
                programs.append(ending.enter_context(_orange()))
            except PeerMissing as reason:
                missing = {"name": f"start of Orange: not measured. {reason}", "value": None}
                rows.append({**missing, "unit": "", "goal": "to be measured", "ok": False})
        rows += _measured("offscreen", programs, os.environ | {"QT_QPA_PLATFORM": "offscreen"})
        rows += _used()
        try:
            display = ending.enter_context(virtual_display())
        except NoDisplay as reason:
            return [*rows, {"name": f"start under Xvfb: not measured. {reason}", **_NOTHING}]
        return rows + _measured("under Xvfb", programs, display)


_NOTHING: Row = {"value": None, "unit": ""}


def _measured(where: str, programs: Sequence[Program], environment: dict[str, str]) -> list[Row]:
    """The medians of each program, after one start that fills the caches."""
    starts: dict[str, list[Start]] = {program.name: [] for program in programs}
    with tempfile.TemporaryDirectory(prefix="nep-start-") as home:
        private = _private(environment, home)
        for round_number in range(ROUNDS + 1):
            for program in programs:
                one = _start(program, private)
                if round_number:
                    starts[program.name].append(one)

    def medians(of: Callable[[Start], float]) -> dict[str, float]:
        return {name: statistics.median(map(of, some)) for name, some in starts.items()}

    wall_s, cpu_s = medians(lambda one: one.wall_s), medians(lambda one: one.cpu_s)
    name = f"start to a usable window, {where}"
    rest = f"start until all behind the window is made, {where}"
    all_wall_s, all_cpu_s = medians(lambda one: one.all_wall_s), medians(lambda one: one.all_cpu_s)
    rows = [
        _against_empty(name, wall_s, "s", MOST_S),
        _against_empty(f"{name}: CPU", cpu_s, "s CPU", MOST_S),
        _against_empty(rest, all_wall_s, "s", MOST_COMPLETE_S),
        _against_empty(f"{rest}: CPU", all_cpu_s, "s CPU", MOST_COMPLETE_S),
    ]
    rss_mb, uss_mb = medians(lambda one: one.rss_mb), medians(lambda one: one.uss_mb)
    if rss_mb["ours"]:
        told = f"memory when all is made, {where}"
        rows.append(_against_empty(f"{told}: RSS", rss_mb, "MB", MOST_MB))
        rows.append(_against_empty(f"{told}: USS", uss_mb, "MB"))
    if "Orange" in starts:
        rows += [
            _against_orange(name, wall_s, "s"),
            _against_orange(f"{name}: CPU", cpu_s, "s CPU"),
            _against_orange(rest, all_wall_s, "s"),
            _against_orange(f"{rest}: CPU", all_cpu_s, "s CPU"),
        ]
    return rows


def _against_empty(name: str, found: dict[str, float], unit: str, most: float | None = None) -> Row:
    """A figure of ours beside that of a window with nothing in it."""
    value, reference = found["ours"], found["empty"]
    row: Row = {
        "name": name,
        "value": round(value, 3),
        "unit": unit,
        "reference": round(reference, 3),
        "ratio": round(value / reference, 2),
    }
    if most is None:
        return row
    return row | {"goal": f"under {most:g} {unit}", "ok": value < most}


def _used() -> list[Row]:
    """The memory after all panels, pages and dialogs were used; nothing where nobody tells it."""
    found = []
    for _ in range(USED_ROUNDS):
        command = [sys.executable, "-m", "benchmarks._panels_child"]
        done = subprocess.run(
            command, cwd=ROOT, capture_output=True, text=True, timeout=4 * LONGEST_S, check=True
        )
        told = {line["name"]: line for line in map(json.loads, done.stdout.splitlines())}
        if "rss_mb" not in told["used"]:
            return []
        found.append(told["used"])
    rss_mb, uss_mb = (statistics.median(one[key] for one in found) for key in ("rss_mb", "uss_mb"))
    name = "memory after all panels and dialogs were used"
    goal = {"goal": f"under {MOST_USED_MB:g} MB", "ok": rss_mb < MOST_USED_MB}
    return [
        {"name": f"{name}: RSS", "value": round(rss_mb, 1), "unit": "MB", **goal},
        {"name": f"{name}: USS", "value": round(uss_mb, 1), "unit": "MB"},
    ]


def _against_orange(name: str, found_s: dict[str, float], unit: str) -> Row:
    ratio = found_s["ours"] / found_s["Orange"]
    return {
        "name": f"{name}, to Orange",
        "value": round(found_s["ours"], 3),
        "unit": unit,
        "reference": round(found_s["Orange"], 3),
        "ratio": round(ratio, 3),
        "goal": "faster than Orange",
        "ok": ratio < 1,
    }


def _private(environment: dict[str, str], home: str) -> dict[str, str]:
    """Settings of nobody: each program begins as on a computer where it was used once before."""
    away = ("XDG_", "PYTHONDONTWRITEBYTECODE")  # a warm start finds compiled code
    kept = {key: value for key, value in environment.items() if not key.startswith(away)}
    folders = {"HOME": home, "NEP_STUDIO_FOLDER": str(Path(home) / "nep"), "XDG_RUNTIME_DIR": home}
    return kept | folders | {"QT_API": "pyqt6", "PYTHONUTF8": "1"}


def _start(program: Program, environment: dict[str, str]) -> Start:
    command = [program.python, str(CHILD), *program.words]
    began_s = time.perf_counter()
    with subprocess.Popen(
        command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as child:
        assert child.stdout is not None
        late = threading.Timer(LONGEST_S, child.kill)  # a program that asks gets no answer
        late.start()
        told: list[dict[str, float]] = []
        while line := child.stdout.readline():
            told.append(json.loads(line) | {"wall_s": time.perf_counter() - began_s})
        _, said = child.communicate()
        late.cancel()
    # It was ended at once, as by a crash, after which the next start would ask what to do.
    (Path(environment["NEP_STUDIO_FOLDER"]) / NOTE).unlink(missing_ok=True)
    if len(told) != LINES:
        raise RuntimeError(f"{program.name} did not start:\n{said.decode(errors='replace')}")
    first, last = told
    return Start(
        wall_s=first["wall_s"],
        cpu_s=first["cpu_s"],
        all_wall_s=last["wall_s"],
        all_cpu_s=last["cpu_s"],
        rss_mb=last.get("rss_mb", 0.0),
        uss_mb=last.get("uss_mb", 0.0),
    )


@contextmanager
def _orange() -> Iterator[Program]:
    """Orange Canvas in an environment of its own, which is removed afterwards.

    Raises PeerMissing.
    """
    with tempfile.TemporaryDirectory(prefix="nep-orange-") as folder:
        is_windows = sys.platform == "win32"
        python = Path(folder) / ("Scripts/python.exe" if is_windows else "bin/python")
        make = [sys.executable, "-m", "venv", folder]
        fetch = [str(python), "-m", "pip", "install", "--quiet", "--no-input", *ORANGE]
        for command in (make, fetch):
            try:
                done = subprocess.run(command, capture_output=True, text=True, timeout=FETCH_S)
            except subprocess.TimeoutExpired as error:
                raise PeerMissing(f"{ORANGE[0]} could not be fetched in {FETCH_S} s.") from error
            if done.returncode != 0:
                last = done.stderr.strip()[-400:]
                raise PeerMissing(f"{ORANGE[0]} could not be fetched with pip: {last}")
        words = ("PyQt6", "orangecanvas", "--no-splash", "--no-welcome")
        yield Program("Orange", str(python), words)
