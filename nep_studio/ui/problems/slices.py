"""Long work in short slices on the main thread: it rests whenever its slice is over."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator, Mapping
from typing import Generic, TypeVar

Result = TypeVar("Result")
Key = TypeVar("Key")
Value = TypeVar("Value")


class Cancelled(Exception):
    """The work is not wanted any more."""


class SlicedCall(Generic[Result]):
    """A call that runs in a thread of its own, but only while ``run`` is waiting for it.

    So it never runs at the same time as the main thread, and may read what that changes between
    two calls of ``run``; the caller cancels it when something has changed. The work calls
    ``rest`` often; that returns at once until the slice is over.
    """

    def __init__(self, work: Callable[[Callable[[], None]], Result]) -> None:
        self._work = work
        self._may_work, self._rests = threading.Semaphore(0), threading.Semaphore(0)
        self._end_of_slice = 0.0
        self._is_cancelled = False
        self._result: list[Result] = []
        self._error: BaseException | None = None
        self.is_over = False
        self._thread = threading.Thread(target=self._main, name="slices", daemon=True)
        self._thread.start()

    def run(self, slice_s: float) -> bool:
        """Let it work for a slice; whether it is over."""
        if not self.is_over:
            self._end_of_slice = time.perf_counter() + slice_s
            self._may_work.release()
            self._rests.acquire()
        return self.is_over

    def result(self) -> Result:
        """What the call gave, or raised."""
        if self._error is not None:
            raise self._error
        return self._result[0]

    def cancel(self) -> None:
        """End the work where it rests."""
        self._is_cancelled = True
        if not self.is_over:
            self._may_work.release()
        self._thread.join()

    def rest(self) -> None:
        """Rest when the slice is over; raises Cancelled when the work is not wanted any more."""
        if time.perf_counter() >= self._end_of_slice:
            self._rests.release()
            self._may_work.acquire()
        if self._is_cancelled:
            raise Cancelled

    def _main(self) -> None:
        self._may_work.acquire()
        try:
            if not self._is_cancelled:
                self._result.append(self._work(self.rest))
        except Cancelled:
            pass
        except BaseException as error:
            self._error = error
        self.is_over = True
        self._rests.release()


class RestingMapping(Mapping[Key, Value]):
    """A mapping in which each look-up is a place to rest."""

    def __init__(self, values: Mapping[Key, Value], rest: Callable[[], None]) -> None:
        self._values, self._rest = values, rest

    def __getitem__(self, key: Key) -> Value:
        self._rest()
        return self._values[key]

    def __iter__(self) -> Iterator[Key]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)
