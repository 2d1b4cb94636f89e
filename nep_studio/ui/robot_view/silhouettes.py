"""Where the outlines of placed parts are on a picture, and the ellipse that shades each."""

from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QByteArray, QDataStream
from PySide6.QtGui import QPolygonF

from .camera import BEFORE_EYE_M, Lens
from .figure import Placed

Array = NDArray[np.float64]
CORNERS = ((1000.0, 32), (4000.0, 64), (math.inf, 128))
"""Up to so many pixels a m, outlines have so many corners: as many as look round."""


@dataclass(frozen=True, eq=False)
class Silhouettes:
    """Outlines of parts on a picture, in pixels."""

    outlines: Array
    """(parts, k, 2); point k is the farthest in direction k, so an outline grows along it."""
    ways: Array
    """(k, 2) the directions."""
    centres: Array
    """(parts, 2) the middle of the ellipse nearest to each outline."""
    stretches: Array
    """(parts, 2, 2) symmetric: from the unit circle to that ellipse."""
    depths: Array
    """(parts,) how far before the eye their middles are, m."""
    is_seen: NDArray[np.bool_]
    ratio: float = 1.0
    """How many real pixels there are for one."""


def silhouettes(placed: Placed, lens: Lens) -> Silhouettes:
    """Find the outlines of all parts at once."""
    middles = placed.middles()
    depths = lens.depths(middles)
    px_per_m = lens.ratio * lens.scale / max(float(depths.min(initial=50.0)), 0.05)
    count = next(corners for most, corners in CORNERS if px_per_m <= most)
    turns = np.arange(count) * (2 * math.pi / count)
    ways = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    slopes = lens.slopes(middles)
    outlines = lens.project(placed.farthest(ways @ slopes))
    centres, stretches = _ellipses(outlines, ways)
    is_inside = (outlines.max(axis=1) > 0) & (outlines.min(axis=1) < (lens.width, lens.height))
    is_seen = (depths > BEFORE_EYE_M) & is_inside.all(axis=1)
    return Silhouettes(outlines, ways, centres, stretches, depths, is_seen, lens.ratio)


def _ellipses(outlines: Array, ways: Array) -> tuple[Array, Array]:
    """The ellipses whose widths in all directions are the nearest to those of the outlines.

    The width of an ellipse with the matrix A is the root of u A u in a direction u; its first
    waves over all directions give A at once.
    """
    reach = np.einsum("pkc,kc->pk", outlines, ways)
    centres = 2 * reach @ ways / len(ways)
    half = len(ways) // 2
    width = (reach[:, :half] + reach[:, half:]) / 2
    square = width * width
    cos2 = ways[:half, 0] ** 2 - ways[:half, 1] ** 2
    sin2 = 2 * ways[:half, 0] * ways[:half, 1]
    mean, c, s = square.mean(axis=1), 2 * (square @ cos2) / half, 2 * (square @ sin2) / half
    limit = 0.98 * mean / np.maximum(np.hypot(c, s), 1e-12)
    c, s = c * np.minimum(limit, 1), s * np.minimum(limit, 1)
    a, b, d = mean + c, s, mean - c
    root = np.sqrt(np.maximum(a * d - b * b, 1e-12))
    trace = np.sqrt(a + d + 2 * root)
    matrix = np.stack([np.stack([a + root, b], axis=1), np.stack([b, d + root], axis=1)], axis=1)
    return centres, matrix / np.maximum(trace, 1e-9)[:, None, None]


# Which part is drawn before which: farther ones first, where they cover each other.

SAME_M = 5e-4


