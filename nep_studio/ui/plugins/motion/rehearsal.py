"""What a robot will do when it plays a motion: every joint at every moment, what is too fast."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from nep_studio.blocks.own_animations import JointKeys, OwnAnimation
from nep_studio.ui.words import tr
from robots.body.body import Angles, Body, Posture
from robots.body.keyframes import Track, ticks, track_angles
from robots.body.kinematics import UPRIGHT, Skeleton, TorsoPose, pose_of
from robots.body.limbs import Limb
from robots.body.motion import SPEED_MARGIN, TICK_S
from robots.body.settling import tilt_for
from robots.body.stance import Stance

from .editing import key_times, with_times

USUAL_POSTURE = "Stand"
"""The posture that a motion is shown in which goes with any."""

TOO_FAST = 1.005
"""From this part of its top speed on a joint is called too fast."""

MOST_TRIES = 12
SHORTEST_STEP_S = 0.01

_Cached = dict[str, tuple[JointKeys, float, Angles]]


@dataclass(frozen=True)
class TooFast:
    """A joint that would have to move faster than it can, between two times (s), and by how much.

    ``ratio``: its speed there, as a multiple of its top speed.
    """

    joint: str
    from_s: float
    to_s: float
    ratio: float


@dataclass(frozen=True)
class Fault:
    """Where on the timeline something is wrong, and what, in words."""

    kind: Literal["fast", "fall"]
    from_s: float
    to_s: float
    words: str


LIMBS = (Limb.HEAD, Limb.LEFT_ARM, Limb.RIGHT_ARM, Limb.LEGS)
"""In the order of their rows on the timeline."""


def limb_words() -> dict[Limb, str]:
    """What the limbs are called, in the order of the rows."""
    words = (tr("Head"), tr("Left arm"), tr("Right arm"), tr("Legs"))
    return dict(zip(LIMBS, words, strict=True))


class Rehearsal:
    """A motion as angles: ``times`` (n,) from 0 on, ``angles`` (n, joints) in the body's order."""

    def __init__(self, body: Body, motion: OwnAnimation, cached: _Cached | None = None) -> None:
        self.body, self.motion = body, motion
        self.start = body.posture_angles(starting_posture(body, motion))
        self._cached = cached if cached is not None else {}
        duration_s = motion.duration_s
        self.times: Angles = (
            np.append(0.0, ticks(duration_s, TICK_S)) if duration_s else np.zeros(1)
        )
        angles = np.repeat(self.start[None, :], len(self.times), axis=0)
        for name, joint in self.motion.joints.items():
            if name in self.body.index:
                column = self.body.index[name]
                start = float(self.start[column])
                known = self._cached.get(name)
                if not known or known[:2] != (joint, start) or len(known[2]) < len(self.times):
                    track = Track(joint.times, joint.keys, joint.handles)
                    fastest = float(self.body.max_speed[column])
                    curve = np.append(start, track_angles(track, start, self.times[1:], fastest))
                    known = self._cached[name] = joint, start, curve
                angles[:, column] = known[2][: len(self.times)]
        self.wanted = angles
        self.angles, self.clamped = body.clamped(self.wanted)

    def again(self, motion: OwnAnimation) -> Rehearsal:
        """The rehearsal of a changed motion; what has not changed is not worked out again."""
        return Rehearsal(self.body, motion, self._cached)

    def pose(self, time: float) -> Angles:
        """The angles at a time; before the beginning and after the end those that are there."""
        place = float(np.clip(time, 0.0, self.times[-1])) / TICK_S
        low = min(int(place), len(self.times) - 1)
        high = min(low + 1, len(self.times) - 1)
        part = place - low if self.times[high] - self.times[low] >= TICK_S * 0.999 else 0.0
        pose: Angles = self.angles[low] + part * (self.angles[high] - self.angles[low])
        return pose

    def too_fast(self) -> list[TooFast]:
        """Where which joint would be too fast, from key to key, in the order of time."""
        steps_s = np.maximum(np.diff(self.times), SHORTEST_STEP_S / 2)[:, None]
        # How fast each joint is in each tick, as a multiple of its top speed: (n-1, joints)
        ratios = np.abs(np.diff(self.angles, axis=0)) / steps_s / self.body.max_speed
        found = []
        for start, end in pairwise([0.0, *key_times(self.motion)]):
            first = round(start / TICK_S)
            worst = ratios[first : max(round(end / TICK_S), first + 1)].max(axis=0, initial=0.0)
            for column in np.flatnonzero(worst > TOO_FAST):
                name = self.body.names[column]
                found.append(TooFast(name, start, end, float(worst[column])))
        return found


