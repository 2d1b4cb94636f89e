"""Movements as a few key angles and their times, as in Choregraphe and NAOqi."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

Handle = tuple[float, float, float, float]
"""A Bezier key's two handles: time (s) and angle (rad) before the key, time and angle after it."""

SHORTEST_STEP_S = 0.01
"""Keys of a joint are at least so far apart, and the first is so late."""
LARGEST = 1e12
"""Times (s) and angles (rad) beyond this are as good as infinite."""


@dataclass(frozen=True)
class Track:
    """One joint's keys: times (s, rising), angles (rad), and Bezier handles where there are any.

    Without handles the curve is smooth and never goes beyond its keys.
    """

    times: tuple[float, ...]
    keys: tuple[float, ...]
    handles: tuple[Handle, ...] | None = None

    def retimed(self, time: Callable[[float], float], factor: float = 1.0) -> Track:
        """Return this track with every time changed, and the handles' times multiplied."""
        handles = self.handles and tuple(
            (before * factor, angle_before, after * factor, angle_after)
            for before, angle_before, after, angle_after in self.handles
        )
        return Track(tuple(time(t) for t in self.times), self.keys, handles or None)

    def negated(self) -> Track:
        """Return this track turning the other way."""
        handles = self.handles and tuple((b, -db, a, -da) for b, db, a, da in self.handles)
        return Track(self.times, tuple(-key for key in self.keys), handles or None)

    def reversed(self, end_s: float) -> Track:
        """Return this track played from ``end_s`` back to 0."""
        handles = self.handles and tuple((-a, da, -b, db) for b, db, a, da in self.handles[::-1])
        times = tuple(end_s - t for t in self.times[::-1])
        return Track(times, self.keys[::-1], handles or None)

    def then(self, later: Track) -> Track:
        """Return this track followed by another one, which has handles if this one has."""
        handles = self.handles and later.handles and self.handles + later.handles
        return Track(self.times + later.times, self.keys + later.keys, handles or None)


def problem_of(track: Track) -> str:
    """Return why a joint cannot follow a track, or nothing."""
    if not track.keys or len(track.keys) != len(track.times):
        return f"{len(track.times)} times for {len(track.keys)} keys"
    if track.handles is not None and len(track.handles) != len(track.keys):
        return f"{len(track.handles)} handles for {len(track.keys)} keys"
    numbers = (*track.times, *track.keys, *(n for handle in track.handles or () for n in handle))
    if not all(abs(number) <= LARGEST for number in numbers):
        return "a number is infinite or not a number"
    if any(late - early < SHORTEST_STEP_S - 1e-9 for early, late in pairwise((0.0, *track.times))):
        return f"every time must be at least {SHORTEST_STEP_S} s after the one before it, or 0"
    return ""


@dataclass(frozen=True)
class Keyframes:
    """Tracks by joint name, all on one clock that starts at 0."""

    tracks: dict[str, Track]

    @property
    def duration_s(self) -> float:
        """When the last key is reached."""
        return max((track.times[-1] for track in self.tracks.values()), default=0.0)

    @property
    def first_key_s(self) -> float:
        """When the first key is reached."""
        return min((track.times[0] for track in self.tracks.values()), default=0.0)

    def mirrored(self) -> Keyframes:
        """Return the movement as seen in a mirror: left is right and right is left."""
        return Keyframes(
            {
                _other_side(name): track.negated() if _turns_sideways(name) else track
                for name, track in self.tracks.items()
            }
        )

    def reversed(self) -> Keyframes:
        """Return the movement from its last key back to its first."""
        end_s = self.duration_s
        return Keyframes({name: track.reversed(end_s) for name, track in self.tracks.items()})

    def stretched(self, factor: float) -> Keyframes:
        """Return the movement ``factor`` times as long."""
        return self._changed(lambda track: track.retimed(lambda t: t * factor, factor))

    def delayed(self, seconds: float) -> Keyframes:
        """Return the movement with every key ``seconds`` later."""
        return self._changed(lambda track: track.retimed(lambda t: t + seconds))

    def repeated(self, times: int) -> Keyframes:
        """Return the movement several times in a row."""
        whole = self
        for turn in range(1, times):
            later = self.delayed(turn * self.duration_s)
            whole = Keyframes({n: t.then(later.tracks[n]) for n, t in whole.tracks.items()})
        return whole

    def _changed(self, change: Callable[[Track], Track]) -> Keyframes:
        return Keyframes({name: change(track) for name, track in self.tracks.items()})


def _other_side(name: str) -> str:
    return {"L": "R", "R": "L"}.get(name[0], name[0]) + name[1:]


def mirror_angle(name: str, angle: float) -> float:
    """Return the angle of the joint of this name on the other side, as seen in a mirror."""
    return -angle if _turns_sideways(name) else angle


def _turns_sideways(name: str) -> bool:
    return name.endswith(("Roll", "Yaw"))
