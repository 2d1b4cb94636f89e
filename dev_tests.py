"""Runs all tests; the few that failed beside others are tried once more, by themselves."""

from __future__ import annotations

import json
import os
from pathlib import Path

from dev_system import call, say

EVERY_TEST = ["--numprocesses", str(min((os.cpu_count() or 1) + 2, 4)), "--dist", "worksteal"]
"""All tests side by side: most of the stories' time is waiting for what robots and people do."""

TESTS_FAILED = 1
"""pytest's exit code."""
MOST_AGAIN = 5
"""More than that have a reason that they share."""

AGAIN = """\
{names}
failed beside the others. Real processes share a busy machine here, so they are tried once more,
by themselves."""
MEND = """\
{names}
failed beside the others and passed by themselves. They count as passed. What they wait for is
probably not what they mean, or something outlives the test before: please mend them."""


def run_all(python: str, root: Path, arguments: list[str]) -> int:
    """Run the tests of a folder with these arguments of pytest; the exit code."""
    code = call([python, "-m", "pytest", *arguments])
    failed = failed_tests(root)
    if code != TESTS_FAILED or not 0 < len(failed) <= MOST_AGAIN:
        return code
    names = "\n".join(failed)
    say(AGAIN.format(names=names))
    code = call([python, "-m", "pytest", "--last-failed", "--last-failed-no-failures", "none"])
    if code == 0:
        say(MEND.format(names=names))
    return code


def failed_tests(root: Path) -> list[str]:
    """The tests that failed in the last run."""
    try:
        found = json.loads((root / ".pytest_cache/v/cache/lastfailed").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return []
    return sorted(found)
