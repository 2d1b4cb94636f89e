"""Where the rays of a camera meet simple shapes: balls, upright posts, boxes and discs."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nodes.action.naobody.skeleton import Points

Pixels = NDArray[np.float32]
"""A number, or several, for each pixel of a picture or of a part of it."""
NEAREST = 1e-3


class Hit(NamedTuple):
    """How many lengths of each ray it is to a shape (inf: not met), and which way it faces there.

    ``ways``: (rows, columns); ``faces``: (rows, columns, 3), of length 1.
    """

    ways: Pixels
    faces: Pixels


def places(eye: Points, rays: Pixels, ways: Pixels) -> Pixels:
    """Return where rays are after so many of their lengths, seen from a place; 0 for inf."""
    reached = np.where(np.isfinite(ways), ways, 0.0)[..., None]
    found: Pixels = (eye + rays * reached).astype(np.float32)
    return found


def ball(eye: Points, rays: Pixels, centre: Points, radius: float) -> Hit:
    """Return where rays from an eye meet a ball."""
    start = eye - centre
    ways = _first_way(
        (rays**2).sum(-1), (rays @ start).astype(np.float32), float(start @ start) - radius**2
    )
    return Hit(ways, places(start, rays, ways) / np.float32(radius))


def post(eye: Points, rays: Pixels, foot: Points, height: float, radius: float) -> Hit:
    """Return where rays from an eye meet a round post; it has no lid."""
    start = eye - foot
    flat, flat_rays = start[:2], rays[..., :2]
    nearness = float(flat @ flat) - radius**2
    ways = _first_way((flat_rays**2).sum(-1), (flat_rays @ flat).astype(np.float32), nearness)
    met = places(start, rays, ways)
    is_met = (met[..., 2] >= 0.0) & (met[..., 2] <= height)
    met[..., 2] = 0.0
    return Hit(np.where(is_met, ways, np.inf).astype(np.float32), met / np.float32(radius))


def box(eye: Points, rays: Pixels, centre: Points, heading: float, half: Points) -> Hit:
    """Return where rays from an eye meet a box, half as large as ``half``, turned on the floor."""
    turn = _turned(heading)
    start, into = (eye - centre) @ turn, rays @ turn
    safe = np.where(np.abs(into) < 1e-9, 1e-9, into)
    first, last = (-half - start) / safe, (half - start) / safe
    enters = np.minimum(first, last)
    axis = enters.argmax(axis=-1)
    way, leaves = enters.max(axis=-1), np.maximum(first, last).min(axis=-1)
    is_met = (way <= leaves) & (way > NEAREST)
    sides = np.eye(3)[axis] * -np.sign(safe)
    ways = np.where(is_met, way, np.inf).astype(np.float32)
    return Hit(ways, (sides @ turn.T).astype(np.float32))


def disc(eye: Points, rays: Pixels, centre: Points, heading: float, radius: float) -> Hit:
    """Return where rays from an eye meet an upright disc; it faces where it heads, both sides."""
    ahead = np.array([math.cos(heading), math.sin(heading), 0.0])
    start, towards = eye - centre, rays @ ahead
    safe = np.where(np.abs(towards) < 1e-9, 1e-9, towards)
    ways = (-float(start @ ahead) / safe).astype(np.float32)
    met = places(start, rays, ways)
    is_met = (ways > NEAREST) & ((met**2).sum(-1) <= radius**2)
    facing = np.broadcast_to(ahead.astype(np.float32), rays.shape)
    return Hit(np.where(is_met, ways, np.inf).astype(np.float32), facing)


def on_disc(hit: Hit, eye: Points, rays: Pixels, centre: Points, heading: float) -> Pixels:
    """Return where on a disc rays meet it: m to the right of who looks at it, and up."""
    met = places(eye - centre, rays, hit.ways)
    right = met[..., :2] @ np.array([-math.sin(heading), math.cos(heading)])
    return np.stack([right, met[..., 2]], axis=-1).astype(np.float32)


def _turned(heading: float) -> Points:
    cosine, sine = math.cos(heading), math.sin(heading)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def _first_way(square: Pixels, towards: Pixels, rest: float) -> Pixels:
    """Solve square * way² + 2 * towards * way + rest = 0 for the first way ahead, or inf."""
    under = towards**2 - square * rest
    with np.errstate(invalid="ignore", divide="ignore"):
        way = (-towards - np.sqrt(under)) / square
    is_met = (under > 0.0) & (way > NEAREST)
    return np.where(is_met, way, np.inf).astype(np.float32)
