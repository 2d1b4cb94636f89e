"""Warnings of a node that may have cause for them a thousand times a second."""

from __future__ import annotations

from nep_core.node import Node

_EVERY_S = 5.0
_SAME_EVERY_S = 30.0
_REMEMBERED = 16


class Complaints:
    """Warns at most every few seconds, and of the same thing seldom."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._warned_s = -_EVERY_S
        self._last: dict[str, float] = {}

    def tell(self, words: str, now_s: float, *, of: str = "") -> None:
        """Warn, unless it was just told; ``of`` names what is the same in other words."""
        if now_s - self._warned_s < _EVERY_S:
            return
        of = of or words
        if now_s - self._last.get(of, -_SAME_EVERY_S) < _SAME_EVERY_S:
            return
        self._warned_s = now_s
        self._last.pop(of, None)
        self._last[of] = now_s
        if len(self._last) > _REMEMBERED:
            del self._last[next(iter(self._last))]
        self._node.warn(words)
