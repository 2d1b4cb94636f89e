"""Brings what several threads hear into one thread of Qt, in batches that it can take."""

from __future__ import annotations

import threading
import time
from collections import deque
from typing import Any

from PySide6.QtCore import QThread, Signal

BATCHES_HZ = 30
LARGEST_BATCH = 300
"""So many messages are passed on at once: a window can deal with them between two frames."""

MOST_WAITING = 5000
"""So many messages wait for a thread that is busy; the oldest of more are dropped and counted."""


class Monitor(QThread):
    """Passes on what was heard: ``arrived`` gives a list, at most 30 times a second.

    The next batch is only sent when the last one was taken, so that a busy window is not flooded:
    who is connected to ``arrived`` calls ``taken()`` when it is done.
    """

    arrived = Signal(list)

    def __init__(self, batches_hz: float = BATCHES_HZ, most_waiting: int = MOST_WAITING) -> None:
        super().__init__()
        self.dropped = 0
        self._pause_s = 1 / batches_hz
        self._waiting: deque[Any] = deque()
        self._most = most_waiting
        self._lock = threading.Lock()
        self._came = threading.Event()
        self._may_send = threading.Event()
        self._may_send.set()
        self._is_ending = False

    def hear(self, item: object) -> None:
        """Take in one item; from any thread."""
        with self._lock:
            self._waiting.append(item)
            if len(self._waiting) > self._most:
                self._waiting.popleft()
                self.dropped += 1
        self._came.set()

    def taken(self) -> None:
        """The last batch has been dealt with."""
        self._may_send.set()

    def end(self) -> None:
        """End the thread, and wait for it."""
        if self._is_ending:
            return
        self._is_ending = True
        self._came.set()
        self._may_send.set()
        self.wait()

    def run(self) -> None:
        """Send batches until the end."""
        while not self._is_ending:
            self._came.wait()
            self._may_send.wait()
            self._came.clear()
            with self._lock:
                count = min(len(self._waiting), LARGEST_BATCH)
                batch = [self._waiting.popleft() for _ in range(count)]
                if self._waiting:
                    self._came.set()
            if batch and not self._is_ending:
                self._may_send.clear()
                self.arrived.emit(batch)
                time.sleep(self._pause_s)
