"""Triangles of parts for a GPU: the farthest points in directions all around, as vertices."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .shapes import Solids

Array = NDArray[np.float64]
FINENESS = ((0.0, 5, 10), (0.008, 6, 14), (0.016, 9, 20), (0.034, 14, 30))
"""From which half length on (m) parts have how many rings and corners."""


def mesh_of(solids: Solids) -> NDArray[np.float32]:
    """One strip of triangles (n, 7) for all parts: place, normal, and the number of the part.

    Places and normals are along the axes of the part. Normals are exact, as each vertex is the
    farthest along one. Triangles that lead from one ring to the next, or to the next part, have no
    area.
    """
    classes = np.digitize(solids.extent.max(axis=1), [size for size, _, _ in FINENESS]) - 1
    vertices = []
    for one, (_, rings, corners) in enumerate(FINENESS):
        ways = _strip(rings, corners)
        places = solids.farthest(np.broadcast_to(ways, (len(classes), *ways.shape)))
        for number in np.flatnonzero(classes == one).tolist():
            numbers = np.full((len(ways), 1), number)
            rows = np.concatenate([places[number], ways, numbers], axis=1)
            vertices.append(np.concatenate([rows[:1], rows, rows[-1:]]))
    return np.concatenate(vertices).astype(np.float32)


def _strip(rings: int, corners: int) -> Array:
    """Directions all around (n, 3) in the order of one strip, ring after ring."""
    tilts = np.linspace(-math.pi / 2, math.pi / 2, rings + 1)
    turns = np.linspace(0, 2 * math.pi, corners + 1)
    tilt, turn = np.meshgrid(tilts, turns, indexing="ij")
    ways = np.stack([np.cos(tilt) * np.cos(turn), np.cos(tilt) * np.sin(turn), np.sin(tilt)], 2)
    # Flat shapes turn what is nearly nothing into something: let it be nothing.
    ways = ways.round(9)
    zigzag = np.stack([ways[:-1], ways[1:]], axis=2).reshape(rings, -1, 3)
    joined: Array = np.concatenate([zigzag[:, :1], zigzag, zigzag[:, -1:]], axis=1).reshape(-1, 3)
    return joined
