"""Which programs of this computer have ended."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterable

import psutil

from nep_core.registry import Registration


class Processes:
    """Sees the processes of programs that are on this computer, as far as it can be known.

    ``key`` is this computer's in an opened network: two computers may have one host name. A
    program whose process is not to be seen when it registers is elsewhere, in a container for
    example; its lease tells when it is gone, as it does for a number that another process has by
    now. Each process is remembered: to look again is then three times quicker.
    """

    def __init__(self, key: str = "") -> None:
        self._here = socket.gethostname(), key
        self._known: dict[int, psutil.Process] = {}
        self._elsewhere: set[str] = set()

    def register(self, told: Registration) -> None:
        """See whether a program that says now that it lives has a process here."""
        self._elsewhere.discard(told.instance)
        if self.has_ended(told):
            self._elsewhere.add(told.instance)

    def has_ended(self, told: Registration) -> bool:
        """Whether the program's process has ended; False when that cannot be seen."""
        is_here = (told.host, told.key) == self._here and told.instance not in self._elsewhere
        return is_here and self._is_over(told.pid)

    def keep_only(self, programs: Iterable[Registration]) -> None:
        """Forget all others."""
        kept = list(programs)
        pids = {told.pid for told in kept}
        self._known = {pid: process for pid, process in self._known.items() if pid in pids}
        self._elsewhere &= {told.instance for told in kept}

    def _is_over(self, pid: int) -> bool:
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
