"""The ends of logs, and the last crash, for a report."""

from __future__ import annotations

import re
import time
from pathlib import Path

from nep_core.cli.finding import Finding
from nep_studio.safe_mode import CRASHES
from nep_studio.support_report import Part

LAST_LINES = 60
LAST_BYTES = 40_000
LONGEST_LINE = 400
CRASH_LINES = 60
BEGINS = re.compile(r"^(Fatal Python error|Windows fatal exception)")
TRACE = re.compile(r"^\d{4}-\d\d-\d\d .* (ERROR|CRITICAL) ")
RECORD = re.compile(r"^\d{4}-\d\d-\d\d ")


def log_part(path: Path) -> Part:
    """The last lines of a log."""
    lines = last_lines(path)
    told = () if lines else (Finding("log", "note", "nothing is written there"),)
    return Part(f"Log {path.name}", told, tuple(lines[-LAST_LINES:]))


def crash_part(folder: Path) -> Part:
    """When the program last ended by a crash, and where; and its last error."""
    path = folder / CRASHES
    crash = _last(last_lines(path), BEGINS)
    findings = [Finding("crash", "ok", "none is known")]
    if crash:
        findings = [Finding("crash", "note", f"the last one: {_time(path)}")]
    log = folder / "nep-studio.log"
    error = _last(last_lines(log), TRACE, RECORD)
    if error:
        findings.append(Finding("error", "note", "the last one is below"))
    lines = [*crash, *([""] if crash and error else []), *error]
    return Part("Last crash", tuple(findings), tuple(lines))


def last_lines(path: Path) -> list[str]:
    """The end of a file, without the line of which only a part was read."""
    try:
        with path.open("rb") as file:
            size = file.seek(0, 2)
            file.seek(max(0, size - LAST_BYTES))
            lines = file.read().decode("utf-8", "replace").splitlines()
    except OSError:
        return []
    whole = lines[1:] if size > LAST_BYTES else lines
    return [line[:LONGEST_LINE] for line in whole]


def _last(
    lines: list[str], begin: re.Pattern[str], end: re.Pattern[str] | None = None
) -> list[str]:
    """The lines from the last beginning on, up to an end behind it."""
    starts = [number for number, line in enumerate(lines) if begin.match(line)]
    if not starts:
        return []
    told = lines[starts[-1] :]
    if end is not None:
        after = (number for number, line in enumerate(told) if number and end.match(line))
        told = told[: next(after, len(told))]
    return told[:CRASH_LINES]


def _time(path: Path) -> str:
    return time.strftime("%Y-%m-%d %H:%M", time.localtime(path.stat().st_mtime))
