"""Readings of one sender as an even stream of samples: one clock, both sensors together."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

from nodes.sensory.clock_fit import ClockFit
from nodes.sensory.flow import Flow
from nodes.sensory.reading import NS, Reading, Vector

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
    def rate_hz(self) -> float:
        """Samples a second as measured, 0 while too few have come."""
        return self.flow.rate_hz

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
            self._start_anew(stamp_s, since_s)
        t = stamp_s - (self._zero_s or 0.0)
        self._last_s = max(self._last_s, t)
        return t

    def note_arrival(self, arrived_s: float) -> None:
        """The reading that was timed last arrived then."""
        self.fit.add(self._last_s, arrived_s)

    def _start_anew(self, stamp_s: float, since_s: float) -> None:
        if self._zero_s is not None:
            step_s = stamp_s - self._zero_s - self._last_s
            if abs(step_s - since_s) > _LATEST_S:  # else it was silent for so long
                self.jump_s = step_s
            self.fit = ClockFit()
        self._zero_s = stamp_s - self._last_s - max(since_s, _SHORT_S)

    def _is_near(self, t: float, arrived_s: float) -> bool:
        step_s = t - self._last_s
        if not -_LATEST_S < step_s < _LONGEST_GAP_S:
            return False
        return step_s < _EARLIEST_S or self.fit.lead_s(t, arrived_s) < _EARLIEST_S

    def _unit_of(self, stamp: float, told_s: float | None) -> float:
        if told_s is not None:
            return told_s
        if self._unit_s is None and self._zero_s is not None and stamp > self._last_stamp:
            self._unit_s = _unit_of_step(stamp - self._last_stamp)
            self._zero_s = self._last_stamp * self._unit_s - self._last_s
        return self._unit_s or 1.0


def _unit_of_step(step: float) -> float:
    """The unit of stamps that are ``step`` apart, for sensors of about 1 to 1,000 Hz."""
    limits = ((0.9, 1.0), (900, 1e-3), (9e5, 1e-6))
    return next((unit_s for limit, unit_s in limits if step < limit), NS)
