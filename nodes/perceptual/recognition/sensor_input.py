"""Listening to one sensor: as it is worn, at the rate that it has, and telling what is amiss."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from faults import Text, Words, text_of
from nep_core.processes.node import Node
from nep_core.wire.messages import Imu

from .features import Detection
from .model import Model
from .spotting import Spotter
from .streams import MAX_GAP_S, Floats, mirrored

Worn = Literal["as recorded", "turned", "automatic"]
"""How a watch sits: as in the recordings, the strap the other way round, or either."""

SLOWEST_HZ = 10.0
_TURNED = np.array([-1.0, -1.0, 1.0])  # half a turn about the axis out of the screen
_ENOUGH_PROOFS = 3
_LOOK_AT_BATCHES = 50
_MOST_BREAKS = 0.5


@dataclass
class _Way:
    """A way to wear the watch: what it makes of samples, who listens, how often it was right."""

    is_turned: bool
    spotter: Spotter
    proofs: int = 0

    def push(self, t: Floats, acc: Floats, gyr: Floats | None) -> list[Detection]:
        if self.is_turned:
            acc, gyr = acc * _TURNED, None if gyr is None else gyr * _TURNED
        return self.spotter.push(t, acc, gyr)


class SensorInput:
    """Spots gestures in the samples of one sensor.

    ``tell`` gets a sentence when it finds out how the watch is worn, ``warn`` one for each trouble.
    RecordingError when the sensor lacks what the model needs.

    ``first`` is the sensor's first message, ``model`` what was learned, ``make_spotter`` makes
    what finds gestures, ``worn`` is how the watch sits.
    """

    def __init__(
        self,
        first: Imu,
        model: Model,
        make_spotter: Callable[[], Spotter],
        worn: Worn,
        tell: Callable[[Text], None],
        warn: Callable[[Text], None],
    ) -> None:
        self.source = first.sender
        self._tell = tell
        self._mirrors = {first.wrist, model.wrist} == {"left", "right"}
        turns = {"as recorded": [False], "turned": [True], "automatic": [False, True]}[worn]
        self._ways = [_Way(is_turned, make_spotter()) for is_turned in turns]
        self._last: Detection | None = None
        for way in self._ways:
            way.spotter.listen(first.gyr is not None)
        self._troubles = Troubles(self.source, warn)
        if about_wrist := self._about_wrist(first, model):
            tell(about_wrist)

    @property
    def certainties(self) -> Mapping[str, float]:
        """How certain it is of each gesture now, whichever way the watch is worn."""
        first, *others = (way.spotter.certainties for way in self._ways)
        return {name: max(value, *(o[name] for o in others), 0.0) for name, value in first.items()}

    def hear(self, batch: Imu) -> list[Detection]:
        """The gestures that end in a batch of samples."""
        t, acc = np.array(batch.t, float), np.array(batch.acc, float)
        gyr = None if batch.gyr is None else np.array(batch.gyr, float)
        self._troubles.look(t, acc)
        if self._mirrors:
            acc, gyr = mirrored(acc, gyr)
        return self._agreed([way.push(t, acc, gyr) for way in self._ways])

    def flush(self) -> list[Detection]:
        """What waits for something better, when the sensor has fallen silent."""
        return self._agreed([way.spotter.flush() for way in self._ways])

    def _agreed(self, found: list[list[Detection]]) -> list[Detection]:
        """What was found, each movement in one way only: the one that is more certain of it."""
        if len(self._ways) == 1:
            return found[0]
        every = [(one, way) for way, each in zip(self._ways, found, strict=True) for one in each]
        kept = []
        for one, way in sorted(every, key=lambda pair: -pair[0].certainty):
            if self._last is None or not _overlap(one, self._last):
                self._last = one
                way.proofs += 1
                kept.append(one)
        self._decide()
        return kept

    def _decide(self) -> None:
        """Listen in one way only, once it was right often enough."""
        fewest, most = sorted(self._ways, key=lambda way: way.proofs)
        if most.proofs - fewest.proofs >= _ENOUGH_PROOFS:
            self._ways = [most]
            told = text_of(
                "{source} is worn turned round, as its gestures show."
                if most.is_turned
                else "{source} is worn as in the recordings, as its gestures show.",
                source=self.source,
            )
            self._tell(told)

    def _about_wrist(self, first: Imu, model: Model) -> Text:
        """What a person should know of where the sensor is worn; "" for nothing."""
        source = self.source
        if self._mirrors:
            return text_of(
                "{source} is not worn on the wrist on which the gestures were recorded: its "
                "movement is mirrored.",
                source=source,
            )
        if "" not in (first.wrist, model.wrist) and first.wrist != model.wrist:
            return text_of(
                "{source} is not worn where the gestures were recorded, so some may be missed.",
                source=source,
            )
        return Text("")


def _overlap(one: Detection, other: Detection) -> bool:
    return one.t_start < other.t_end and other.t_start < one.t_end


MOST_SENSORS = 8
FORGOTTEN_S = 10.0
"""A sensor that is silent for so long may give way to another one."""


class Audience:
    """Which sensors a node listens to: a few at a time; a silent one gives way to another.

    ``forget`` is called with the source of one that gives way. ``heard_s`` tells when each was
    heard last.
    """

    def __init__(self, node: Node, forget: Callable[[str], None]) -> None:
        self._node, self._forget = node, forget
        self.heard_s: dict[str, float] = {}
        self._is_full = False

    def has(self, batch: Imu) -> bool:
        """Whether the sensor of a batch is one of them from now on; who is not is told once."""
        if batch.source not in self.heard_s:
            if len(self.heard_s) >= MOST_SENSORS and not self._forget_silent():
                self._tell_full(batch)
                return False
            self._is_full = False
        self.heard_s[batch.source] = time.monotonic()
        return True

    def _tell_full(self, batch: Imu) -> None:
        if not self._is_full:
            self._is_full = True
            self._node.warn(
                "{source} is not heard: {most_sensors} watches and phones send movement "
                "already. Switch off those that nobody wears.",
                source=batch.sender,
                most_sensors=MOST_SENSORS,
            )

    def _forget_silent(self) -> bool:
        """Forget the sensor that has been silent for longest, if that was long."""
        oldest = min(self.heard_s, key=lambda source: self.heard_s[source])
        if time.monotonic() - self.heard_s[oldest] < FORGOTTEN_S:
            return False
        del self.heard_s[oldest]
        self._forget(oldest)
        return True


class Troubles:
    """What a stream of samples lacks to be understood; each is told once."""

    def __init__(self, source: Words, warn: Callable[[Text], None]) -> None:
        self._source = source
        self._warn = warn
        self._warned: set[str] = set()
        self._batches = self._breaks = self._samples = self._numbers = self._steps = 0
        self._moving_s = 0.0
        self._last_s = np.nan

    def look(self, t: Floats, acc: Floats) -> None:
        """Take n samples into account."""
        usable = np.isfinite(t) & np.isfinite(acc).all(axis=1)
        self._samples += len(t)
        self._numbers += int(usable.sum())
        self._batches += 1
        if usable.any():
            self._follow(t[usable])
        if self._batches >= _LOOK_AT_BATCHES:
            self._judge()

    def _follow(self, t: Floats) -> None:
        steps_s = np.diff(t) if np.isnan(self._last_s) else np.diff(t, prepend=self._last_s)
        is_break = (steps_s < -MAX_GAP_S) | (steps_s > MAX_GAP_S)
        self._breaks += bool(is_break.any())
        self._steps += int((~is_break).sum())
        self._moving_s += float(steps_s[~is_break].clip(0).sum())
        self._last_s = float(t[-1])

    def _judge(self) -> None:
        source, told = self._source, Text("")
        rate_hz = self._steps / max(self._moving_s, 1e-9)
        if self._numbers < self._samples / 2:
            told = text_of(
                "{source} sends numbers that no sensor can measure. Restart its app.", source=source
            )
        elif self._breaks > _MOST_BREAKS * self._batches:
            told = text_of(
                "The times of {source} jump: do two watches send under this name, or does it "
                "send less than twice a second? Give each a name of its own, and a faster rate.",
                source=source,
            )
        elif not self._moving_s:
            told = text_of("The clock of {source} stands still. Restart its app.", source=source)
        elif rate_hz < SLOWEST_HZ:
            told = text_of(
                "{source} sends {rate_hz} samples a second, too few to tell gestures apart. "
                "Choose a faster rate in its app, better 50.",
                source=source,
                rate_hz=f"{rate_hz:.1f}",
            )
        if told and told.text not in self._warned:
            self._warned.add(told.text)
            self._warn(told)
        self._batches = self._breaks = self._samples = self._numbers = self._steps = 0
        self._moving_s = 0.0


# What a recogniser tells about itself: how certain it is, how quick, and how busy.

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
