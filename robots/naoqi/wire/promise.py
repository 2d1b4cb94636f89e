"""Results that come later: a service promises one, and whoever asked is told when it is there."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Any

from faults import Words

from .errors import CallCancelled, CallFailed, NaoqiError, NoAnswer

log = logging.getLogger(__name__)

OnDone = Callable[["Pending"], None]


class Pending:
    """A result that comes later: a value, an error, or nothing since it was given up.

    ``failure`` is the error; both it and ``value`` mean something only when ``done``.
    """

    def __init__(self, on_cancel: Callable[[], Any] | None = None) -> None:
        self.done = False
        self.value: Any = None
        self.failure: NaoqiError | None = None
        self._lock = threading.Lock()
        self._waiting: list[OnDone] = []
        self._is_there: threading.Lock | None = None
        self._on_cancel = on_cancel

    def settle(self, value: Any = None, failure: NaoqiError | None = None) -> bool:
        """End it and tell who waits; False when it had ended before, and nothing has changed."""
        waiting = self.settle_quietly(value, failure)
        for on_done in waiting or ():
            self._tell(on_done)
        return waiting is not None

    def settle_quietly(self, value: Any, failure: NaoqiError | None) -> list[OnDone] | None:
        """End it; return who is to be told of it, None when it had ended before."""
        with self._lock:
            if self.done:
                return None
            self.value, self.failure, self.done = value, failure, True
            waiting, self._waiting = self._waiting, []
        if self._is_there is not None:
            self._is_there.release()
        return waiting

    @property
    def on_done(self) -> OnDone | None:
        """Who was set last to be called when it has ended."""
        return self._waiting[-1] if self._waiting else None

    @on_done.setter
    def on_done(self, called: OnDone) -> None:
        self.when_done(called)

    def when_done(self, on_done: OnDone) -> None:
        """Call this with the future when it has ended; at once when it already has."""
        with self._lock:
            if not self.done:
                self._waiting.append(on_done)
                return
        self._tell(on_done)

    def cancel(self) -> None:
        """Ask whoever works on it to give it up; it ends when they have."""
        if self.done or self._on_cancel is None:
            return
        try:
            self._on_cancel()
        except Exception:
            log.exception("a call could not be given up")

    def wait(self, timeout_s: float) -> bool:
        """Wait until it has ended; False when it has not in this time."""
        with self._lock:
            if self.done:
                return True
            if self._is_there is None:
                self._is_there = threading.Lock()
                self._is_there.acquire()
            is_there = self._is_there
        if not is_there.acquire(timeout=max(0.0, timeout_s)):
            return self.done
        is_there.release()  # another thread may wait too
        return True

    def result(self, timeout_s: float) -> Any:
        """Wait for the value. Raises its failure, or NoAnswer when it is not there in time."""
        if not self.wait(timeout_s):
            raise NoAnswer("There was no result within {timeout_s} s.", timeout_s=f"{timeout_s:g}")
        if self.failure is not None:
            raise self.failure
        return self.value

    def _tell(self, on_done: OnDone) -> None:
        try:
            on_done(self)
        except Exception:
            log.exception("what waited for a result failed")


class Promise:
    """A service method returns ``promise.future`` to answer later; no thread waits meanwhile.

    ``on_cancel`` is called when the caller gives up; end with ``cancelled()`` then, or go on.
    """

    def __init__(self, on_cancel: Callable[[], Any] | None = None) -> None:
        self.future = Pending(self._cancel)
        self.on_cancel = on_cancel
        self.is_cancelled = False

    def set(self, value: Any = None) -> None:
        """The result is there, or will be when another promise is kept."""
        if isinstance(value, Promise):
            value = value.future
        if isinstance(value, Pending):
            self._follow(value)
        else:
            self.future.settle(value)

    def fail(self, sentence: Words) -> None:
        """It could not be done; the caller gets this sentence."""
        self.future.settle(failure=CallFailed(sentence))

    def cancelled(self) -> None:
        """It was given up, as the caller wanted."""
        self.future.settle(failure=CallCancelled("The call was cancelled."))

    def _follow(self, other: Pending) -> None:
        self.on_cancel = other.cancel
        if self.is_cancelled:
            other.cancel()

        def settle(done: Pending) -> None:
            self.future.settle(done.value, done.failure)

        other.when_done(settle)

    def _cancel(self) -> None:
        self.is_cancelled = True
        if self.on_cancel is not None:
            self.on_cancel()
