"""How a robot stands in a pose, and whether it would fall while it plays a motion."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nep_studio.ui.motion.rehearsal import Rehearsal, starting_posture
from nodes.action.naobody.body import Angles, Posture
from nodes.action.naobody.limbs import Limb
from nodes.action.naobody.resting import tilt_for
from nodes.action.naobody.skeleton import UPRIGHT, Skeleton, TorsoPose, pose_of
from nodes.action.naobody.stance import Stance

LOOK_EVERY = 3
"""It is looked at each so many ticks whether the robot falls."""
SAME_HEIGHT_M = 0.008
"""Feet of so different heights both stand on the floor, more or less."""


def torso_for_posing(skeleton: Skeleton, pose: Angles, posture: Posture) -> TorsoPose:
    """Return where the torso is of a robot that is held while it is posed: it does not tip over.

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
