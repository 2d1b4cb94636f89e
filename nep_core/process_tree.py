"""The processes that a process started, as far as the system lets us see and end them."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable

import psutil


def descendants(pid: int) -> frozenset[psutil.Process]:
    """The processes that a running one started, and theirs."""
    with contextlib.suppress(psutil.Error):
        return frozenset(psutil.Process(pid).children(recursive=True))
    return frozenset()


def orphans(pid: int, since_s: float) -> frozenset[psutil.Process]:
    """What a process that is gone has started since then (s, as time.time()), and theirs.

    Only Windows still knows the parent of a process when it is gone.
    """
    children = [
        process
        for process in psutil.process_iter(["ppid", "create_time"])
        if process.info["ppid"] == pid and (process.info["create_time"] or 0.0) >= since_s
    ]
    return frozenset(children).union(*(descendants(child.pid) for child in children))


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
