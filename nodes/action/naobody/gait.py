"""NAO's walk as a movement of its legs and a path of its body over the floor.

A plain periodic gait: one foot swings forward in an arc while the other stays where it stands, and
the body moves on evenly between them, so that standing feet do not slide. Balance is not modelled.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nodes.action.naobody.body import Angles, Body
from nodes.action.naobody.curves import minimum_jerk, smooth_slopes, ticks
from nodes.action.naobody.motion import TICK_S, Motion

STEP_S = 0.42
"""Time of a step at NAO's highest step frequency. With the step lengths below: 0.095 m/s forward,
0.071 m/s sideways, 0.48 rad/s turning. Source: NAO documentation, ALMotion walk parameters."""
STEP_FORWARD_M = 0.04
STEP_LEFT_M = 0.03
STEP_TURN_RAD = 0.2

FOOT_LIFT_M = 0.02
SWAY_RAD = 0.06
THIGH_M = 0.1
SHIN_M = 0.1029
HIP_HALF_WIDTH_M = 0.05
HIP_YAW_PITCH_PART = math.sqrt(0.5)
"""The hip's yaw-pitch axis is tilted by 45 degrees: this part of it turns, the same part nods."""


@dataclass(frozen=True)
class Walk:
    """A walk: the legs' movement, and for each of its ticks the base's x m, y m, theta rad.

    The base path (ticks, 3) is relative to where the walk starts, x pointing forward.
    """

    legs: Motion
    base: Angles


@dataclass(frozen=True)
class _Foot:
    """Where a foot is under its hip, at every tick: lengths m, yaw rad, relative to standing."""

    forward: Angles
    left: Angles
    lift: Angles
    yaw: Angles


def plan_walk(
    body: Body,
    standing: Angles,
    forward_m: float,
    left_m: float,
    turn: float,
    *,
    at_least_steps: int = 1,
) -> Walk:
    """Return the walk by so many m forward and left, turning ``turn`` rad evenly on the way.

    ``standing``: the angles of every joint in the posture that it starts and ends in, feet flat.
    """
    way = np.array([forward_m, left_m, turn])
    steps = max(at_least_steps, math.ceil(float(np.max(np.abs(way) / _LONGEST_STEP)) - 1e-9))
    times_s = ticks((steps + 1) * STEP_S, TICK_S)
    progress = _body_progress(times_s, steps)
    step = way / steps
    left = _foot(progress, _foot_progress(times_s, steps, first=0), step, HIP_HALF_WIDTH_M)
    right = _foot(progress, _foot_progress(times_s, steps, first=1), step, -HIP_HALF_WIDTH_M)
    angles = np.repeat(standing[None, :], len(times_s), axis=0)
    sway = _sway(times_s, steps)
    _pose_legs(body, angles, left, right, sway)
    columns = tuple(i for i, joint in enumerate(body.joints) if joint.limb == "legs")
    allowed, _ = body.clamped(angles)
    return Walk(Motion(columns, allowed[:, columns]), _base_path(progress, step, sway))


_LONGEST_STEP = np.array([STEP_FORWARD_M, STEP_LEFT_M, STEP_TURN_RAD])


def _body_progress(times_s: Angles, steps: int) -> Angles:
    """Return how many step lengths the body has gone: half of one in the first and last step."""
    knots = np.arange(steps + 2, dtype=np.float64) * STEP_S
    values = np.concatenate([[0.0], np.arange(steps) + 0.5, [float(steps)]])
    return _smooth(knots, values, times_s)


def _foot_progress(times_s: Angles, steps: int, *, first: int) -> tuple[Angles, Angles]:
    """Return how many step lengths a foot has gone, and how high it is (0 to 1), at each time.

    The foot swings in every second step, from step ``first`` on; the last step joins the feet.
    """
    place, height = np.zeros_like(times_s), np.zeros_like(times_s)
    here = 0.0
    for swing in range(first, steps + 1, 2):
        s = np.clip(times_s / STEP_S - swing, 0.0, 1.0)
        landing = float(min(swing + 1, steps))
        place += (landing - here) * minimum_jerk(s)
        height += np.sin(np.pi * s) ** 2
        here = landing
    return place, height


