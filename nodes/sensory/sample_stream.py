"""Readings of one sender as an even stream of samples: one clock, both sensors together."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import median

from nodes.recordings import guess_time_unit_s

from .reading import Reading, Vector

# How a sender's clock runs against ours, from when its samples arrive.

_SPAN_S = 5.0  # of which the quickest arrival is kept: the others waited on their way
_MOST_SPANS = 60  # five minutes
_ENOUGH_SPANS = 5
_RECENT = 50  # arrivals that the usual delay is taken from


class ClockFit:
    """Fits a line through the quickest arrivals of each few seconds.

    A message is never too early, so the least delayed ones tell the offset of the two clocks; the
    median of the slopes between them (Theil-Sen) is the drift, whatever a few spans say.
    """

    def __init__(self) -> None:
        self._quickest: deque[tuple[float, float]] = deque(maxlen=_MOST_SPANS)
        self._span_end_s: float | None = None
        self._delays: deque[float] = deque(maxlen=_RECENT)
        self._slope = 0.0

    def add(self, sent_s: float, arrived_s: float) -> None:
        """A sample's time on the sender's clock, and when it arrived on ours."""
        offset_s = arrived_s - sent_s
        if self._span_end_s is None or arrived_s >= self._span_end_s:
            self._span_end_s = arrived_s + _SPAN_S
            self._slope = self._fit()
            self._quickest.append((arrived_s, offset_s))
        elif offset_s < self._quickest[-1][1]:
            self._quickest[-1] = (arrived_s, offset_s)
        self._delays.append(max(0.0, offset_s - self._expected(arrived_s)))

    @property
    def drift_ppm(self) -> float | None:
        """How much slower than ours the sender's clock runs, None before that is known."""
        return self._slope * 1e6 if len(self._quickest) > _ENOUGH_SPANS else None

    @property
    def delay_s(self) -> float:
        """How much later than the quickest a message usually arrives."""
        return median(self._delays) if self._delays else 0.0

    def lead_s(self, sent_s: float, arrived_s: float) -> float:
        """How much earlier than even the quickest before it this sample would have arrived."""
        if not self._quickest:
            return 0.0
        return self._expected(arrived_s) - (arrived_s - sent_s)

    def _expected(self, arrived_s: float) -> float:
        """The least offset at a moment, by the line through the quickest arrivals."""
        return min(
            offset_s + self._slope * (arrived_s - then_s) for then_s, offset_s in self._quickest
        )

    def _fit(self) -> float:
        points = list(self._quickest)
        if len(points) < _ENOUGH_SPANS:
            return 0.0
        slopes = [
            (later[1] - one[1]) / (later[0] - one[0])
            for number, one in enumerate(points)
            for later in points[number + 1 :]
            if later[0] > one[0]
        ]
        return median(slopes) if slopes else 0.0


# How well samples flow in: their rate, what is lost, where there are gaps.

_RATE_OVER = 200  # samples
_LOSS_OVER = 2_000  # samples
_FEW = 10
_MISSED = 1.6  # steps; a longer one misses samples
_GAP_S, _GAP_STEPS = 0.25, 4


