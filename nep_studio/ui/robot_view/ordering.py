"""Which part is drawn before which: farther ones first, where they cover each other."""

from __future__ import annotations

import heapq
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .camera import Lens
from .placed import Placed
from .silhouettes import Silhouettes

Array = NDArray[np.float64]
SAME_M = 5e-4


def drawing_order(
    placed: Placed, seen: Silhouettes, lens: Lens, wanted: NDArray[np.intp]
) -> list[int]:
    """The wanted parts from far to near.

    Of two parts that cover each other that one is farther whose surface is, in the middle of
    where they do; surfaces are those of the ellipsoids in their boxes.
    """
    first, second, places = _covering(seen.outlines[wanted])
    rays = lens.rays(places)
    far = _reach(placed, wanted[first], rays, lens) - _reach(placed, wanted[second], rays, lens)
    unsure = np.abs(far) < SAME_M
    depths = seen.depths[wanted]
    far[unsure] = (depths[first] - depths[second])[unsure]
    before = np.where(far > 0, first, second)
    after = np.where(far > 0, second, first)
    order = _sorted(depths, before.tolist(), after.tolist())
    return [int(part) for part in wanted[order]]


def _covering(outlines: Array) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """Pairs of parts whose boxes cover each other, and the pixels in the middle of where."""
    low, high = outlines.min(axis=1), outlines.max(axis=1)
    from_low = np.maximum(low[:, None], low[None])
    to_high = np.minimum(high[:, None], high[None])
    is_pair = (from_low < to_high).all(axis=2)
    first, second = np.nonzero(np.triu(is_pair, 1))
    return first, second, (from_low[first, second] + to_high[first, second]) / 2


def _reach(placed: Placed, parts: NDArray[np.intp], rays: Array, lens: Lens) -> Array:
    """How far along its ray the surface of a part is; where it passes by, the nearest point."""
    extent = placed.solids.extent[parts]
    turns = placed.turns[parts]
    to_eye = lens.camera.eye - placed.origins[parts]
    start = (np.einsum("pi,pij->pj", to_eye, turns) - placed.solids.middle[parts]) / extent
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
    left = sorted(range(count), key=lambda part: keys[part])
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
