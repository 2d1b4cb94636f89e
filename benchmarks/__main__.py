"""Run benchmarks, each in a process of its own, and say which goals were missed.

A benchmark is a module of this folder with a function ``run() -> list[dict]``. Each dict is one
figure: ``name``, ``value``, ``unit`` and, where there are any, ``reference`` (the value of the
reference), ``ratio`` (value / reference), ``goal`` (in words: "at most 1.2") with ``ok``.

Nobody sits beside a benchmark: it has nothing to read from, a time limit (``LIMIT_S`` of its
module, or the usual one), and a folder for temporary files that goes with it. When it ends, runs
past its limit, or the runner is stopped, everything that it started is ended.
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import importlib
import json
import os
import secrets
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Any

import psutil

from . import peers

FOLDER = Path(__file__).parent
KEYS = ("name", "value", "unit", "reference", "ratio", "goal", "ok")
MEASURE = "from benchmarks.__main__ import measure; measure({name!r})"

USUAL_LIMIT_S = 900.0
"""Far more than they need on a busy machine; a benchmark that needs more says so."""
GRACE_S = 5.0
"""So long a benchmark that is stopped may end by itself what it started, a display say."""
END_S = 3.0
MOST_LOOKS = 5
"""A process that is ended may just have started another one, which the next look sees."""

MARK = "NEP_STUDIO_BENCHMARK"
"""The variable by which a benchmark's processes are known, also when their parent is gone."""

Figure = dict[str, Any]


def benchmark_names(folder: Path) -> list[str]:
    """Return the modules of a folder that have a function ``run``."""
    return sorted(
        path.stem
        for path in folder.glob("[!_]*.py")
        if "\ndef run(" in path.read_text(encoding="utf-8")
    )


def measure(name: str) -> None:
    """Run one benchmark in this process and print its figures as one line of JSON."""
    figures, sys.stdout = sys.stdout, sys.stderr  # what a benchmark prints is not a figure
    result = importlib.import_module(f"benchmarks.{name}").run()
    print(json.dumps(result), file=figures)


def complete(figure: Figure) -> Figure:
    """Return a figure with all its keys in their order; raise ValueError when it is not usable."""
    missing = [key for key in ("name", "value", "unit") if key not in figure]
    if figure.get("goal") is not None and not isinstance(figure.get("ok"), bool):
        missing.append("ok")
    if missing:
        raise ValueError(f"The figure {figure} lacks {', '.join(missing)}.")
    return {key: figure.get(key) for key in KEYS} | {"ok": figure.get("ok", True)}


def figures_of(name: str) -> list[Figure]:
    """Run one benchmark in a process of its own; one that fails is a figure that is not ok."""
    limit_s = limit_of(FOLDER / f"{name}.py")
    told = outcome_of([sys.executable, "-c", MEASURE.format(name=name)], limit_s)
    failed: Figure = {"name": name, "value": None, "unit": "", "goal": "to run", "ok": False}
    if told.is_late:
        print(f"{name} ran past its {limit_s:g} s, and was ended.", file=sys.stderr, flush=True)
        return [complete(failed | {"goal": f"to end within {limit_s:g} s"})]
    if told.code != 0:
        return [complete(failed)]
    return [complete(figure) for figure in json.loads(told.said)]


def limit_of(path: Path) -> float:
    """The seconds that a benchmark may take: its LIMIT_S, read without running the module."""
    for line in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(line, ast.Assign) and ast.unparse(line.targets[0]) == "LIMIT_S":
            return float(ast.literal_eval(line.value))
    return USUAL_LIMIT_S


@dataclass(frozen=True)
class Outcome:
    """How a benchmark ended: its exit code, what it wrote, whether its time was over before."""

    code: int
    said: str
    is_late: bool = False


