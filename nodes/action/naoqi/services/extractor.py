"""Services that look or listen while somebody has subscribed to them."""

from __future__ import annotations

from typing import Any

from nodes.action.naoqi.server import CallFailed, method
from nodes.action.naoqi.services.module import Module
from nodes.action.naoqi.serving import ServedRobot

PERIOD_MS = 500
PRECISION = 1.0


class Extractor(Module):
    """A service that tells ALMemory what it notices; ``events`` are the names of these events."""

    events: tuple[str, ...] = ()

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._subscribers: dict[str, tuple[int, float]] = {}
        self._is_paused = False

    @property
    def is_on(self) -> bool:
        """Whether it looks or listens now."""
        return bool(self._subscribers) and not self._is_paused

    def _changed(self) -> None:
        """Do what follows from being on, or not any more."""

    @method("subscribe::v(s)")
    def subscribe(self, name: str) -> None:
        """Begin, for a subscriber."""
        self.subscribe_with(name, PERIOD_MS, PRECISION)

    @method("subscribe::v(sif)")
    def subscribe_with(self, name: str, period: int, precision: float) -> None:
        """Begin, for a subscriber who wants news every so many milliseconds."""
        self._subscribers[name] = (period, precision)
        self._changed()

    @method("unsubscribe::v(s)")
    def unsubscribe(self, name: str) -> None:
        """End it for a subscriber."""
        self._subscription(name)
        del self._subscribers[name]
        self._changed()

    @method("updatePeriod::v(si)")
    def update_period(self, name: str, period: int) -> None:
        """Change how often a subscriber wants news."""
        self._subscribers[name] = (period, self._subscription(name)[1])

    @method("updatePrecision::v(sf)")
    def update_precision(self, name: str, precision: float) -> None:
        """Change how exact a subscriber wants the news."""
        self._subscribers[name] = (self._subscription(name)[0], precision)

    @method("getCurrentPeriod::i()")
    def current_period(self) -> int:
        """Return how often it looks, in milliseconds: as often as anybody wants."""
        return min((period for period, _ in self._subscribers.values()), default=PERIOD_MS)

    @method("getCurrentPrecision::f()")
    def current_precision(self) -> float:
        """Return how exact it is."""
        return max((precision for _, precision in self._subscribers.values()), default=PRECISION)

    @method("getMyPeriod::i(s)")
    def my_period(self, name: str) -> int:
        """Return how often a subscriber wants news, in milliseconds."""
        return self._subscription(name)[0]

    @method("getMyPrecision::f(s)")
    def my_precision(self, name: str) -> float:
        """Return how exact a subscriber wants the news."""
        return self._subscription(name)[1]

    @method("getSubscribersInfo::m()")
    def subscribers_info(self) -> list[list[Any]]:
        """Return the name, period and precision of each subscriber."""
        return [[name, *wanted] for name, wanted in self._subscribers.items()]

    @method("getOutputNames::[s]()")
    def output_names(self) -> list[str]:
        """Return the keys in ALMemory that it writes."""
        return list(self.events)

    @method("getEventList::[s]()")
    def event_list(self) -> list[str]:
        """Return the events that it raises."""
        return list(self.events)

    @method("getMemoryKeyList::[s]()")
    def memory_key_list(self) -> list[str]:
        """Return the keys in ALMemory that it writes without an event."""
        return []

    def _subscription(self, name: str) -> tuple[int, float]:
        if name not in self._subscribers:
            raise CallFailed(f"{self.name}: “{name}” has not subscribed.")
        return self._subscribers[name]


class PausableExtractor(Extractor):
    """One that can be paused; those of a NAO's eyes also have a camera and its settings."""

    @method("pause::v(b)")
    def pause(self, is_paused: bool) -> None:
        """Pause, or go on."""
        self._is_paused = is_paused
        self._changed()

    @method("isPaused::b()")
    def paused(self) -> bool:
        """Return whether it is paused."""
        return self._is_paused

    @method("isProcessing::b()")
    def processing(self) -> bool:
        """Return whether it looks or listens now."""
        return self.is_on