def _foot(progress: Angles, foot: tuple[Angles, Angles], step: Angles, hip_left_m: float) -> _Foot:
    ahead = foot[0] - progress
    yaw = ahead * step[2]
    return _Foot(
        forward=ahead * step[0] - hip_left_m * np.sin(yaw),
        left=ahead * step[1],
        lift=foot[1] * FOOT_LIFT_M,
        yaw=yaw,
    )


def _sway(times_s: Angles, steps: int) -> Angles:
    """Return how far the body leans (rad) over the standing foot: right first, then left."""
    step = np.minimum(np.floor(times_s / STEP_S), steps)
    side = np.where(step % 2 == 0, 1.0, -1.0)
    lean: Angles = SWAY_RAD * side * np.sin(np.pi * (times_s / STEP_S - step)) ** 2
    return lean


def _base_path(progress: Angles, step: Angles, sway: Angles) -> Angles:
    path = progress[:, None] * step
    lean_m = (THIGH_M + SHIN_M) * np.sin(sway)
    path[:, 0] += lean_m * np.sin(path[:, 2])
    path[:, 1] -= lean_m * np.cos(path[:, 2])
    return path


def _pose_legs(body: Body, angles: Angles, left: _Foot, right: _Foot, sway: Angles) -> None:
    """Write the leg joints of every tick into ``angles`` (ticks, joints)."""
    # One motor turns both hips: equal and opposite for the two feet.
    yaw_pitch = -(left.yaw - right.yaw) / 2.0 / HIP_YAW_PITCH_PART
    angles[:, body.index["LHipYawPitch"]] += yaw_pitch
    for side, foot in (("L", left), ("R", right)):
        joints = [body.index[f"{side}{name}"] for name in ("HipPitch", "KneePitch", "AnklePitch")]
        hip, knee, ankle = (angles[:, joint] for joint in joints)
        tilt = -(hip + knee + ankle)  # of the torso, which leans when the feet are flat
        ahead = -THIGH_M * np.sin(hip + tilt) - SHIN_M * np.sin(hip + tilt + knee)
        below = THIGH_M * np.cos(hip + tilt) + SHIN_M * np.cos(hip + tilt + knee)
        hip, knee = _bent_leg(ahead + foot.forward, below - foot.lift)
        nod = yaw_pitch * HIP_YAW_PITCH_PART
        angles[:, joints] = np.column_stack([hip - tilt - nod, knee, -hip - knee])
        roll = np.arctan2(foot.left, below) + sway
        angles[:, body.index[f"{side}HipRoll"]] += roll
        angles[:, body.index[f"{side}AnkleRoll"]] -= roll


def _bent_leg(forward: Angles, down: Angles) -> tuple[Angles, Angles]:
    """Return hip and knee pitch that put the ankle so far in front of the hip and below it (m)."""
    reach = np.minimum(np.hypot(forward, down), THIGH_M + SHIN_M)
    cosine = (reach**2 - THIGH_M**2 - SHIN_M**2) / (2.0 * THIGH_M * SHIN_M)
    knee = np.arccos(np.clip(cosine, -1.0, 1.0))
    ahead_of_shin = np.arctan2(SHIN_M * np.sin(knee), THIGH_M + SHIN_M * np.cos(knee))
    return -np.arctan2(forward, down) - ahead_of_shin, knee


def _smooth(knots: Angles, values: Angles, times_s: Angles) -> Angles:
    """Return a smooth rising curve through values at knots (cubic Hermite, no overshoot)."""
    slopes = smooth_slopes(knots, values)
    piece = np.clip(np.searchsorted(knots, times_s, side="right") - 1, 0, len(knots) - 2)
    step = knots[piece + 1] - knots[piece]
    s = np.clip((times_s - knots[piece]) / step, 0.0, 1.0)
    rise = values[piece + 1] - values[piece]
    bend = (1.0 - s) * slopes[piece] * step - s * slopes[piece + 1] * step
    curve: Angles = values[piece] + rise * s**2 * (3.0 - 2.0 * s) + s * (1.0 - s) * bend
    return curve
