"""Whether and when a show that has ended is begun again; no clock and no Qt in here."""

from __future__ import annotations

from dataclasses import dataclass, field

PAUSE_S = 5.0
LONGEST_PAUSE_S = 60.0
STEADY_S = 60.0
"""A show that has gone on for so long was not broken from the beginning."""


@dataclass
class Restarts:
    """Counts failures in a row; after ``most`` of them somebody must look.

    ``again``: a show that ended well begins anew, too. ``total`` is how often it was begun again
    since somebody pressed Run.
    """

    most: int = 5
    again: bool = False
    failures: int = 0
    total: int = 0
    _began_s: float = field(default=0.0, repr=False)

    def pressed(self) -> None:
        """Somebody has pressed Run: what was before does not count any more."""
        self.failures = self.total = 0

    def began(self, now_s: float) -> None:
        """A show begins."""
        self._began_s = now_s

    def failed(self, now_s: float) -> float | None:
        """How long to wait before it begins again, in s; None: somebody must look."""
        if now_s - self._began_s >= STEADY_S:
            self.failures = 0
        self.failures += 1
        if self.failures > self.most:
            return None
        self.total += 1
        return min(PAUSE_S * 2.0 ** (self.failures - 1), LONGEST_PAUSE_S)

    def ended(self) -> float | None:
        """The same for a show that ended well; None: it waits for somebody to press Run."""
        self.failures = 0
        if not self.again:
            return None
        self.total += 1
        return PAUSE_S