class Flow:
    """Counts over the last samples; memory is bounded."""

    def __init__(self) -> None:
        self._times: deque[float] = deque(maxlen=_RATE_OVER)
        self._missed: deque[int] = deque(maxlen=_LOSS_OVER)
        self._step_s = 0.0
        self._since_step = 0
        self._numbers: deque[int] = deque(maxlen=_LOSS_OVER)  # lost messages before each
        self._last_number: int | None = None
        self.gaps = 0

    def add(self, t: float, *, is_stamped: bool = True) -> None:
        """A sample's time in s; times rise. Those of arrival tell nothing of losses."""
        if self._times and is_stamped:
            self._note_step(t - self._times[-1])
        self._times.append(t)
        self._since_step += 1
        if self._since_step >= _FEW:
            self._since_step = 0
            times = list(self._times)
            self._step_s = median([after - before for before, after in pairwise(times)])

    def add_message(self, number: int) -> None:
        """A message's place in the sender's count; one that starts anew loses nothing."""
        last, self._last_number = self._last_number, number
        if last is not None and 0 < number - last < _LOSS_OVER:
            self._numbers.append(number - last - 1)

    @property
    def rate_hz(self) -> float:
        """Samples a second, gaps left out; 0 while too few have come."""
        if len(self._times) < _FEW or self._times[-1] <= self._times[0]:
            return 0.0
        return (len(self._times) - 1) / (self._times[-1] - self._times[0])

    @property
    def loss(self) -> float:
        """The share of samples, or of messages, that is missing."""
        missed, lost = sum(self._missed), sum(self._numbers)
        by_cadence = missed / (missed + len(self._missed)) if self._missed else 0.0
        by_number = lost / (lost + len(self._numbers)) if self._numbers else 0.0
        return max(by_cadence, by_number)

    def _note_step(self, step_s: float) -> None:
        usual_s = self._step_s
        if not usual_s:
            return
        steps = step_s / usual_s
        self._missed.append(min(_LOSS_OVER, round(steps) - 1) if steps > _MISSED else 0)
        if step_s > max(_GAP_S, _GAP_STEPS * usual_s):
            self.gaps += 1


_GYRO_LASTS_S = 0.5  # a rotation rate older than this is not joined to an acceleration any more
_LONGEST_GAP_S = 30.0  # a sender's clock that jumps further was started anew,
_LATEST_S = 1.0  # so was one that goes back by more than readings overtake each other,
_EARLIEST_S = 5.0  # and one that is so long ahead of when its readings can have been measured
_SHORT_S = 0.001
_SIZES_OVER = 200  # samples
_EARTH_M_S2 = (6.0, 14.0)
_STEADY = 0.8  # four of five sizes are more than this part of the usual one: nobody shakes it


@dataclass(frozen=True)
class Sample:
    """One acceleration in m/s² at ``t`` s, with the rotation rate in rad/s where there is one."""

    t: float
    acc: Vector
    gyr: Vector | None


class SampleStream:
    """Joins the readings of a sender, whose clock it follows where there is one."""

    def __init__(self) -> None:
        self._clock = _SenderClock()
        self._gyr: Vector | None = None
        self._gyr_t = 0.0
        self._last_t: float | None = None
        self._gravity = _GravitySign()
        self._arrived_s: float | None = None
        self.flow = Flow()

    @property
    def gravity_included(self) -> bool:
        """Whether the sensor feels gravity: told by the sender, and usually near 9.81 m/s²."""
        return self._gravity.is_there()

    @property
    def measures(self) -> dict[str, float]:
        """What a person wants to know of the flow; drift only when it is known."""
        found = {
            "rate_hz": round(self.flow.rate_hz, 2),
            "loss": round(self.flow.loss, 4),
            "gaps": float(self.flow.gaps),
            "delay_ms": round(self._clock.fit.delay_s * 1000, 1),
        }
        drift_ppm = self._clock.fit.drift_ppm
        return found if drift_ppm is None else found | {"drift_ppm": round(drift_ppm, 1)}

    def take_jump_s(self) -> float:
        """By how much the sender's clock has jumped since this was asked last."""
        jump_s, self._clock.jump_s = self._clock.jump_s, 0.0
        return jump_s

    def samples(self, readings: Sequence[Reading], arrived_s: float) -> list[Sample]:
        """The samples that the readings of a packet make; late and repeated ones are left out.

        Readings without a time of their own are spread over the time since the packet before.
        """
        before_s = arrived_s if self._arrived_s is None else self._arrived_s
        self._arrived_s = arrived_s
        step_s = (arrived_s - before_s) / max(1, len(readings))
        made = [
            self._sample(reading, before_s + step_s * number)
            for number, reading in enumerate(readings, start=1)
        ]
        if readings and readings[-1].stamp is not None:  # the last one waited least
            self._clock.note_arrival(arrived_s)
        return [sample for sample in made if sample is not None]

    def _sample(self, reading: Reading, arrived_s: float) -> Sample | None:
        t = self._clock.seconds(reading, arrived_s)
        if reading.gyr is not None:
            self._gyr, self._gyr_t = reading.gyr, t
        if reading.acc is None or (self._last_t is not None and t <= self._last_t):
            return None
        self._last_t = t
        self.flow.add(t, is_stamped=reading.stamp is not None)
        self._gravity.note(reading.acc, reading.gravity_included)
        fresh = self._gyr is not None and abs(t - self._gyr_t) < _GYRO_LASTS_S
        return Sample(t, reading.acc, self._gyr if fresh else None)