def outcome_of(command: list[str], limit_s: float) -> Outcome:
    """Run a program alone and to its end; nothing of it is left, whatever ends it."""
    mark = secrets.token_hex(8)
    with tempfile.TemporaryDirectory(prefix="nep-bench-", ignore_cleanup_errors=True) as folder:
        places = dict.fromkeys(("TMPDIR", "TEMP", "TMP"), folder)
        said = Path(folder) / "figures"  # what it leaves running would hold a pipe open
        with said.open("wb") as output:
            child = subprocess.Popen(
                command,
                cwd=FOLDER.parent,
                env=os.environ | places | {MARK: mark},
                stdin=subprocess.DEVNULL,
                stdout=output,
                start_new_session=os.name == "posix",  # Ctrl-C is for the runner, which ends it
            )
        try:
            code = child.wait(limit_s)
            return Outcome(code, said.read_text(encoding="utf-8"))
        except subprocess.TimeoutExpired:
            return Outcome(1, "", is_late=True)
        finally:
            with undisturbed():
                end_tree(child, mark)


def end_tree(child: subprocess.Popen[bytes], mark: str) -> None:
    """End a benchmark and everything that it started: kindly, then by force."""
    if child.poll() is None and os.name == "posix":
        child.send_signal(signal.SIGINT)  # Python ends what it holds, as after Ctrl-C
        with contextlib.suppress(subprocess.TimeoutExpired):
            child.wait(GRACE_S)
    for look in range(MOST_LOOKS):
        left = marked(mark)
        if not left:
            break
        for process in left:
            with contextlib.suppress(psutil.Error):
                process.kill() if look else process.terminate()
        psutil.wait_procs(left, timeout=END_S)
    if child.poll() is None:
        child.kill()
    child.wait()


def marked(mark: str) -> list[psutil.Process]:
    """The processes with this mark, wherever they stand in the tree."""
    found = []
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error, OSError):
            if process.environ().get(MARK) == mark and process.status() != psutil.STATUS_ZOMBIE:
                found.append(process)
    return found


@contextlib.contextmanager
def undisturbed() -> Iterator[None]:
    """Let no second Ctrl-C interrupt what tidies up."""
    before = {one: signal.signal(one, signal.SIG_IGN) for one in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for one, handler in before.items():
            signal.signal(one, handler)


def _stopped(number: int, _frame: FrameType | None) -> None:
    """End by a signal of the system in an orderly way."""
    raise SystemExit(128 + number)


def table_row(figure: Figure) -> str:
    """Return a figure as one line for people."""
    parts = [f"{figure['name']:<44} {shown(figure['value']):>12} {figure['unit']}"]
    if figure["reference"] is not None:
        parts.append(f"reference {shown(figure['reference'])}")
    if figure["ratio"] is not None:
        parts.append(f"ratio {shown(figure['ratio'])}")
    if figure["goal"] is not None:
        parts.append(f"goal {figure['goal']}: {'met' if figure['ok'] else 'MISSED'}")
    return "   ".join(parts)


def shown(value: object) -> str:
    """Return a number with four digits that count, a dash for none, anything else as it is."""
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def all_figures(names: list[str]) -> Iterator[Figure]:
    """Measure benchmarks one after the other, giving each figure when it is there."""
    for name in names:
        yield from figures_of(name)


def main(arguments: list[str]) -> int:
    """Measure what the command line names, or all; return 1 when a goal was missed."""
    known = benchmark_names(FOLDER)
    parser = argparse.ArgumentParser(prog="dev.py bench", description="Measure against references.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"any of: {', '.join(known)}")
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    parser.add_argument(
        "--with-peers",
        action="store_true",
        help="measure other programs too, which are fetched for it: Blockly, Orange Canvas",
    )
    options = parser.parse_args(arguments)
    unknown = sorted(set(options.names) - set(known))
    if unknown:
        parser.error(f"no benchmark is called {', '.join(unknown)}; there are: {', '.join(known)}")
    if options.with_peers:
        peers.ask_for_peers()
    show = json.dumps if options.json else table_row
    is_all_ok = True
    for figure in all_figures(options.names or known):
        print(show(figure), flush=True)
        is_all_ok &= figure["ok"]
    return 0 if is_all_ok else 1


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, _stopped)
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)
