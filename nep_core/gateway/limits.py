"""How many lines of the original's programs this process can serve: each takes several files."""

from __future__ import annotations

import contextlib
import sys

FILES_A_LINE = 16
"""Sockets, their wakers and monitors, and a few connections."""
FILES_OF_OTHERS = 128
WANTED_FILES = 8192


def lines_allowed() -> int:
    """How many lines there may be; first asks the system for room."""
    if sys.platform == "win32":
        return WANTED_FILES // FILES_A_LINE
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = WANTED_FILES if hard == resource.RLIM_INFINITY else min(WANTED_FILES, hard)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        with contextlib.suppress(OSError, ValueError):  # macOS has a further limit of its own
            resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
            soft = wanted
    files = WANTED_FILES if soft == resource.RLIM_INFINITY else min(soft, WANTED_FILES)
    return max(1, (files - FILES_OF_OTHERS) // FILES_A_LINE)
