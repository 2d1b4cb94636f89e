"""How a stiff body comes to rest on the floor: it tips over the edges that it stands on.

Points (n, 3) are a body's outermost ones, in m from its centre of mass, as it turns with the body.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Rotation = NDArray[np.float64]
"""From the body's frame to the room's (3, 3)."""

TOUCHING_M = 2e-5
"""Points that are so little above the lowest one touch the floor too."""
STEADY_M = 1e-6
MOST_TIPPINGS = 60


def tipped(points: Points, turn: Rotation, at_most_rad: float) -> tuple[Rotation, float]:
    """Let a body tip by at most an angle (inf: until it is steady).

    Return how it is turned, and how much of that angle is left.

    Something is left when the body has become steady.
    """
    left_rad = at_most_rad
    for _ in range(MOST_TIPPINGS):
        places = points @ turn.T
        # Of the body's support on the floor what is nearest to below its centre
        heights = places[:, 2]
        lowest = float(heights.min())
        nearest = np.array([*nearest_in_hull(places[heights < lowest + TOUCHING_M, :2]), lowest])
        away = math.hypot(nearest[0], nearest[1])
        if away < STEADY_M:
            return turn, left_rad
        towards = -nearest[:2] / away
        # How far a body tips about its support until the next point touches the floor
        ahead = (places[:, :2] - nearest[:2]) @ towards
        above = places[:, 2] - nearest[2]
        free = above >= TOUCHING_M
        angles = np.arctan2(above[free], ahead[free])
        angle = min(float(angles.min(initial=math.pi)), left_rad)
        # The rotation that tips what is up towards a horizontal direction
        x, y = towards
        cosine, sine = math.cos(angle), math.sin(angle)
        rest = 1.0 - cosine
        tip = [
            [1.0 - rest * x * x, -rest * x * y, sine * x],
            [-rest * x * y, 1.0 - rest * y * y, sine * y],
            [-sine * x, -sine * y, cosine],
        ]
        turn = np.array(tip) @ turn
        left_rad -= angle
        if left_rad <= 0.0:
            return turn, 0.0
    return turn, left_rad


def nearest_in_hull(feet: Points) -> tuple[float, float]:
    """Return what is nearest to (0, 0) of the convex hull of points (n, 2)."""
    corners = hull(feet)
    if len(corners) > 2 and inside_by(corners) >= 0.0:
        return 0.0, 0.0
    starts, ends = corners, np.roll(corners, -1, axis=0)
    ways = ends - starts
    lengths = np.maximum((ways**2).sum(axis=1), 1e-18)
    parts = np.clip(-(starts * ways).sum(axis=1) / lengths, 0.0, 1.0)
    nearest = starts + parts[:, None] * ways
    x, y = nearest[int((nearest**2).sum(axis=1).argmin())]
    return float(x), float(y)


def inside_by(corners: Points, place: tuple[float, float] = (0.0, 0.0)) -> float:
    """Return how far (m) a place is inside a convex outline; below 0 when it is outside.

    ``corners`` (n, 2) go round against the clock.
    """
    ways = np.roll(corners, -1, axis=0) - corners
    to_place = np.array(place) - corners
    across = ways[:, 0] * to_place[:, 1] - ways[:, 1] * to_place[:, 0]
    return float((across / np.maximum(np.hypot(ways[:, 0], ways[:, 1]), 1e-12)).min())


def hull(points: Points) -> Points:
    """Return the corners of the convex hull of points (n, 2), against the clock.

    Source: A. M. Andrew, Another efficient algorithm for convex hulls, Inf. Proc. Letters 9, 1979.
    """
    ordered = sorted(set(map(tuple, points.tolist())))
    if len(ordered) < 3:
        return np.array(ordered)
    return np.array(_chain(ordered)[:-1] + _chain(ordered[::-1])[:-1])


def _chain(points: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
    chain: list[tuple[float, ...]] = []
    for x, y in points:
        while len(chain) > 1:
            (ax, ay), (bx, by) = chain[-2], chain[-1]
            if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0:
                break
            chain.pop()
        chain.append((x, y))
    return chain


def tilt_for(down: Points) -> Rotation:
    """Return the rotation that turns a direction of the body's frame downwards, the short way."""
    x, y, z = down / np.linalg.norm(down)
    across = np.array([-y, x, 0.0])  # the axis: down cross (0, 0, -1)
    sine, cosine = math.hypot(x, y), -z
    if sine < 1e-9:
        return np.eye(3) if cosine > 0.0 else np.diag([1.0, -1.0, -1.0])
    a, b, _ = across / sine
    cross = np.array([[0.0, 0.0, b], [0.0, 0.0, -a], [-b, a, 0.0]])
    return np.asarray(np.eye(3) + sine * cross + (1.0 - cosine) * cross @ cross)
