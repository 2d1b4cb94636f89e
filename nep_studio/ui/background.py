"""Work in the background whose results come back to the thread of Qt."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from typing import TypeVar

from PySide6.QtCore import QObject, Qt, Signal

Result = TypeVar("Result")


class Background(QObject):
    """Does what takes a while in threads of their own; what comes of it is told in this one's.

    Nothing is told any more once its parent has gone.
    """

    _posted = Signal(object)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._posted.connect(self._on_posted, Qt.ConnectionType.QueuedConnection)

    def post(self, do: Callable[[], None]) -> None:
        """Do this in the thread of Qt, soon and in order; from any thread."""
        with contextlib.suppress(RuntimeError):  # the parent has gone meanwhile
            self._posted.emit(do)

    def start(
        self, work: Callable[[], Result], then: Callable[[Result], None], *, name: str
    ) -> threading.Thread:
        """Do ``work`` beside everything else, and ``then`` tell what it gave."""

        def run() -> None:
            result = work()
            self.post(lambda: then(result))

        thread = threading.Thread(target=run, name=f"nep-studio-{name}", daemon=True)
        thread.start()
        return thread

    def _on_posted(self, do: Callable[[], None]) -> None:
        do()
