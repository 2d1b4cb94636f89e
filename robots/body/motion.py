"""Movements ready to be played: every joint's angle at every tick, within its limits and speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robots.errors import ActionFailed

from .body import Angles, Body
from .keyframes import MINIMUM_JERK_PEAK, Keyframes, minimum_jerk, peak_speed, ticks, track_angles

TICK_S = 0.01
POSTURE_SPEED = 0.25
"""Part of their top speed that joints use between postures: what looks calm, and stays upright."""
SHORTEST_MOVE_S = 0.4
APPROACH_SPEED = 0.5
BRAKING_S = 0.25
LONGEST_S = 600.0
"""Every tick of a movement is planned before it begins: the robot must not think for long."""
SPEED_MARGIN = 1.02
"""Movements that are too fast are slowed this much more than a sampled curve says."""


@dataclass(frozen=True)
class Motion:
    """Angles (ticks, columns) of some joints, one row every TICK_S; ``notes`` say what was changed.

    ``columns`` are places in the body's joint order.
    """

    columns: tuple[int, ...]
    angles: Angles
    notes: tuple[str, ...] = ()

    @property
    def duration_s(self) -> float:
        """How long it takes."""
        return len(self.angles) * TICK_S


def move(
    body: Body,
    pose: Angles,
    goal: Angles,
    columns: Sequence[int],
    *,
    speed: float = POSTURE_SPEED,
    at_least_s: float = SHORTEST_MOVE_S,
) -> Motion:
    """Return the minimum-jerk movement of some joints from a pose to a goal (both: every joint).

    No joint moves faster than ``speed`` (0 to 1) times its top speed.

    ``body`` is what moves; ``columns`` are the joints that do, by number; ``at_least_s`` is the
    shortest time.
    """
    chosen = list(columns)
    start, end = pose[chosen], goal[chosen]
    fastest = body.max_speed[chosen] * speed
    needed_s = float(np.max(MINIMUM_JERK_PEAK * np.abs(end - start) / fastest, initial=0.0))
    duration_s = math.ceil(max(needed_s, at_least_s) / TICK_S) * TICK_S
    progress = minimum_jerk(ticks(duration_s, TICK_S) / duration_s)
    return _allowed(body, pose, chosen, start + progress[:, None] * (end - start))


def keyframe_motion(
    body: Body, pose: Angles, keyframes: Keyframes, *, softly: bool = True
) -> Motion:
    """Return keyframes as a movement that begins at a pose (every joint).

    They are made ``playable``; angles that the joints cannot have are clamped. The notes say so.
    Raises ActionFailed when that lasts too long.

    ``body`` is what moves; ``softly`` is as for ``playable``.
    """
    keyframes, notes = playable(body, pose, keyframes, softly=softly)
    if keyframes.duration_s > LONGEST_S:
        raise ActionFailed(
            "This movement would last {duration_s} s. At most {longest_s} s are possible: let it "
            "have fewer or earlier keys.",
            duration_s=f"{keyframes.duration_s:.0f}",
            longest_s=f"{LONGEST_S:.0f}",
        )
    columns = [body.index[name] for name in keyframes.tracks]
    times_s = ticks(keyframes.duration_s, TICK_S)
    curves = []
    for name, track in keyframes.tracks.items():
        column = body.index[name]
        start, fastest = float(pose[column]), float(body.max_speed[column])
        curves.append(track_angles(track, start, times_s, fastest))
    return _allowed(body, pose, columns, np.column_stack(curves), notes)


def playable(
    body: Body, pose: Angles, keyframes: Keyframes, *, softly: bool = True
) -> tuple[Keyframes, list[str]]:
    """Return keyframes that joints can follow from a pose (every joint), and what was changed.

    The way to the first keys gets the time that it needs to look calm, unless not ``softly``; what
    is too fast is stretched in time.

    ``body`` is what moves.
    """
    notes: list[str] = []
    # Give the joints that share a motor the same track: the leader's where it has one
    tracks = dict(keyframes.tracks)
    for follower, leader in body.same_motor.items():
        shared = tracks.get(leader) or tracks.get(follower)
        if shared:
            tracks[leader] = tracks[follower] = shared
    keyframes = Keyframes(tracks)
    if softly:
        keyframes = keyframes.delayed(approach_delay_s(body, pose, keyframes))
    given_s = keyframes.duration_s
    # More than once: handles that were kept to the joint's speed may grow with the time there is.
    while (factor := _slowdown(body, pose, keyframes)) > 1.0:
        keyframes = keyframes.stretched(factor)
    if keyframes.duration_s > given_s:
        slower = keyframes.duration_s / given_s
        notes.append(f"played {slower:.2f} times slower: its joints cannot move faster")
    return keyframes, notes


def braking(body: Body, pose: Angles, speed_rad_s: Angles, columns: Sequence[int]) -> Motion:
    """Return how some joints come to rest in BRAKING_S (pose and speeds: of every joint).

    ``body`` is what moves, ``speed_rad_s`` how fast, ``columns`` are the joints that brake, by
    number.
    """
    allowed, _ = body.clamped(pose + braking_way_s()[:, None] * speed_rad_s)
    return Motion(tuple(columns), allowed[:, list(columns)])


def braking_way_s() -> Angles:
    """Return how far something goes at each tick while it brakes, per unit of its first speed.

    The speed falls as (1 - s)², s being the part of BRAKING_S that has passed.
    """
    s = ticks(BRAKING_S, TICK_S) / BRAKING_S
    return (1.0 - (1.0 - s) ** 3) / 3.0 * BRAKING_S


def _allowed(
    body: Body, pose: Angles, columns: list[int], angles: Angles, notes: Sequence[str] = ()
) -> Motion:
    """Return the movement with its angles clamped; a head that turns may have to nod for it."""
    whole = np.repeat(pose[None, :], len(angles), axis=0)
    whole[:, columns] = angles
    allowed, clamped = body.clamped(whole)
    if clamped:
        notes = [*notes, f"kept within the limits of {', '.join(clamped)}"]
    if body.head[0] in columns:
        columns = sorted({*columns, *body.head})
    return Motion(tuple(columns), allowed[:, columns], tuple(notes))


def approach_delay_s(body: Body, pose: Angles, keyframes: Keyframes) -> float:
    """Return how much later the keys have to be so that joints reach their first ones calmly."""
    delay_s = 0.0
    for name, track in keyframes.tracks.items():
        column = body.index[name]
        way = abs(track.keys[0] - pose[column])
        needed_s = max(TICK_S, MINIMUM_JERK_PEAK * way / (body.max_speed[column] * APPROACH_SPEED))
        delay_s = max(delay_s, needed_s - track.times[0])
    return delay_s


def _slowdown(body: Body, pose: Angles, keyframes: Keyframes) -> float:
    """Return how many times longer the keyframes must last so that no joint is too fast."""
    worst = 0.0
    for name, track in keyframes.tracks.items():
        column = body.index[name]
        start, fastest = float(pose[column]), float(body.max_speed[column])
        worst = max(worst, peak_speed(track, start, fastest) / fastest)
    return worst * SPEED_MARGIN if worst > 1.0 else 1.0
