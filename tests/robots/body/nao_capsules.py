"""NAO's arms, trunk, head and thighs as round shapes: do they pass through each other?"""

from __future__ import annotations

import numpy as np
from nao_skeleton import NAO
from numpy.typing import NDArray

from robots.body.body import Angles, load_body
from robots.body.kinematics import Skeleton

BODY = load_body(NAO)
SKELETON = Skeleton(BODY)
Points = NDArray[np.float64]
PLACES = 13
"""So many points along a limb are looked at."""

TRUNK = [
    ((0.0, 0.04, 0.085), (0.0, 0.03, -0.06), 0.046),
    ((0.0, -0.04, 0.085), (0.0, -0.03, -0.06), 0.046),
    ((0.004, 0.0, 0.085), (0.004, 0.0, -0.06), 0.046),
]
HEAD = [((0.0, 0.0, 0.05), (0.005, 0.0, 0.06), 0.06), ((0.0, 0.05, 0.06), (0.0, -0.05, 0.06), 0.03)]
THIGH = [((0.0, 0.0, -0.02), (0.0, 0.0, -0.09), 0.04)]
STILL = {"torso": TRUNK, "Head": HEAD, "LThigh": THIGH, "RThigh": THIGH}
"""Segments and radii (m) in the frames of their links."""

ARM = [("ForeArm", 0.02, 0.05, 0.026), ("_wrist", 0.0, 0.085, 0.02)]
"""Segments along x in the frames of their links, and radii."""

ALLOWED_M = 0.014
"""A hand may press so much on what it touches: shells are rounder than these shapes."""


def depths(angles: Angles) -> dict[str, float]:
    """How far (m) arms are inside of other parts at the worst moment; below 0: air between."""
    frames = SKELETON.frames(angles)
    found = {}
    for side in "LR":
        arm, arm_radii = _along_arm(frames, side)
        for link, segments in STILL.items():
            gaps = [
                _distances(arm, _placed(frames[link], a), _placed(frames[link], b))
                - arm_radii
                - radius
                for a, b, radius in segments
            ]
            found[f"{side} arm in {link}"] = -float(np.min(gaps))
    left, radii = _along_arm(frames, "L")
    right, _ = _along_arm(frames, "R")
    apart = np.linalg.norm(left[:, :, None] - right[:, None, :], axis=-1)
    gaps = apart - radii[:, None] - radii[None, :]
    gaps[:, PLACES:, PLACES:] = np.inf  # hands may hold each other
    found["arm in arm"] = -float(gaps.min())
    return found


def balance_m(angles: Angles) -> float:
    """How far (m) the centre of mass stays within the outline of the feet, at the worst moment.

    Both feet stand flat on the floor.
    """
    frames = SKELETON.transforms(angles)
    foot = frames[:, SKELETON.index["L_ankle"]]
    soles = np.concatenate([SKELETON.sole(frames, side) for side in ("L_ankle", "R_ankle")], axis=1)
    soles = _in_frame(foot, soles)
    centre = _in_frame(foot, SKELETON.mass_centre(frames)[:, None])[:, 0]
    return float(inside(soles[:, :, :2], centre[:, :2]).min())


def inside(points: Points, places: Points) -> Points:
    """How far places are inside of the convex outlines of points: by all their supporting lines."""
    ways = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
    normals = np.stack([np.cos(ways), np.sin(ways)])
    return ((points @ normals).max(axis=1) - places @ normals).min(axis=1)


def _in_frame(frame: Points, points: Points) -> Points:
    return (points - frame[:, None, :3, 3]) @ frame[:, :3, :3]


def _along_arm(frames: dict[str, Points], side: str) -> tuple[Points, Points]:
    points, radii = [], []
    for link, start, end, radius in ARM:
        for x in np.linspace(start, end, PLACES):
            points.append(_placed(frames[side + link], (x, 0.0, 0.0)))
            radii.append(radius)
    return np.stack(points, axis=1), np.array(radii)


def _placed(frame: Points, point: tuple[float, float, float]) -> Points:
    return frame[:, :3, :3] @ np.array(point) + frame[:, :3, 3]


def _distances(points: Points, start: Points, end: Points) -> Points:
    """Distances (ticks, points) of points from a segment."""
    way = (end - start)[:, None]
    part = np.clip(((points - start[:, None]) * way).sum(-1) / (way * way).sum(-1), 0.0, 1.0)
    return np.linalg.norm(points - start[:, None] - part[..., None] * way, axis=-1)
