"""Which of several phones is followed, and how much each may send."""

from __future__ import annotations

import math
from collections import OrderedDict

SILENT_S = 3.0
_MOST_SENDERS = 128


class Turn:
    """One phone is followed, until it leaves or is silent for some seconds; then the next."""

    def __init__(self) -> None:
        self._phone = ""
        self.heard_s = 0.0
        """When the phone that is followed sent something last."""

    def is_free_for(self, phone: str, now_s: float) -> bool:
        """Whether this phone is followed, or would be if it sent something now."""
        return self._phone in ("", phone) or now_s - self.heard_s >= SILENT_S

    def take(self, phone: str, now_s: float) -> bool:
        """Follow this phone, which sends samples, if it is free to; whether it is followed."""
        if not self.is_free_for(phone, now_s):
            return False
        self._phone, self.heard_s = phone, now_s
        return True

    def leave(self, phone: str, heard_s: float = math.inf) -> None:
        """The phone has closed a connection, by which it was followed last at ``heard_s``.

        Who was heard by another one since then has only changed its network.
        """
        if phone == self._phone and self.heard_s <= heard_s:
            self._phone = ""


class Allowance:
    """How much of something each sender may use: ``rate`` a second, and ``burst`` at once."""

    def __init__(self, rate: float, burst: float) -> None:
        self._rate, self._burst = rate, burst
        self._left: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def grants(self, sender: str, now_s: float, amount: float = 1.0) -> bool:
        """Whether the sender may use so much now; what is refused is not counted."""
        left, before_s = self._left.pop(sender, (self._burst, now_s))
        left = min(self._burst, left + (now_s - before_s) * self._rate)
        is_granted = amount <= left
        self._left[sender] = (left - amount if is_granted else left, now_s)
        while len(self._left) > _MOST_SENDERS:
            self._left.popitem(last=False)
        return is_granted
