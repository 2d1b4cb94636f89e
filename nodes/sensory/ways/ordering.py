"""Puts numbered messages that overtook each other back into their order."""

from __future__ import annotations

from typing import Generic, TypeVar

T = TypeVar("T")

_MOST_HELD = 4
_LONGEST_HELD_S = 0.4


class Ordering(Generic[T]):
    """Holds a message back for a moment while the one before it is on its way."""

    def __init__(self) -> None:
        self._next: int | None = None
        self._held: dict[int, tuple[float, T]] = {}

    def put(self, number: int, message: T, now_s: float) -> list[tuple[int, T]]:
        """A message that came; those that are in their order now, with their numbers."""
        if self._next is None or abs(number - self._next) > 1_000:  # counted anew
            self._next, self._held = number, {}
        if number < self._next:
            return [(number, message)]  # too late to be put before the others
        self._held[number] = (now_s, message)
        return self.ready(now_s)

    def ready(self, now_s: float) -> list[tuple[int, T]]:
        """Those that are in their order, or that waited long enough for the one before."""
        found: list[tuple[int, T]] = []
        while self._held and self._next is not None:
            first = min(self._held)
            waited_s = now_s - self._held[first][0]
            is_late = waited_s > _LONGEST_HELD_S or len(self._held) > _MOST_HELD
            if first != self._next and not is_late:
                break
            found.append((first, self._held.pop(first)[1]))
            self._next = first + 1
        return found
