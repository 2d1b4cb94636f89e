"""Threads that call what programs gave: one that keeps the order, and a few for what blocks.

All end with the program, even when a call never returns.
"""

from __future__ import annotations

import logging
import queue
import threading
from collections.abc import Callable

log = logging.getLogger(__name__)

Job = Callable[[], object]


class Turns:
    """Does jobs in threads that start when they are needed, at most ``most`` at once."""

    def __init__(self, name: str, most: int = 1) -> None:
        self._name = name
        self._most = most
        self._jobs: queue.SimpleQueue[tuple[Job, bool] | None] = queue.SimpleQueue()
        self._lock = threading.Lock()
        self._threads: list[threading.Thread] = []
        self._busy = 0
        self._is_closed = False

    def add(self, job: Job, *, is_owed: bool = False) -> None:
        """Do this as soon as a thread is free; with one thread, in the order of adding.

        ``is_owed``: even if ``close`` comes before its turn, since somebody waits for it.
        """
        with self._lock:
            if self._is_closed:
                return
            self._busy += 1
            if self._busy > len(self._threads) < self._most:
                name = f"{self._name}-{len(self._threads)}"
                thread = threading.Thread(target=self._work, name=name, daemon=True)
                self._threads.append(thread)
                thread.start()
        self._jobs.put((job, is_owed))

    def close(self) -> None:
        """Do no more jobs but what is owed; the one under way goes on."""
        with self._lock:
            self._is_closed = True
            for _ in self._threads:
                self._jobs.put(None)

    def is_here(self) -> bool:
        """Whether the caller is one of these threads."""
        return threading.current_thread() in self._threads

    def _work(self) -> None:
        while (next_one := self._jobs.get()) is not None:
            job, is_owed = next_one
            try:
                if is_owed or not self._is_closed:
                    job()
            except Exception:
                log.exception("a call that %s made failed", self._name)
            with self._lock:
                self._busy -= 1
