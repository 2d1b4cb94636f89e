"""Where the floor carries a robot that moves: the zero-moment point of its animations.

Its feet or wheels stand flat on the floor, and every link counts with its mass and its inertia.
Source: M. Vukobratović, B. Borovac, Zero-moment point: thirty-five years of its life, Int. J. of
Humanoid Robotics 1, 2004.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from nao_capsules import BODY, inside
from numpy.typing import NDArray

from robots.body.animations import Animation
from robots.body.body import Angles, Body, Link
from robots.body.kinematics import Skeleton
from robots.body.motion import TICK_S, Motion, keyframe_motion, move
from robots.body.tasks import RETURN_SPEED

Points = NDArray[np.float64]
GRAVITY_M_S2 = 9.81
RESTING_TICKS = 30
"""It stands still for so long before and after."""


@dataclass(frozen=True)
class Stander:
    """A body that stands with some links on the floor: flat soles, or what its wheels touch.

    ``supports`` are places of links (m) that the floor carries, by link; the first link does not
    move over the floor.
    """

    body: Body
    supports: dict[str, Points]

    @cached_property
    def skeleton(self) -> Skeleton:
        return Skeleton(self.body)

    @cached_property
    def inertia(self) -> Points:
        links = self.body.links
        return np.stack([_inertia(links.get(name, Link())) for name in self.skeleton.links])

    def floor(self, frames: Points) -> Points:
        """The frame of the floor in the torso's: under the first link that stands on it."""
        link = next(iter(self.supports))
        floor = frames[:, self.skeleton.index[link]].copy()
        floor[:, :3, 3] += floor[:, :3, 2] * self.supports[link][0, 2]
        return floor

    def outlines(self, frames: Points) -> Points:
        """What it stands on (ticks, points, 2), seen on the floor."""
        places = [
            points @ np.swapaxes(frame[:, :3, :3], -1, -2) + frame[:, None, :3, 3]
            for link, points in self.supports.items()
            for frame in [frames[:, self.skeleton.index[link]]]
        ]
        return _seen(self.floor(frames), np.concatenate(places, axis=1))[:, :, :2]


def on_soles(body: Body) -> Stander:
    return Stander(body, dict(Skeleton(body).soles))


def on_wheels(body: Body, base: str) -> Stander:
    """A robot whose base touches the floor with its lowest round shapes."""
    shapes = np.array(body.links[base].hull_m)
    wheels = shapes[shapes[:, 2] - shapes[:, 3] < (shapes[:, 2] - shapes[:, 3]).min() + 1e-6]
    return Stander(body, {base: wheels[:, :3] - np.outer(wheels[:, 3], (0.0, 0.0, 1.0))})


NAO = on_soles(BODY)


def whole_play(animation: Animation, posture: str = "Stand", stander: Stander = NAO) -> Angles:
    """Every joint at every tick of playing an animation: from a posture, and back into it."""
    body = stander.body
    start = body.posture_angles(animation.starts_from or posture)
    there = keyframe_motion(body, start, animation.keyframes)
    rows = [np.repeat(start[None], RESTING_TICKS, axis=0), _rows(start, there)]
    columns = body.columns(body.limbs_of(animation.keyframes.tracks))
    back = move(body, rows[-1][-1], start, columns, speed=RETURN_SPEED)
    rows.append(_rows(rows[-1][-1], back))
    rows.append(np.repeat(rows[-1][-1:], RESTING_TICKS, axis=0))
    return np.concatenate(rows)


def _rows(pose: Angles, motion: Motion) -> Angles:
    rows = np.repeat(pose[None], len(motion.angles), axis=0)
    rows[:, motion.columns] = motion.angles
    return rows


def margins_m(angles: Angles, stander: Stander = NAO) -> Points:
    """How far (m) the zero-moment point is inside of what the robot stands on, at each tick."""
    outlines = stander.outlines(stander.skeleton.transforms(angles))
    return inside(outlines[1:-1], zero_moment_points(angles, stander))


def zero_moment_points(angles: Angles, stander: Stander = NAO) -> Points:
    """Where the floor carries the body (ticks - 2, 2), m, seen from its first supporting link."""
    frames = stander.skeleton.transforms(angles)
    floor = stander.floor(frames)
    turns = np.swapaxes(floor[:, None, :3, :3], -1, -2) @ frames[..., :3, :3]
    places = _seen(floor, stander.skeleton.mass_centres(frames))
    masses = stander.skeleton.masses_kg
    pull = np.diff(places, 2, axis=0) / TICK_S**2 + (0.0, 0.0, GRAVITY_M_S2)
    swing = _swing(turns, stander.inertia)
    x, y, z = np.moveaxis(places[1:-1], -1, 0)
    ahead, aside, up = np.moveaxis(pull, -1, 0)
    weight = (masses * up).sum(axis=1)
    zmp_x = (masses * (x * up - z * ahead)).sum(axis=1) - swing[:, 1]
    zmp_y = (masses * (y * up - z * aside)).sum(axis=1) + swing[:, 0]
    return np.stack([zmp_x, zmp_y], axis=1) / weight[:, None]


def _swing(turns: Points, inertias: Points) -> Points:
    """How fast the angular momentum of all links about their own centres changes (ticks - 2, 3)."""
    steps = turns[1:] @ np.swapaxes(turns[:-1], -1, -2)
    twist = steps - np.swapaxes(steps, -1, -2)
    speed = np.stack([twist[..., 2, 1], twist[..., 0, 2], twist[..., 1, 0]], axis=-1) / 2 / TICK_S
    inertia = turns[1:] @ inertias @ np.swapaxes(turns[1:], -1, -2)
    momentum = (inertia @ speed[..., None])[..., 0].sum(axis=1)
    return np.diff(momentum, axis=0) / TICK_S


def _inertia(link: Link) -> Points:
    xx, yy, zz, xy, xz, yz = link.inertia_kg_m2
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _seen(floor: Points, places: Points) -> Points:
    return (places - floor[:, None, :3, 3]) @ floor[:, :3, :3]
