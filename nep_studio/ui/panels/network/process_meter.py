"""How much of the computer a process takes, together with all that it started."""

from __future__ import annotations

import contextlib

import psutil

from nep_core.process_tree import descendants

from .seen import Use


class ProcessMeter:
    """Measures processes by their number; a share of the processor needs a measurement before."""

    def __init__(self) -> None:
        self._known: dict[int, psutil.Process] = {}

    def measure(self, pid: int) -> Use | None:
        """What a process and its descendants take; None when it is gone or not ours to see."""
        root = self._process(pid)
        if root is None:
            return None
        parts = [root, *(self._keep(child) for child in descendants(pid))]
        cpu_percent, memory_bytes = 0.0, 0
        for process in parts:
            with contextlib.suppress(psutil.Error), process.oneshot():
                cpu_percent += process.cpu_percent(None)
                memory_bytes += process.memory_info().rss
        return Use(cpu_percent, memory_bytes) if memory_bytes else None

    def keep_only_running(self) -> None:
        """Forget the processes that have ended."""
        self._known = {pid: one for pid, one in self._known.items() if one.is_running()}

    def _process(self, pid: int) -> psutil.Process | None:
        with contextlib.suppress(psutil.Error, ValueError):
            known = self._known.get(pid)
            if known is not None and known.is_running():
                return known
            return self._keep(psutil.Process(pid))
        return None

    def _keep(self, process: psutil.Process) -> psutil.Process:
        """The same object for the same process each time: it remembers the last measurement."""
        known = self._known.get(process.pid)
        if known is None or known != process:
            self._known[process.pid] = known = process
        return known
