"""Long work in slices: a generator that yields wherever it may rest, run a little at a time.

All of it runs in the thread of whoever takes the slices, so it may read what that thread changes
between two of them; who changes it gives the work up, and begins anew.
"""

from __future__ import annotations

import time
from collections.abc import Generator
from typing import Generic, TypeVar

Result = TypeVar("Result")
Steps = Generator[None, None, Result]
"""Work that yields wherever it may rest, and returns what comes of it."""


class Sliced(Generic[Result]):
    """Work that is done in slices; ``run`` raises what the work raises."""

    result: Result
    """What came of it, once it is over."""

    def __init__(self, steps: Steps[Result]) -> None:
        self._steps = steps
        self.is_over = False

    def run(self, slice_s: float) -> bool:
        """Work for a slice, at least to the next rest; whether it is over."""
        end_s = time.perf_counter() + slice_s
        try:
            next(self._steps)
            while time.perf_counter() < end_s:
                next(self._steps)
        except StopIteration as end:
            self.result, self.is_over = end.value, True
        return self.is_over

    def cancel(self) -> None:
        """Give the work up where it rests."""
        self._steps.close()


def at_once(steps: Steps[Result]) -> Result:
    """Do all of a work without a rest."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            result: Result = end.value
            return result
