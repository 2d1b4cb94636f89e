"""Ends with 0 when git is sure that nothing of packaging changed: .ci/run then freezes nothing.

What counts as changed: what is not committed, and what differs from the commit that the variable
NEP_CI_BASE names; without it, what was committed in the last 24 hours.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PLACES = (
    *("build.spec", "packaging", "tests/packaging", "pyproject.toml", "dev.py", "dev_system.py"),
    *(".ci/run", ".github/workflows/release.yml"),
)
"""Files and folders that decide how the program is frozen and packed."""
RECENT_S = 24 * 3600.0


def is_unchanged(root: Path, base: str, now_s: float) -> bool:
    """Whether the places are as they were; raises when git cannot tell.

    A history that was cut off begins with a commit of all files, which errs on the safe side.
    """
    if _git(root, "status", "--porcelain", "--", *PLACES):
        return False
    if base:
        return not _git(root, "diff", "--name-only", base, "HEAD", "--", *PLACES)
    committed_s = float(_git(root, "log", "-1", "--format=%ct", "--", *PLACES))
    return now_s - committed_s > RECENT_S


def _git(root: Path, *words: str) -> str:
    command = ["git", "-C", str(root), *words]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main() -> int:
    """Tell it; the exit code is 1 also when nobody knows."""
    try:
        unchanged = is_unchanged(ROOT, os.environ.get("NEP_CI_BASE", ""), time.time())
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        print(f"Whether packaging changed is not known ({error}).", file=sys.stderr)
        return 1
    print(f"Packaging is {'unchanged' if unchanged else 'changed'}.", file=sys.stderr)
    return 0 if unchanged else 1


if __name__ == "__main__":
    sys.exit(main())
