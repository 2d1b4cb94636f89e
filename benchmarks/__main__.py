"""Run benchmarks, each in a process of its own, and say which goals were missed.

A benchmark is a module of this folder with a function ``run() -> list[dict]``. Each dict is one
figure: ``name``, ``value``, ``unit`` and, where there are any, ``reference`` (the value of the
reference), ``ratio`` (value / reference), ``goal`` (in words: "at most 1.2") with ``ok``.
"""

from __future__ import annotations

import argparse
import importlib
import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from . import peers

FOLDER = Path(__file__).parent
KEYS = ("name", "value", "unit", "reference", "ratio", "goal", "ok")
MEASURE = "from benchmarks.__main__ import measure; measure({name!r})"

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
    command = [sys.executable, "-c", MEASURE.format(name=name)]
    child = subprocess.run(command, cwd=FOLDER.parent, stdout=subprocess.PIPE, text=True)
    failed = {"name": name, "value": None, "unit": "", "goal": "to run", "ok": False}
    if child.returncode != 0:
        return [complete(failed)]
    return [complete(figure) for figure in json.loads(child.stdout)]


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
    sys.exit(main(sys.argv[1:]))