def starting_posture(body: Body, motion: OwnAnimation) -> str:
    """The posture in which a motion begins; the usual one when it goes with any."""
    return motion.starts_from if motion.starts_from in body.postures else USUAL_POSTURE


def given_time(rehearsal: Rehearsal) -> OwnAnimation:
    """The motion with all the time that its joints need, where they would be too fast."""
    for _ in range(MOST_TRIES):
        worst: dict[tuple[float, float], float] = {}
        for one in rehearsal.too_fast():
            gap = one.from_s, one.to_s
            worst[gap] = max(worst.get(gap, 0.0), one.ratio)
        if not worst:
            break
        rehearsal = rehearsal.again(_slowed(rehearsal.motion, worst))
    return rehearsal.motion


def _slowed(motion: OwnAnimation, factors: Mapping[tuple[float, float], float]) -> OwnAnimation:
    """Stretch what is between some keys; the times stay on the grid of hundredths."""
    edges = [0.0, *key_times(motion)]
    new, now = {}, 0.0
    for start, end in pairwise(edges):
        factor = factors.get((start, end), 1.0)
        gap = (end - start) * (factor * SPEED_MARGIN if factor > 1.0 else 1.0)
        now += max(gap, SHORTEST_STEP_S)
        new[end] = now = float(np.ceil(round(now * 100, 3)) / 100) if factor > 1.0 else now
    return with_times(motion, new)


# How a robot stands in a pose, and whether it would fall while it plays a motion.

LOOK_EVERY = 3
"""It is looked at each so many ticks whether the robot falls."""
SAME_HEIGHT_M = 0.008
"""Feet of so different heights both stand on the floor, more or less."""


def torso_for_posing(skeleton: Skeleton, pose: Angles, posture: Posture) -> TorsoPose:
    """Where the torso is of a robot that is held while it is posed: it does not tip over.

    Standing, its lower foot is flat on the floor.
    """
    if posture.down != UPRIGHT or not skeleton.soles:
        return skeleton.torso_over_floor(pose, down=posture.down)
    frames = skeleton.transforms(pose)
    feet = frames[[skeleton.index[foot] for foot in skeleton.soles]]
    weights = np.exp(-(feet[:, 2, 3] - feet[:, 2, 3].min()) / SAME_HEIGHT_M)
    down = -(weights[:, None] * feet[:, :3, 2]).sum(axis=0)
    turn = tilt_for(down / np.linalg.norm(down))
    lowest = float((skeleton.outline(frames) @ turn[2]).min())
    middle = turn @ skeleton.feet_middle(frames)
    return pose_of(turn, np.array([-middle[0], -middle[1], -lowest]))


def falling(skeleton: Skeleton, rehearsal: Rehearsal) -> Iterator[float | None]:
    """Go through a motion; give None at each look, and at last when the robot falls, if it does.

    A robot whose legs stay where they are is taken to keep its balance.
    """
    body, motion = rehearsal.body, rehearsal.motion
    if Limb.LEGS not in body.limbs_of(n for n in motion.joints if n in body.index):
        return
    posture = body.postures[starting_posture(body, motion)]
    stance = Stance(skeleton, rehearsal.start, posture.down)
    last_s = 0.0
    for row in range(0, len(rehearsal.times), LOOK_EVERY):
        time = float(rehearsal.times[row])
        stance.follow(rehearsal.angles[row], max(time - last_s, 1e-3))
        last_s = time
        if stance.has_lost_balance:
            yield time
            return
        yield None
