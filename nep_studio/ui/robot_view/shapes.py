"""Rounded convex shapes in numpy: how far they reach in any direction.

A part of a robot is the hull of a few superellipsoids (:class:`Solids`). Its farthest point in a
direction has a closed form, which gives smooth outlines for painting and meshes with exact normals.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True)
class Blob:
    """One superellipsoid along the axes of its part; m.

    The powers say how round it is across its z axis and along it: 2 round, 4 a soft box, 8 a box.
    """

    at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    size: tuple[float, float, float] = (0.01, 0.01, 0.01)
    powers: tuple[float, float] = (2.0, 2.0)


@dataclass(frozen=True, eq=False)
class Solids:
    """The shapes of some parts, each the hull of the blobs that have its number in ``owner``."""

    owner: Indices
    centre: Array
    size: Array
    powers: Array
    table: Indices = field(repr=False)
    """Blobs by part, (parts, most blobs of a part); short rows repeat their last blob."""
    middle: Array = field(repr=False)
    extent: Array = field(repr=False)
    """The middle and the half lengths of the box around each part, along its axes."""

    @classmethod
    def of(cls, parts: Sequence[Sequence[Blob]]) -> Solids:
        """Put the blobs of parts into arrays."""
        blobs = [blob for part in parts for blob in part]
        owner = np.array([i for i, part in enumerate(parts) for _ in part], dtype=np.intp)
        centre = np.array([blob.at for blob in blobs], dtype=np.float64).reshape(-1, 3)
        size = np.array([blob.size for blob in blobs], dtype=np.float64).reshape(-1, 3)
        powers = np.array([blob.powers for blob in blobs], dtype=np.float64).reshape(-1, 2)
        return cls._boxed(owner, centre, size, powers, len(parts))

    @classmethod
    def joined(cls, many: Sequence[Solids]) -> Solids:
        """All parts of several, one after the other."""
        starts = np.cumsum([0, *(len(one.middle) for one in many)])
        owner = np.concatenate(
            [one.owner + start for one, start in zip(many, starts, strict=False)]
        )
        centre, size, powers = (
            np.concatenate([getattr(one, name) for one in many])
            for name in ("centre", "size", "powers")
        )
        return cls._boxed(owner, centre, size, powers, int(starts[-1]))

    def only(self, numbers: Indices) -> Solids:
        """Some of the parts, in the order of their numbers."""
        kept = np.isin(self.owner, numbers)
        owner = np.searchsorted(numbers, self.owner[kept])
        parts = (self.centre[kept], self.size[kept], self.powers[kept])
        return self._boxed(owner.astype(np.intp), *parts, len(numbers))

    @classmethod
    def _boxed(
        cls, owner: Indices, centre: Array, size: Array, powers: Array, count: int
    ) -> Solids:
        first = np.searchsorted(owner, np.arange(count))
        counts = np.bincount(owner, minlength=count)
        most = int(counts.max(initial=1))
        table = first[:, None] + np.minimum(np.arange(most), counts[:, None] - 1)
        low = (centre - size)[table].min(axis=1)
        high = (centre + size)[table].max(axis=1)
        return cls(owner, centre, size, powers, table, (low + high) / 2, (high - low) / 2)

    def farthest(self, directions: Array) -> Array:
        """The farthest points (parts, k, 3) in directions (parts, k, 3), along each part's axes."""
        ways = directions[self.owner]
        points = np.empty_like(ways)
        is_round = (self.powers == 2.0).all(axis=1)
        points[is_round] = _farthest_of_ellipsoids(self.size[is_round], ways[is_round])
        edged = ~is_round
        points[edged] = _farthest_of_boxes(self.size[edged], self.powers[edged], ways[edged])
        points += self.centre[:, None]
        if self.table.shape[1] == 1:
            return points
        reach = np.einsum("mkc,mkc->mk", points, ways)
        best = np.argmax(reach[self.table], axis=1)
        chosen = np.take_along_axis(self.table, best, axis=1)
        found: Array = points[chosen, np.arange(ways.shape[1])]
        return found


def _farthest_of_ellipsoids(size: Array, ways: Array) -> Array:
    stretched = ways * size[:, None]
    length = np.sqrt(np.einsum("mkc,mkc->mk", stretched, stretched))
    point: Array = stretched * size[:, None] / np.maximum(length, 1e-12)[..., None]
    return point


def _farthest_of_boxes(size: Array, powers: Array, ways: Array) -> Array:
    """Superellipsoids |(|x/a|^p + |y/b|^p)^(1/p)|^r + |z/c|^r = 1; p, r are the powers."""
    across, along = np.moveaxis(powers / (powers - 1), 1, 0)[..., None]
    x, y, z = np.moveaxis(np.abs(ways) * size[:, None] + 1e-12, 2, 0)
    part_x, part_y = x**across, y**across
    both = part_x + part_y
    flat = both ** (along / across)
    part_z = z**along
    whole = (flat + part_z) ** (1 - 1 / along)
    shared = flat / (both * whole)
    point = np.stack([part_x * shared / x, part_y * shared / y, part_z / (whole * z)], axis=2)
    result: Array = point * np.sign(ways) * size[:, None]
    return result
