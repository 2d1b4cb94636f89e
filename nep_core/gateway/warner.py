"""Warns at most once a second, so that a flood of faults is no flood of words."""

from __future__ import annotations

import logging
import time

log = logging.getLogger(__name__)

WARN_S = 1.0


class Warner:
    """Any thread."""

    def __init__(self) -> None:
        self._next_s = 0.0

    def __call__(self, sentence: str) -> None:
        """Warn, unless it is too soon."""
        if time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + WARN_S
            log.warning("%s", sentence)
