"""Work in the background whose results come back to the thread of Qt."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from functools import cache
from typing import TypeVar

from PySide6.QtCore import QCoreApplication, QObject, Qt, Signal

Result = TypeVar("Result")


class Background(QObject):
    """Does what takes a while in threads of their own; what comes of it is told in this one's.

    Nothing is told any more once its parent has gone.
    """

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._post = _post()
        self._gone = threading.Event()
        self.destroyed.connect(self._gone.set)

    def post(self, do: Callable[[], object]) -> None:
        """Do this in the thread of Qt, soon and in order; from any thread."""

        def do_if_wanted() -> None:
            if not self._gone.is_set():
                do()

        with contextlib.suppress(RuntimeError):  # the program ends
            self._post.asked.emit(do_if_wanted)

    def start(
        self, work: Callable[[], Result], then: Callable[[Result], object], *, name: str
    ) -> threading.Thread:
        """Do ``work`` beside everything else, and ``then`` tell what it gave."""

        def run() -> None:
            result = work()
            self.post(lambda: then(result))

        thread = threading.Thread(target=run, name=f"nep-studio-{name}", daemon=True)
        thread.start()
        return thread


class _Post(QObject):
    """Lives as long as the program: a thread may use it while a dialog is being thrown away."""

    asked = Signal(object)

    def __init__(self) -> None:
        super().__init__(QCoreApplication.instance())
        self.asked.connect(self._on_asked, Qt.ConnectionType.QueuedConnection)

    def _on_asked(self, do: Callable[[], None]) -> None:
        do()


@cache
def _post() -> _Post:
    """Made by the first who asks, in the thread of Qt."""
    return _Post()
