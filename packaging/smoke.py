"""Does with the frozen program what a person would, where there is no Python, and compares.

``python packaging/smoke.py [PROGRAM] [--report FILE.json] [--picture FILE.png]``: run it with the
Python of the environment that the program was frozen in; what the source version does is the
reference. The exit code is 1 when something is not as it should be.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import parts

sys.path.insert(0, str(parts.ROOT))

import smoke_nodes
import smoke_stories
from smoke_program import Figures, Program, clean_environment

Check = Callable[[Program, Program, Path], Figures]
"""It is given the frozen program, the program from source, and a folder of its own."""

TIMED: dict[str, Check] = {
    "window": smoke_stories.window,
    "nodes": smoke_nodes.nodes,
    "own_nodes": smoke_nodes.own_nodes,
    "trainer": smoke_nodes.trainer,
}
"""Run one after the other: how long something takes is part of what they tell."""
UNTIMED: dict[str, Check] = {
    "karate": smoke_stories.karate,
    "training": smoke_nodes.training,
    "version": smoke_stories.version,
    "command_line": smoke_stories.command_line,
    "code": smoke_stories.code,
    "own_program": smoke_nodes.own_program,
}
"""Run side by side, the longest first."""
CHECKS = TIMED | UNTIMED


def default_program() -> Path:
    """Where packaging/freeze.py puts the program."""
    dist = parts.ROOT / "dist"
    return {
        "win32": dist / parts.NAME / f"{parts.NAME}.exe",
        "darwin": dist / "NEP Studio.app" / "Contents" / "MacOS" / parts.NAME,
    }.get(sys.platform, dist / parts.NAME / parts.NAME)


def run(frozen: Program, source: Program, names: list[str], folder: Path) -> dict[str, Any]:
    """Run these checks; by name the figures, or why it failed."""

    def try_one(name: str) -> tuple[str, dict[str, Any]]:
        return name, check(CHECKS[name], name, frozen, source, folder)

    report = dict(map(try_one, (name for name in TIMED if name in names)))
    with ThreadPoolExecutor(max_workers=2) as side_by_side:
        report |= dict(side_by_side.map(try_one, (name for name in UNTIMED if name in names)))
    return report


def check(what: Check, name: str, frozen: Program, source: Program, folder: Path) -> dict[str, Any]:
    """Run one check in a new folder of its name, and print what it told, or why it failed."""
    place = folder / name
    place.mkdir()
    started_s = time.monotonic()
    try:
        found = {"ok": True, **what(frozen, source, place)}
    except Exception as error:  # the other checks tell more about it
        traceback.print_exc()
        found = {"ok": False, "why": f"{type(error).__name__}: {error}"}
    found["took_s"] = round(time.monotonic() - started_s, 2)
    print(f"{name:14}{'ok' if found['ok'] else 'FAILED':8}{json.dumps(found)}", flush=True)
    return found


def main() -> int:
    """Run what is asked for; 1 when something is not as it should be."""
    asked = _parser().parse_args()
    with tempfile.TemporaryDirectory(prefix="nep-smoke-", ignore_cleanup_errors=True) as made:
        folder = Path(made).resolve()
        os.chdir(folder)
        environment = clean_environment(folder)
        os.environ.clear()
        os.environ.update(environment)
        frozen = Program((str(asked.program.resolve()),), is_frozen=True)
        source = Program((sys.executable, "-P", "-m", "nep_studio"), is_frozen=False)
        report = run(frozen, source, asked.only or list(CHECKS), folder)
        if asked.picture and (folder / "window" / "frozen.png").is_file():
            asked.picture.write_bytes((folder / "window" / "frozen.png").read_bytes())
    is_well = all(found["ok"] for found in report.values())
    if asked.report:
        whole = {"ok": is_well, "system": sys.platform, "checks": report}
        asked.report.write_text(json.dumps(whole, indent=1) + "\n", encoding="utf-8")
    return 0 if is_well else 1


def _parser() -> argparse.ArgumentParser:
    here = Path.cwd()  # the checks have another folder
    parser = argparse.ArgumentParser(description="Try the frozen program.")
    parser.add_argument("program", type=Path, nargs="?", default=default_program())
    parser.add_argument("--report", type=lambda word: here / word, metavar="FILE.json")
    parser.add_argument("--picture", type=lambda word: here / word, metavar="FILE.png")
    parser.add_argument("--only", action="append", choices=CHECKS, metavar="CHECK")
    return parser


if __name__ == "__main__":
    sys.exit(main())
