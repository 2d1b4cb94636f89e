"""What a recogniser tells about itself: how certain it is, how quick, and how busy."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping

from nep_core.messages import Imu
from nep_core.node import Node
from nodes.perceptual.recognition.peaks import Detection

_MOST_DELAY_S = 5.0  # more is another computer's clock that is wrong


class Measures:
    """Collects figures, and tells them as often as a node may.

    ``certainty.karate`` is the highest since the figures were told last, ``latency_ms`` the time
    from the end of the last gesture to its trigger, ``load`` the share of a core in use.
    """

    def __init__(self, node: Node, names: Iterable[str]) -> None:
        self._node = node
        self._names = tuple(names)
        self._highest: dict[str, float] = {}
        self._latency_s: float | None = None
        self._arrived_s = self._sent_s = time.time()
        self._worked_s, self._since_s = time.process_time(), time.monotonic()

    def arrived(self, sent_ns: int | None) -> None:
        """A batch of samples has come that was sent at this time."""
        self._arrived_s = time.time()
        sent_s = self._arrived_s if sent_ns is None else sent_ns / 1e9
        is_likely = 0 <= self._arrived_s - sent_s < _MOST_DELAY_S
        self._sent_s = sent_s if is_likely else self._arrived_s

    def heard(self, certainties: Mapping[str, float]) -> None:
        """It was as certain as this."""
        for name, certainty in certainties.items():
            self._highest[name] = max(certainty, self._highest.get(name, 0.0))

    def triggered(self, found: Detection, batch: Imu | None) -> None:
        """A gesture fires now, after this batch, or (None) after a silence."""
        after_s = max(0.0, batch.t[-1] - found.t_end) if batch is not None and batch.t else 0.0
        self._latency_s = min(after_s, _MOST_DELAY_S) + max(0.0, time.time() - self._sent_s)

    def tell(self) -> None:
        """Tell the figures, if it is time."""
        figures = {f"certainty.{name}": self._highest.get(name, 0.0) for name in self._names}
        figures = {name: round(value, 3) for name, value in figures.items()}
        if self._latency_s is not None:
            figures["latency_ms"] = round(1000 * self._latency_s, 1)
        worked_s = time.process_time() - self._worked_s
        figures["load"] = round(worked_s / max(time.monotonic() - self._since_s, 1e-3), 4)
        if self._node.state("alive", measures=figures):
            self._highest.clear()
            self._worked_s, self._since_s = time.process_time(), time.monotonic()
