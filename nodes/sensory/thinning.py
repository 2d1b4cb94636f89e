"""Bounds how many samples a second go on, when a sender floods."""

from __future__ import annotations

from typing import TypeVar

T = TypeVar("T")

USEFUL_HZ = 500  # what no movement of a person needs more than
_FLOOD_HZ = 1_200  # from here on samples are left out
_OVER_S = 1.0


class Thinning:
    """Keeps every n-th sample of a flood, so that about 500 a second are left."""

    def __init__(self) -> None:
        self._began_s: float | None = None
        self._count = 0
        self._place = 0
        self.every = 1
        self.arriving_hz = 0.0

    def kept(self, samples: list[T], now_s: float) -> list[T]:
        """Those of these samples that go on."""
        self._measure(len(samples), now_s)
        if self.every == 1:
            return samples
        first = -self._place % self.every
        self._place += len(samples)
        return samples[first :: self.every]

    def _measure(self, count: int, now_s: float) -> None:
        if self._began_s is None:
            self._began_s = now_s  # what comes now belongs to the time before
            return
        self._count += count
        passed_s = now_s - self._began_s
        if self._count > _FLOOD_HZ * max(_OVER_S, passed_s) and self.every == 1:
            self._settle(max(passed_s, 0.1))  # at once, before a whole second has passed
        elif passed_s >= _OVER_S:
            self._settle(passed_s)
            self._began_s, self._count = now_s, 0

    def _settle(self, passed_s: float) -> None:
        self.arriving_hz = self._count / passed_s
        is_flood = self.arriving_hz > _FLOOD_HZ
        is_as_before = self.every > 1 and 0.8 < self.arriving_hz / self.every / USEFUL_HZ < 1.2
        if not is_as_before:
            self.every = max(1, round(self.arriving_hz / USEFUL_HZ)) if is_flood else 1
