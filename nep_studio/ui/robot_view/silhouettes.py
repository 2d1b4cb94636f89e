"""Where the outlines of placed parts are on a picture, and the ellipse that shades each."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .camera import BEFORE_EYE_M, Lens
from .placed import Placed

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

    def grown(self, pixels: float) -> Array:
        """The outlines, wider by some pixels."""
        wider: Array = self.outlines + pixels * self.ways
        return wider


def silhouettes(placed: Placed, lens: Lens) -> Silhouettes:
    """Find the outlines of all parts at once."""
    middles = placed.middles()
    depths = lens.depths(middles)
    px_per_m = lens.ratio * lens.scale / max(float(depths.min(initial=50.0)), 0.05)
    count = next(corners for most, corners in CORNERS if px_per_m <= most)
    turns = np.arange(count) * (2 * math.pi / count)
    ways = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    slopes = lens.slopes(middles)
    local = ways @ (slopes @ placed.turns)
    points = placed.solids.farthest(local)
    world = placed.origins[:, None] + points @ placed.turns.transpose(0, 2, 1)
    outlines = lens.project(world)
    centres, stretches = _ellipses(outlines, ways)
    is_seen = (depths > BEFORE_EYE_M) & _is_inside(outlines, lens)
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


def _is_inside(outlines: Array, lens: Lens) -> NDArray[np.bool_]:
    low, high = outlines.min(axis=1), outlines.max(axis=1)
    inside: NDArray[np.bool_] = (high > 0).all(axis=1) & (low < (lens.width, lens.height)).all(
        axis=1
    )
    return inside
