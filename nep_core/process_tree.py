"""The processes that a process started, as far as the system lets us see and end them."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable

import psutil

VARIABLE = "NEP_TREE"
"""In the environment of a launched process and all that it starts: the marks of those it is of."""


def descendants(pid: int) -> frozenset[psutil.Process]:
    """The processes that a running one started, and theirs."""
    with contextlib.suppress(psutil.Error):
        return frozenset(psutil.Process(pid).children(recursive=True))
    return frozenset()


def marked(marks: str) -> frozenset[psutil.Process]:
    """Other processes with the last of these marks, also those whose parents are long gone.

    That is how one is found that went into the background, into a group of its own.
    """
    mark = marks.rpartition(" ")[2]
    return frozenset(
        process
        for process in psutil.process_iter()
        if mark and process.pid != os.getpid() and mark in _marks(process)
    )


def _marks(process: psutil.Process) -> list[str]:
    with contextlib.suppress(psutil.Error, OSError):  # another user's, or gone
        return str(process.environ().get(VARIABLE, "")).split()
    return []


def is_in_tree(pid: int, root_pid: int) -> bool:
    """Whether ``pid`` is ``root_pid``, or was started by it or by one that it started."""
    if pid == root_pid:
        return True
    with contextlib.suppress(psutil.Error, ValueError):
        return root_pid in [parent.pid for parent in psutil.Process(pid).parents()]
    return False


def kill(processes: Iterable[psutil.Process]) -> None:
    """End those that still run and that we may end; never another with the same number."""
    for process in processes:
        with contextlib.suppress(psutil.Error):
            process.kill()
