"""Ctrl-C and its kin: they end a session once, and neither in the middle of a start nor a stop."""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Iterator

from nep_core.processes.node import STOP_SIGNALS


def interrupt_once() -> None:
    """Let the first signal raise KeyboardInterrupt and all that follow do nothing."""
    for number in STOP_SIGNALS:
        signal.signal(number, _interrupt)


@contextlib.contextmanager
def undisturbed() -> Iterator[list[int]]:
    """Do no more than note the signals meanwhile, in this list; only the main thread gets any."""
    noted: list[int] = []
    if threading.current_thread() is not threading.main_thread():
        yield noted
        return
    before = {
        number: signal.signal(number, lambda n, _: noted.append(n)) for number in STOP_SIGNALS
    }
    try:
        yield noted
    finally:
        for number, answer in before.items():
            signal.signal(number, answer or signal.SIG_DFL)


@contextlib.contextmanager
def postponed() -> Iterator[None]:
    """Answer a signal afterwards: a process that was just started must be known to be stopped."""
    with undisturbed() as noted:
        yield
    if noted:
        signal.raise_signal(noted[0])


def _interrupt(*_signal: object) -> None:
    for number in STOP_SIGNALS:
        signal.signal(number, _ignore)
    raise KeyboardInterrupt


def _ignore(*_signal: object) -> None:
    """Do nothing; SIG_IGN would do it for the child processes, too."""
