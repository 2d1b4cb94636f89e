"""Searches the help; what is searched is read a little at a time, so that nothing waits."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

from PySide6.QtCore import QObject, QTimer, Signal

from nep_studio.help.index import Findable, Index

from .book import Book

SLICE_S = 0.008


class Searching(QObject):
    """An index that grows while nobody needs the window. ``found`` brings hits and the words."""

    found = Signal(list, str)

    def __init__(self, book: Callable[[], Book], parent: QObject) -> None:
        super().__init__(parent)
        self._book = book
        self._index: Index | None = None
        self._waiting: Iterator[Findable] | None = None
        self._asked = ""
        self._later = QTimer(self, singleShot=True, interval=0)
        self._later.timeout.connect(self._go_on)

    @property
    def is_whole(self) -> bool:
        """Whether all pages have been read."""
        return self._index is not None and self._waiting is None

    def begin(self) -> None:
        """Begin to read the pages, if nobody has yet."""
        if self._index is None:
            book = self._book()
            self._index, self._waiting = book.new_index(), book.findables()
            self._later.start()

    def search(self, typed: str) -> None:
        """Tell what is found so far, and again when all pages have been read."""
        self.begin()
        self._asked = typed
        self._tell()

    def finish(self, typed: str) -> None:
        """Read what is left at once, and tell what is found."""
        self.begin()
        self._asked = typed
        while self._waiting is not None:
            self._go_on()
        self._tell()

    def _go_on(self) -> None:
        until_s = time.perf_counter() + SLICE_S
        while self._waiting is not None and time.perf_counter() < until_s:
            findable = next(self._waiting, None)
            if findable is None or self._index is None:
                self._waiting = None
            else:
                self._index.add(findable)
        if self._waiting is not None:
            self._later.start()
        elif self._asked:
            self._tell()

    def _tell(self) -> None:
        if self._index is not None:
            self.found.emit(self._index.search(self._asked), self._asked)