def drawing_order(
    placed: Placed, seen: Silhouettes, lens: Lens, wanted: NDArray[np.intp]
) -> list[int]:
    """The wanted parts from far to near.

    Of two parts that cover each other that one is farther whose surface is, in the middle of
    where they do; surfaces are those of the ellipsoids in their boxes.
    """
    # Pairs of parts whose boxes cover each other, and the rays to the middle of where they do.
    low, high = seen.outlines[wanted].min(axis=1), seen.outlines[wanted].max(axis=1)
    from_low, to_high = np.maximum(low[:, None], low), np.minimum(high[:, None], high)
    first, second = np.nonzero(np.triu((from_low < to_high).all(axis=2), 1))
    rays = lens.rays((from_low[first, second] + to_high[first, second]) / 2)
    far = _reach(placed, wanted[first], rays, lens) - _reach(placed, wanted[second], rays, lens)
    unsure = np.abs(far) < SAME_M
    depths = seen.depths[wanted]
    far[unsure] = (depths[first] - depths[second])[unsure]
    before = np.where(far > 0, first, second)
    after = np.where(far > 0, second, first)
    order = _sorted(depths, before.tolist(), after.tolist())
    return [int(part) for part in wanted[order]]


def _reach(placed: Placed, parts: NDArray[np.intp], rays: Array, lens: Lens) -> Array:
    """How far along its ray the surface of a part is; where it passes by, the nearest point."""
    extent, middle = placed.assembly.solids.extent[parts], placed.assembly.solids.middle[parts]
    turns = placed.turns[parts]
    to_eye = lens.eye - placed.origins[parts]
    start = (np.einsum("pi,pij->pj", to_eye, turns) - middle) / extent
    way = np.einsum("pi,pij->pj", rays, turns) / extent
    a = np.einsum("pi,pi->p", way, way)
    b = np.einsum("pi,pi->p", way, start)
    c = np.einsum("pi,pi->p", start, start) - 1
    reach: Array = (-b - np.sqrt(np.maximum(b * b - a * c, 0))) / a
    return reach


def _sorted(depths: Array, before: Sequence[int], after: Sequence[int]) -> list[int]:
    """Sort so that pairs keep their order; where they go in a circle, by depth."""
    count = len(depths)
    followers: list[list[int]] = [[] for _ in range(count)]
    waits = [0] * count
    for one, other in zip(before, after, strict=True):
        followers[one].append(other)
        waits[other] += 1
    keys = (-depths).tolist()
    ready = [(keys[part], part) for part in range(count) if not waits[part]]
    heapq.heapify(ready)
    left = np.argsort(-depths, kind="stable").tolist()
    order: list[int] = []
    done = [False] * count
    while len(order) < count:
        # Where all that are left wait for each other, the farthest goes first.
        part = heapq.heappop(ready)[1] if ready else next(one for one in left if not done[one])
        if done[part]:
            continue
        done[part] = True
        order.append(part)
        for other in followers[part]:
            waits[other] -= 1
            if waits[other] == 0 and not done[other]:
                heapq.heappush(ready, (keys[other], other))
    return order


# Outlines in numpy as polygons of Qt, all at once.

MANY_PX, SOME_PX = 34.0, 11.0
"""Parts that are larger than this have all corners, or half of them."""


def polygons(outlines: NDArray[np.float64]) -> list[QPolygonF]:
    """The outlines (n, k, 2) as n polygons.

    Qt reads them from its own binary form, which is ten times faster than making each point.
    """
    count, corners = outlines.shape[:2]
    rows = np.empty((count, 4 + 16 * corners), np.uint8)
    rows[:, :4] = np.frombuffer(np.array([corners], ">u4").tobytes(), np.uint8)
    rows[:, 4:] = np.ascontiguousarray(outlines, ">f8").reshape(count, 2 * corners).view(np.uint8)
    stream = QDataStream(QByteArray(rows.tobytes()))
    made = []
    for _ in range(count):
        polygon = QPolygonF()
        stream >> polygon
        made.append(polygon)
    return made


def fitting_polygons(outlines: NDArray[np.float64], sizes: NDArray[np.float64]) -> list[QPolygonF]:
    """The outlines (n, k, 2) as polygons, the smaller ones (sizes (n,), pixels) with less corners.

    Painting a polygon takes as long as it has corners, and most parts of a robot are small.
    """
    made: list[QPolygonF] = [QPolygonF()] * len(outlines)
    steps = np.digitize(-sizes, [-MANY_PX, -SOME_PX])
    for step in range(3):
        numbers = np.flatnonzero(steps == step)
        for number, polygon in zip(
            numbers.tolist(), polygons(outlines[numbers, :: 1 << step]), strict=True
        ):
            made[number] = polygon
    return made