class _GravitySign:
    """Tells by the sizes of accelerations whether gravity is in them, once they are calm.

    While somebody shakes the sensor they say nothing, and what they said before still holds.
    """

    def __init__(self) -> None:
        self._sizes: deque[float] = deque(maxlen=_SIZES_OVER)
        self._is_told = self._is_felt = True

    def note(self, acc: Vector, is_told: bool) -> None:
        """An acceleration, and what its sender says of it."""
        self._sizes.append(sum(axis * axis for axis in acc) ** 0.5)
        self._is_told = is_told

    def is_there(self) -> bool:
        """Whether gravity is in them."""
        if self._is_told and self._sizes:
            sizes = sorted(self._sizes)
            calm, usual = sizes[len(sizes) // 5], sizes[len(sizes) // 2]
            if usual <= _EARTH_M_S2[0]:
                self._is_felt = False
            elif calm > _STEADY * usual:
                self._is_felt = usual < _EARTH_M_S2[1]
        return self._is_told and self._is_felt


class _SenderClock:
    """Seconds since the first reading: by the sender's stamps, else by when readings arrive."""

    def __init__(self) -> None:
        self.fit = ClockFit()
        self.jump_s = 0.0
        self._unit_s: float | None = None
        self._zero_s: float | None = None  # the sender's time at our time 0
        self._last_stamp = 0.0
        self._last_s = 0.0
        self._arrived_s: float | None = None

    def seconds(self, reading: Reading, arrived_s: float) -> float:
        """The time of a reading; a clock that was started anew goes on after the last time."""
        since_s = arrived_s - (arrived_s if self._arrived_s is None else self._arrived_s)
        self._arrived_s = arrived_s
        if reading.stamp is None:
            self._last_s += since_s
            return self._last_s
        stamp_s = reading.stamp * self._unit_of(reading.stamp, reading.stamp_unit_s)
        self._last_stamp = reading.stamp
        if self._zero_s is None or not self._is_near(stamp_s - self._zero_s, arrived_s):
            if self._zero_s is not None:
                step_s = stamp_s - self._zero_s - self._last_s
                if abs(step_s - since_s) > _LATEST_S:  # else it was silent for so long
                    self.jump_s = step_s
                self.fit = ClockFit()
            self._zero_s = stamp_s - self._last_s - max(since_s, _SHORT_S)
        t = stamp_s - (self._zero_s or 0.0)
        self._last_s = max(self._last_s, t)
        return t

    def note_arrival(self, arrived_s: float) -> None:
        """The reading that was timed last arrived then."""
        self.fit.add(self._last_s, arrived_s)

    def _is_near(self, t: float, arrived_s: float) -> bool:
        step_s = t - self._last_s
        if not -_LATEST_S < step_s < _LONGEST_GAP_S:
            return False
        return step_s < _EARLIEST_S or self.fit.lead_s(t, arrived_s) < _EARLIEST_S

    def _unit_of(self, stamp: float, told_s: float | None) -> float:
        if told_s is not None:
            return told_s
        if self._unit_s is None and self._zero_s is not None and stamp > self._last_stamp:
            self._unit_s = guess_time_unit_s(stamp - self._last_stamp)
            self._zero_s = self._last_stamp * self._unit_s - self._last_s
        return self._unit_s or 1.0
