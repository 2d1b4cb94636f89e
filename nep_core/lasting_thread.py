"""The one thread in which processes are started.

Linux tells a child of its parent's end when the *thread* ends that started it; so it must be one
that lives as long as the program.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from queue import SimpleQueue
from typing import Any, TypeVar

T = TypeVar("T")

_lock = threading.Lock()
_thread: threading.Thread | None = None
_wishes: SimpleQueue[tuple[Callable[[], Any], Future[Any]]] = SimpleQueue()


def in_lasting_thread(start: Callable[[], T]) -> T:
    """Call ``start`` in that thread; what it returns or raises."""
    result: Future[T] = Future()
    _live()
    _wishes.put((start, result))
    return result.result()


def _live() -> None:
    global _thread, _wishes
    with _lock:
        if _thread is None or not _thread.is_alive():  # a fork of this program has no threads
            _wishes = SimpleQueue()
            _thread = threading.Thread(target=_work, args=(_wishes,), name="nep-start", daemon=True)
            _thread.start()


def _work(wishes: SimpleQueue[tuple[Callable[[], Any], Future[Any]]]) -> None:
    while True:
        start, result = wishes.get()
        try:
            result.set_result(start())
        except BaseException as error:
            result.set_exception(error)
        del start, result  # a process that nobody waits for any more loses its life line
